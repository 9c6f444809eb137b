"""Path length: the sum of Euclidean steps."""

from __future__ import annotations

import math
from itertools import pairwise

from c2nav_engine.geometry import Point


def path_length_m(positions_m: tuple[Point, ...]) -> float:
    """Metres travelled, climbs included; turns on the spot add nothing."""
    return math.fsum(math.dist(a, b) for a, b in pairwise(positions_m))
