"""What one R2R-CE episode is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from c2nav_engine.geometry import Point, Pose


@dataclass(frozen=True, slots=True)
class Episode:
    """One instruction-following task.

    Attributes:
        episode_id: As in the file, as text.
        trajectory_id: As in the file, as text ("" where absent).
        scene_id: Path below the scenes folder, or `builtin/NAME`.
        start: Foot point and heading.
        instruction: The text, verbatim.
        goal_m: First goal's position; None on a test split.
        goal_radius_m: Success radius of the goal, 3.0 m in R2R-CE.
        geodesic_m: The file's start–goal distance; None where absent.
        reference_path_m: The annotated path, possibly empty.
        leg_ends: Indices into the reference path where each leg ends (built-in episodes), else ().
        extra: Fields of the file that we do not interpret, kept for round trips.
    """

    episode_id: str
    trajectory_id: str
    scene_id: str
    start: Pose
    instruction: str
    goal_m: Point | None
    goal_radius_m: float = 3.0
    geodesic_m: float | None = None
    reference_path_m: tuple[Point, ...] = ()
    leg_ends: tuple[int, ...] = ()
    extra: Mapping[str, object] = field(default_factory=dict[str, object])
