"""A branch's way through the world, one entry per low-level step, and what was seen on it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from c2nav_engine.geometry import Pose
from c2nav_engine.navigator.requests import Action, Look, Move, Moved, Rig, Seen
from c2nav_engine.runner.exchange import Exchange


@dataclass(frozen=True, slots=True)
class Footstep:
    """Where the body stood after `step` low-level actions.

    Attributes:
        step: From 0, the start.
        pose: True pose where known, else the believed one.
        distance_m: Geodesic distance to the goal; NaN where unknown, inf where unreachable.
        action: What led here; None at the start.
        collided: Whether that action fell short.
        purpose: What the motion was for; "" at the start.
    """

    step: int
    pose: Pose
    distance_m: float = math.nan
    action: Action | None = None
    collided: bool = False
    purpose: str = ""


@dataclass(frozen=True, slots=True)
class Glimpse:
    """One reading of the cameras.

    Attributes:
        step: Low-level actions executed before it.
        pose: True pose where known, else the believed one.
        rig: Which cameras.
        seen: The pictures.
        depth_png: Front depth in millimetres, 16-bit PNG; empty where it was not kept.
    """

    step: int
    pose: Pose
    rig: Rig
    seen: Seen
    depth_png: bytes = b""


@dataclass(frozen=True, slots=True)
class Track:
    """Footsteps by step number, glimpses in order."""

    footsteps: tuple[Footstep, ...]
    glimpses: tuple[Glimpse, ...]

    @property
    def last_step(self) -> int:
        """The newest step number."""
        return len(self.footsteps) - 1

    def glimpse_at(self, step: int) -> Glimpse | None:
        """The newest reading at or before a step."""
        found = None
        for glimpse in self.glimpses:
            if glimpse.step > step:
                break
            found = glimpse
        return found

    def path_length_m(self, step: int) -> float:
        """Euclidean length of the way up to a step."""
        return sum(
            math.dist(a.pose.position_m, b.pose.position_m)
            for a, b in zip(self.footsteps[:step], self.footsteps[1 : step + 1], strict=False)
        )


def track_of(exchanges: Sequence[Exchange], start: Pose) -> Track:
    """Read a branch's footsteps and glimpses; `start` stands in until something was seen."""
    footsteps = [Footstep(0, start)]
    glimpses: list[Glimpse] = []
    for exchange in exchanges:
        if isinstance(exchange.request, Look) and isinstance(exchange.response, Seen):
            glimpse = _glimpse(exchange, exchange.request.rig, exchange.response)
            glimpses.append(glimpse)
            footsteps[-1] = _refined(footsteps[-1], exchange)
        elif isinstance(exchange.request, Move) and isinstance(exchange.response, Moved):
            footsteps.extend(_walked(exchange, exchange.request.purpose, exchange.response))
    return Track(tuple(footsteps), tuple(glimpses))


def _glimpse(exchange: Exchange, rig: Rig, seen: Seen) -> Glimpse:
    truth = exchange.truth
    pose = truth.poses[0] if truth and truth.poses else seen.odometry
    return Glimpse(exchange.step, pose, rig, seen, truth.depth_png if truth else b"")


def _refined(footstep: Footstep, exchange: Exchange) -> Footstep:
    """A look tells the true pose and distance of where the body stands already."""
    truth = exchange.truth
    if truth is None or not truth.poses or not math.isnan(footstep.distance_m):
        return footstep
    distance_m = truth.goal_distances_m[0] if truth.goal_distances_m else math.nan
    return Footstep(
        footstep.step,
        truth.poses[0],
        distance_m,
        footstep.action,
        footstep.collided,
        footstep.purpose,
    )


def _walked(exchange: Exchange, purpose: str, moved: Moved) -> list[Footstep]:
    truth = exchange.truth
    poses = truth.poses if truth else ()
    distances_m = truth.goal_distances_m if truth else ()
    return [
        Footstep(
            exchange.step + index + 1,
            poses[index] if index < len(poses) else step.odometry,
            distances_m[index] if index < len(distances_m) else math.nan,
            step.action,
            step.collided,
            purpose,
        )
        for index, step in enumerate(moved.steps)
    ]
