"""Intervals, paired tests and agreement: pure functions over per-episode numbers and answers."""
