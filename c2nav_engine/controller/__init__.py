"""Deterministic, metric: fan, vetting, bundles, gates, vetoes, return path; never asks a model."""
