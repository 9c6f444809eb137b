"""Reference paths where the data holds none, and the check of the file's own distance."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from c2nav_engine.geometry import Point

FOLLOWER_STEP_M = 0.25
GEODESIC_TOLERANCE = 0.05


def follower_positions(path_m: Sequence[Point]) -> tuple[Point, ...]:
    """Where a body that follows a polyline stands: its start, each 0.25 m along it, and its end.

    Takes the corners of a shortest path, or an annotated reference path; lengths are Euclidean in
    three dimensions, so stairs take more steps.
    """
    positions = list(path_m[:1])
    until_next_m = FOLLOWER_STEP_M
    for start, end in pairwise(path_m):
        length_m = math.dist(start, end)
        along_m = until_next_m
        while along_m <= length_m:
            positions.append(_between(start, end, along_m / length_m))
            along_m += FOLLOWER_STEP_M
        until_next_m = along_m - length_m
    if path_m and math.dist(positions[-1], path_m[-1]) > 1e-6:
        positions.append(path_m[-1])
    return tuple(positions)


def geodesic_note(computed_m: float, file_m: float | None) -> str:
    """Words for the record where d₀ differs from the file's by more than 5 %, else ""."""
    if file_m is None or abs(computed_m - file_m) <= GEODESIC_TOLERANCE * file_m:
        return ""
    return (
        f"start–goal geodesic {computed_m:.2f} m, but the episode file says {file_m:.2f} m: "
        "more than 5 % apart"
    )


def _between(start: Point, end: Point, fraction: float) -> Point:
    x, y, z = (a + fraction * (b - a) for a, b in zip(start, end, strict=True))
    return (x, y, z)
