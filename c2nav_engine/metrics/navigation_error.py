"""NE: how far from the goal the episode ended."""

from __future__ import annotations


def navigation_error_m(goal_distances_m: tuple[float, ...]) -> float:
    """Geodesic metres at the last position; `inf` when the goal cannot be reached from there."""
    return goal_distances_m[-1]
