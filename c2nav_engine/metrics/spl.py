"""SPL: success weighted by the shortest path over the one taken."""

from __future__ import annotations

import math


def spl(*, succeeded: bool, shortest_m: float, travelled_m: float) -> float:
    """S · d₀ / max(d₀, path length), in [0, 1].

    A stop where the goal and the start are one place, without a move, is a full success; an
    unreachable goal (`shortest_m` infinite) gives 0.
    """
    if not succeeded or math.isinf(shortest_m):
        return 0.0
    longest_m = max(shortest_m, travelled_m)
    return shortest_m / longest_m if longest_m > 0.0 else 1.0
