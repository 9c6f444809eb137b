"""Bounded motion: how far one election may carry the body."""

from __future__ import annotations

import math

from c2nav_engine.controller.config import ControllerConfig


def bundle_steps(free_m: float, *, step_m: float, config: ControllerConfig) -> int:
    """Forward steps after an election: at most the bundle, and short of the free space."""
    room_m = free_m - config.bundle_margin_m
    return max(0, min(config.bundle_steps, math.floor(room_m / step_m + 1e-9)))
