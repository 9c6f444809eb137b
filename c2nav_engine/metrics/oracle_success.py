"""OSR: whether the body ever stood within the success region."""

from __future__ import annotations

from c2nav_engine.metrics.trajectory import SUCCESS_M


def oracle_success(goal_distances_m: tuple[float, ...]) -> bool:
    """Whether any position, the start included, lies closer than 3.0 m to the goal."""
    return min(goal_distances_m) < SUCCESS_M
