"""SDTW: nDTW of the successes."""

from __future__ import annotations


def sdtw(*, succeeded: bool, ndtw: float) -> float:
    """S · nDTW, in [0, 1]."""
    return ndtw if succeeded else 0.0
