"""Seeded noise between the world and what the robot believes; off by default.

The paper assumes reliable sensing. These models let a user test how much rests on it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float32

from c2nav_engine.errors import UsageError
from c2nav_engine.geometry import Pose, wrap_rad


@dataclass(frozen=True, slots=True)
class NoiseConfig:
    """How unreliable sensing is [C]; zeros everywhere mean reliable.

    Attributes:
        translation: Standard deviation of each step's length, as a fraction of it.
        rotation: Standard deviation of each turn's angle, as a fraction of it.
        drift_rad_per_m: Standard deviation of the heading gained in one metre of travel; the
            variance grows with the distance.
        depth: Standard deviation of each depth, as a fraction of it.
        holes: Probability that a pixel returns nothing.
    """

    translation: float = 0.0
    rotation: float = 0.0
    drift_rad_per_m: float = 0.0
    depth: float = 0.0
    holes: float = 0.0

    def __post_init__(self) -> None:
        """Reject what is no deviation or probability; raises `UsageError`."""
        deviations = (self.translation, self.rotation, self.drift_rad_per_m, self.depth)
        sound = all(0.0 <= deviation < math.inf for deviation in deviations)
        if not sound or not 0.0 <= self.holes <= 1.0:
            message = (
                "expected deviations as finite numbers of at least 0 and holes in [0, 1], "
                f"came {self}; correct the noise options"
            )
            raise UsageError(message)

    @property
    def moves(self) -> bool:
        """Whether odometry is noisy at all."""
        return max(self.translation, self.rotation, self.drift_rad_per_m) > 0.0

    @property
    def sees(self) -> bool:
        """Whether depth is noisy at all."""
        return max(self.depth, self.holes) > 0.0


class NoisySensors:
    """Odometry and depth of one episode under a noise model.

    Args:
        config: How unreliable sensing is.
        generator: The episode's own; the same generator gives the same readings.
    """

    def __init__(self, config: NoiseConfig, generator: np.random.Generator) -> None:
        self._config = config
        self._generator = generator

    def odometry(self, believed: Pose, before: Pose, after: Pose) -> Pose:
        """Believed pose after a true motion from `before` to `after`."""
        if not self._config.moves and believed == before:
            return after
        return composed(believed, self._perturbed(relative(before, after)))

    def depth(
        self, depth_m: Float32[np.ndarray, "rows columns"]
    ) -> Float32[np.ndarray, "rows columns"]:
        """Sensed depth of a true one; holes are 0, and a hole stays a hole."""
        config = self._config
        if not config.sees:
            return depth_m
        factors = 1.0 + config.depth * self._generator.standard_normal(depth_m.shape)
        sensed = depth_m * np.maximum(factors, 0.0)
        sensed[self._generator.random(depth_m.shape) < config.holes] = 0.0
        return sensed.astype(np.float32)

    def _perturbed(self, motion: Motion) -> Motion:
        config = self._config
        length, turn, drift = self._generator.standard_normal(3).tolist()
        scale = 1.0 + config.translation * length
        travelled_m = math.hypot(motion.ahead_m, motion.left_m)
        drift_rad = config.drift_rad_per_m * drift * math.sqrt(travelled_m)
        return Motion(
            ahead_m=motion.ahead_m * scale,
            left_m=motion.left_m * scale,
            up_m=motion.up_m,
            left_rad=motion.left_rad * (1.0 + config.rotation * turn) + drift_rad,
        )


@dataclass(frozen=True, slots=True)
class Motion:
    """A pose relative to another, in the other's body frame."""

    ahead_m: float
    left_m: float
    up_m: float
    left_rad: float


def relative(before: Pose, after: Pose) -> Motion:
    """How the body moved, as it could measure it itself."""
    dx, dy, dz = (b - a for a, b in zip(before.position_m, after.position_m, strict=True))
    fx, _, fz = before.forward
    # Left of (fx, fz) on the floor is (fz, −fx).
    return Motion(
        ahead_m=dx * fx + dz * fz,
        left_m=dx * fz - dz * fx,
        up_m=dy,
        left_rad=wrap_rad(after.yaw_rad - before.yaw_rad),
    )


def composed(pose: Pose, motion: Motion) -> Pose:
    """The pose that a motion leads to."""
    x, y, z = pose.position_m
    fx, _, fz = pose.forward
    position_m = (
        x + motion.ahead_m * fx + motion.left_m * fz,
        y + motion.up_m,
        z + motion.ahead_m * fz - motion.left_m * fx,
    )
    return Pose(position_m, wrap_rad(pose.yaw_rad + motion.left_rad))
