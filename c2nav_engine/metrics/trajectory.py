"""What scoring reads: where a body was, how far the goal was, and how the episode ended."""

from __future__ import annotations

from dataclasses import dataclass

from c2nav_engine.geometry import Point

SUCCESS_M = 3.0
"""Success radius of R2R-CE and the distance scale of nDTW."""


@dataclass(frozen=True, slots=True)
class Trajectory:
    """One executed episode, as the shell measured it.

    Attributes:
        positions_m: True foot points, the start first, one after each low-level action; repeats
            (turns) change no metric.
        goal_distances_m: Geodesic distance to the goal at each position (`inf` when unreachable);
            empty on a split without goals.
        stopped: Whether STOP was called.
        shortest_m: d₀, the computed start–goal geodesic; None without a goal.
        steps: Low-level actions, STOP included.
        collisions: Forward moves that fell short.
        ground_truth_m: The annotated locations, or `follower_positions` of the shortest path;
            empty when neither is known.
    """

    positions_m: tuple[Point, ...]
    goal_distances_m: tuple[float, ...]
    stopped: bool
    shortest_m: float | None
    steps: int
    collisions: int
    ground_truth_m: tuple[Point, ...] = ()

    def __post_init__(self) -> None:
        """Reject what cannot be scored; raises `ValueError`."""
        distances = len(self.goal_distances_m)
        if not self.positions_m or distances not in {0, len(self.positions_m)}:
            message = (
                "expected a start position and one goal distance for each position (or none), "
                f"came {len(self.positions_m)} positions and {distances} distances"
            )
            raise ValueError(message)
        if distances and self.shortest_m is None:
            message = "expected the start–goal geodesic beside the goal distances, came None"
            raise ValueError(message)
