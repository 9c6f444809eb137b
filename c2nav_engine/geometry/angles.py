"""Angles in radians, wrapped to (−π, π]."""

from __future__ import annotations

import math


def wrap_rad(angle_rad: float) -> float:
    """The same direction in (−π, π]."""
    wrapped = math.remainder(angle_rad, math.tau)
    return math.pi if wrapped == -math.pi else wrapped
