"""Renderers, the sensor ring and its noise."""
