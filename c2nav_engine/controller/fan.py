"""Vetting: which views and sectors may be offered at all (paper, eq. 3 and text below it)."""

from __future__ import annotations

import math
from collections.abc import Sequence

from c2nav_engine.contract.question import Picture
from c2nav_engine.controller.collisions import CollisionMemory
from c2nav_engine.controller.config import ControllerConfig
from c2nav_engine.controller.odometer import planar_m
from c2nav_engine.controller.sensed import Candidate, View
from c2nav_engine.geometry import Point, Pose, wrap_rad

RING_STEP_RAD = math.radians(30.0)
"""Angle between neighbours of the twelve-view ring."""


def vet_fan(
    views: Sequence[View], collisions: CollisionMemory, *, yaw_rad: float, config: ControllerConfig
) -> tuple[Candidate, ...]:
    """The fan with every view marked feasible or vetoed, the reason kept for people."""
    candidates: list[Candidate] = []
    for view in views:
        veto = ""
        if view.free_m < config.free_needed_m:
            veto = f"free {view.free_m:.1f} m, needs {config.free_needed_m:.1f} m"
        elif collisions.blocks(yaw_rad + view.offset_rad):
            veto = "collided this way just now"
        candidates.append(
            Candidate(view.key, not veto, veto, view.free_m, view.offset_rad, view.picture)
        )
    return tuple(candidates)


def sector_views(views: Sequence[View], sector: int) -> tuple[View, View]:
    """The two ring views of a sector: at 60k° and 60k + 30°."""
    return views[2 * sector], views[2 * sector + 1]


class GlanceMemory:
    """Directions that glances already chose near here; they are not offered again."""

    def __init__(self, near_m: float) -> None:
        self._near_m = near_m
        self._chosen: list[tuple[Point, float]] = []

    def add(self, position_m: Point, yaw_rad: float) -> None:
        """A glance turned the body to this heading here."""
        self._chosen.append((position_m, yaw_rad))

    def holds(self, pose: Pose, offset_rad: float) -> bool:
        """Whether a view at this offset was chosen before from within `near_m`."""
        return any(
            planar_m(pose.position_m, position_m) <= self._near_m
            and abs(wrap_rad(pose.yaw_rad + offset_rad - yaw_rad)) < RING_STEP_RAD / 2.0
            for position_m, yaw_rad in self._chosen
        )


def vet_sectors(
    views: Sequence[View],
    pictures: Sequence[Picture],
    chosen: GlanceMemory,
    *,
    pose: Pose,
    config: ControllerConfig,
) -> tuple[Candidate, ...]:
    """Six sectors of the ring, each feasible or vetoed; collision memory has no say here."""
    candidates: list[Candidate] = []
    for sector, picture in enumerate(pictures):
        pair = sector_views(views, sector)
        free_m = max(view.free_m for view in pair)
        veto = ""
        if free_m < config.free_needed_m:
            veto = f"free {free_m:.1f} m, needs {config.free_needed_m:.1f} m"
        elif any(chosen.holds(pose, view.offset_rad) for view in pair):
            veto = "already chosen from here"
        centre_rad = wrap_rad(pair[0].offset_rad + RING_STEP_RAD / 2.0)
        candidates.append(Candidate(f"sector{sector}", not veto, veto, free_m, centre_rad, picture))
    return tuple(candidates)
