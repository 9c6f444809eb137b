"""Recent collisions veto their heading for a while (method: "Seeing", fan)."""

from __future__ import annotations

from collections.abc import Iterable

from c2nav_engine.controller.sensed import Action, Step
from c2nav_engine.geometry import wrap_rad


class CollisionMemory:
    """Headings in which the body recently bumped into something.

    A collision blocks headings within half a fan offset until `forget_m` is travelled or a glance
    re-oriented the body [C]. It never blocks glance sectors.
    """

    def __init__(self, *, half_offset_rad: float, forget_m: float) -> None:
        self._half_offset_rad = half_offset_rad
        self._forget_m = forget_m
        self._blocked: list[tuple[float, float]] = []

    def add(self, steps: Iterable[Step], *, travelled_m: float) -> None:
        """Remember the collisions of a motion that ended at `travelled_m` of travel."""
        steps = tuple(steps)
        remaining_m = sum(step.moved_m for step in steps if step.action is Action.FORWARD)
        for step in steps:
            if step.action is Action.FORWARD:
                remaining_m -= step.moved_m
                if step.collided:
                    self._blocked.append((step.odometry.yaw_rad, travelled_m - remaining_m))
        self._blocked = [
            entry for entry in self._blocked if travelled_m - entry[1] < self._forget_m
        ]

    def clear(self) -> None:
        """Forget everything: a glance re-oriented the body."""
        self._blocked = []

    def blocks(self, yaw_rad: float) -> bool:
        """Whether a heading lies within half an offset of a remembered collision."""
        return any(
            abs(wrap_rad(yaw_rad - blocked_rad)) <= self._half_offset_rad + 1e-9
            for blocked_rad, _ in self._blocked
        )
