"""What the robot believes it has travelled: distances, the trail, the last collision."""

from __future__ import annotations

import math
from collections.abc import Iterable

from c2nav_engine.controller.sensed import Action, Step
from c2nav_engine.geometry import Point, Pose


def planar_m(a_m: Point, b_m: Point) -> float:
    """Horizontal distance of two points."""
    return math.hypot(a_m[0] - b_m[0], a_m[2] - b_m[2])


class Odometer:
    """Accumulates executed steps; the one place where travel is counted.

    Attributes:
        pose: Believed pose now.
        travelled_m: Forward travel in the episode, returns included.
        path_m: Forward travel without returns: the axis on which frames lie behind.
        steps: Executed low-level actions.
        trail: Every believed pose after a forward step, with its `path_m`; the start first.
        last_forward_collided: Whether the latest forward step collided.
    """

    def __init__(self, start: Pose) -> None:
        self.pose = start
        self.travelled_m = 0.0
        self.path_m = 0.0
        self.steps = 0
        self.forward_steps = 0
        self.trail: list[tuple[Pose, float]] = [(start, 0.0)]
        self.last_forward_collided = False

    def add(self, steps: Iterable[Step], *, retracing: bool = False) -> None:
        """Take in executed steps; a return counts as travel, not as path."""
        for step in steps:
            self.pose = step.odometry
            self.steps += 1
            if step.action is not Action.FORWARD:
                continue
            self.forward_steps += 1
            self.last_forward_collided = step.collided
            self.travelled_m += step.moved_m
            if not retracing:
                self.path_m += step.moved_m
                self.trail.append((step.odometry, self.path_m))

    def return_to(self, path_m: float) -> None:
        """Forget the trail beyond a point of the path, after walking back to it."""
        self.trail = [entry for entry in self.trail if entry[1] <= path_m] or self.trail[:1]
        self.trail.append((self.pose, self.path_m))
