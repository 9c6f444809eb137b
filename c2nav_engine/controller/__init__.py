"""Deterministic and metric: fan, vetting, bundles, gates, vetoes, return path. Never asks a model."""
