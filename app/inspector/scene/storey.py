"""Which level the map is cut above: that of the storey the body stands on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from app.session.snapshot import Snapshot
from c2nav_engine.geometry import Point

CLIMBED_M = 1.0
"""On stairs the level follows once the body stands this far from it [C]."""

SETTLED_M = 0.75
"""A level walked along for this long is a storey [C]: three steps, where stairs have none."""

_EVEN_M = 0.1
_ASIDE_M = 0.5
"""Sunken rooms and thresholds closer than this to the level stay within its storey."""


def storey_of(snapshot: Snapshot) -> float:
    """Height of the storey at the place in view."""
    footsteps = snapshot.story.track.footsteps[: snapshot.here.step + 1]
    return storey_m([footstep.pose.position_m for footstep in footsteps])


def storey_m(way_m: Sequence[Point]) -> float:
    """Height of the storey at the end of a way, world frame.

    It depends on the way alone, so that a step shows the same cut however one came to it: a storey
    is cut at its own floor, stairs at every metre climbed.

    Args:
        way_m: Where the body stood after every step, at least once.
    """
    level_m = even_m = way_m[0][1]
    walked_m, climbing = 0.0, False
    for before, after in pairwise(way_m):
        if abs(after[1] - even_m) > _EVEN_M:
            even_m, walked_m = after[1], 0.0
        walked_m += math.hypot(after[0] - before[0], after[2] - before[2])
        if walked_m >= SETTLED_M and (climbing or abs(even_m - level_m) > _ASIDE_M):
            level_m, climbing = even_m, False
        elif abs(after[1] - level_m) >= CLIMBED_M:
            level_m, climbing = after[1], True
    return level_m
