"""How a body moves over a surface: forward steps that collide and slide, and turns."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from c2nav_engine.episodes.profile import Profile
from c2nav_engine.geometry import Pose
from c2nav_engine.world.surface import Surface

COLLISION_M = 1e-5
"""A horizontal move that is shorter than intended by more than this is a collision."""


class Step(NamedTuple):
    """What one MOVE_FORWARD did.

    Attributes:
        pose: Where the body is now; its heading is unchanged.
        moved_m: Horizontal distance moved.
        collided: The move fell short of the profile's step by more than `COLLISION_M`.
    """

    pose: Pose
    moved_m: float
    collided: bool


@dataclass(frozen=True, slots=True)
class Body:
    """A body of one profile on one surface; holds no pose, so it can be shared.

    Attributes:
        surface: The floor.
        profile: Step length, turn angle, and whether blocked moves slide.
    """

    surface: Surface
    profile: Profile

    def forward(self, pose: Pose) -> Step:
        """One step along the heading; the height follows the floor."""
        intended = pose.ahead(self.profile.step_m)
        position_m = self.surface.slide(pose.position_m, intended, sliding=self.profile.sliding)
        moved_m = math.hypot(position_m[0] - pose.position_m[0], position_m[2] - pose.position_m[2])
        collided = moved_m < self.profile.step_m - COLLISION_M
        return Step(Pose(position_m, pose.yaw_rad), moved_m, collided)

    def turn(self, pose: Pose, *, left: bool) -> Pose:
        """One turn of the profile's angle on the spot."""
        return pose.turned(self.profile.turn_rad if left else -self.profile.turn_rad)
