"""Embodiment profiles: the body and its cameras, under the field's two common settings.

The paper names neither camera nor turn angle, so both are named profiles [C] and every run
record and trace carries the name with all values.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from c2nav_engine.errors import UsageError
from c2nav_engine.geometry import Pinhole


@dataclass(frozen=True, slots=True)
class Profile:
    """A body on wheels and its fixed sensor ring.

    Attributes:
        name: What records call it.
        height_m: Body height (clearance it needs).
        radius_m: Body radius.
        climb_m: Highest step it rolls over.
        slope_rad: Steepest floor.
        camera_height_m: Camera above the foot point.
        rgb: RGB pinhole.
        depth: Depth pinhole, same centre and field of view.
        depth_near_m: Nearest depth that the sensor returns.
        depth_far_m: Farthest depth; beyond, the sensor returns 0.
        step_m: Length of MOVE_FORWARD.
        turn_rad: Angle of TURN_LEFT and TURN_RIGHT.
        fan_offset_rad: Side views of the fan; a multiple of the turn [C].
        max_steps: Low-level actions in an episode, STOP included.
        sliding: Whether a blocked forward move slides along the obstacle.
    """

    name: str
    height_m: float
    radius_m: float
    camera_height_m: float
    rgb: Pinhole
    depth: Pinhole
    depth_near_m: float
    depth_far_m: float
    turn_rad: float
    fan_offset_rad: float
    step_m: float = 0.25
    climb_m: float = 0.2
    slope_rad: float = math.radians(45.0)
    max_steps: int = 500
    sliding: bool = True


VLNCE = Profile(
    name="vlnce",
    height_m=1.5,
    radius_m=0.1,
    camera_height_m=1.25,
    rgb=Pinhole(224, 224, math.radians(90.0)),
    depth=Pinhole(256, 256, math.radians(90.0)),
    depth_near_m=0.0,
    depth_far_m=10.0,
    turn_rad=math.radians(15.0),
    fan_offset_rad=math.radians(45.0),
)

LAVIRA = Profile(
    name="lavira",
    height_m=0.88,
    radius_m=0.1,
    camera_height_m=0.88,
    rgb=Pinhole(640, 480, math.radians(79.0)),
    depth=Pinhole(640, 480, math.radians(79.0)),
    depth_near_m=0.1,
    depth_far_m=5.0,
    turn_rad=math.radians(30.0),
    fan_offset_rad=math.radians(60.0),
)

PROFILES = {profile.name: profile for profile in (VLNCE, LAVIRA)}


def profile_named(name: str) -> Profile:
    """The profile of that name; raises `UsageError` naming those that exist."""
    if name not in PROFILES:
        message = f"expected an embodiment profile ({', '.join(PROFILES)}), came {name!r}"
        raise UsageError(message)
    return PROFILES[name]
