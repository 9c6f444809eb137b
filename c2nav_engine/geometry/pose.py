"""The body's pose: a foot point and a yaw."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from c2nav_engine.geometry.angles import wrap_rad

Point = tuple[float, float, float]
"""A position in the world frame, metres: (x right, y up, z backward)."""


@dataclass(frozen=True, slots=True)
class Pose:
    """A body on the floor.

    Attributes:
        position_m: Foot point in the world frame.
        yaw_rad: Heading about +Y, in (−π, π]; 0 looks along −Z, positive turns left.
    """

    position_m: Point
    yaw_rad: float

    @staticmethod
    def from_quaternion(position_m: Point, xyzw: tuple[float, float, float, float]) -> Pose:
        """From R2R-CE's start pose; any tilt in the quaternion is dropped, its heading kept."""
        x, y, z, w = xyzw
        norm = math.sqrt(x * x + y * y + z * z + w * w)
        if norm == 0.0:
            message = f"expected a rotation quaternion [x, y, z, w], came {list(xyzw)}"
            raise ValueError(message)
        x, y, z, w = x / norm, y / norm, z / norm, w / norm
        # Forward is −Z: rotate (0, 0, −1) and read its bearing in the floor plane.
        forward_x = -2.0 * (x * z + w * y)
        forward_z = -(1.0 - 2.0 * (x * x + y * y))
        return Pose(position_m, math.atan2(-forward_x, -forward_z))

    @property
    def quaternion_xyzw(self) -> tuple[float, float, float, float]:
        """The rotation about +Y as R2R-CE writes it."""
        return (0.0, math.sin(self.yaw_rad / 2.0), 0.0, math.cos(self.yaw_rad / 2.0))

    @property
    def forward(self) -> Point:
        """Unit vector along the heading."""
        return (-math.sin(self.yaw_rad), 0.0, -math.cos(self.yaw_rad))

    def turned(self, left_rad: float) -> Pose:
        """The same foot point, turned left by `left_rad`."""
        return Pose(self.position_m, wrap_rad(self.yaw_rad + left_rad))

    def ahead(self, distance_m: float) -> Point:
        """The point `distance_m` along the heading, at the same height."""
        x, y, z = self.position_m
        fx, _, fz = self.forward
        return (x + distance_m * fx, y, z + distance_m * fz)

    def bearing_rad(self, point_m: Point) -> float:
        """How far left of the heading a point lies, in (−π, π]."""
        dx, dz = point_m[0] - self.position_m[0], point_m[2] - self.position_m[2]
        return wrap_rad(math.atan2(-dx, -dz) - self.yaw_rad)


def world_from_camera(
    pose: Pose, *, height_m: float, offset_rad: float = 0.0
) -> Float[np.ndarray, "4 4"]:
    """Transform of a level camera at `height_m` above the foot point, turned left by the offset.

    The camera frame is the body's: x right, y up, the optical axis along −z.
    """
    yaw_rad = pose.yaw_rad + offset_rad
    sin, cos = math.sin(yaw_rad), math.cos(yaw_rad)
    x, y, z = pose.position_m
    return np.array(
        [
            [cos, 0.0, sin, x],
            [0.0, 1.0, 0.0, y + height_m],
            [-sin, 0.0, cos, z],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )
