"""SR under both scorings: the official one, and the one several zero-shot baselines compute."""

from __future__ import annotations

from c2nav_engine.metrics.trajectory import SUCCESS_M


def success(goal_distances_m: tuple[float, ...], *, stopped: bool) -> bool:
    """Official: STOP was called closer than 3.0 m to the goal."""
    return stopped and goal_distances_m[-1] < SUCCESS_M


def success_zero_shot(goal_distances_m: tuple[float, ...]) -> bool:
    """`zero-shot` scoring: the episode ended within 3.0 m, however it ended."""
    return goal_distances_m[-1] <= SUCCESS_M
