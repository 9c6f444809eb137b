"""How far the body can travel along a heading, from remembered depth points alone.

The floor just ahead lies below the camera's picture, so points of the last metres of travel are
kept in the odometry frame [C]. The navigation mesh is never asked.

Along a heading, the strip that the body would sweep is read from near to far (`strip_walk`). What
nobody saw is not free: the farthest point that was seen below the body's top bounds the answer.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from c2nav_engine.controller.point_memory import PointMemory
from c2nav_engine.controller.strip_walk import FreeSpaceConfig, StripWalk
from c2nav_engine.episodes.profile import Profile
from c2nav_engine.geometry import Pose

__all__ = ["FreeSpaceConfig", "FreeSpaceMemory"]


class FreeSpaceMemory:
    """Recent depth points, and the free space that they leave along a heading."""

    def __init__(self, profile: Profile, config: FreeSpaceConfig | None = None) -> None:
        """The memory is empty: until something is observed, nothing is free.

        Args:
            profile: The body's radius, height and climb, and its camera.
            config: Thresholds; the defaults without it.
        """
        self._profile = profile
        self._config = config or FreeSpaceConfig()
        self._points = PointMemory(
            voxel_m=self._config.voxel_m, forget_after_m=self._config.memory_m
        )

    def observe(self, points_m: Float[np.ndarray, "n 3"], travelled_m: float) -> None:
        """Remember depth points (odometry frame) seen after `travelled_m` of travel."""
        self._points.add(points_m, travelled_m=travelled_m)

    @property
    def remembered(self) -> int:
        """How many points are remembered."""
        return len(self._points.points_m)

    def free_m(self, odometry: Pose, offset_rad: float) -> float:
        """Distance that the body can travel along the heading turned left by the offset."""
        strip = self._strip(odometry.turned(offset_rad))
        if not strip.size:
            return 0.0
        walk = StripWalk(self._profile, self._config, odometry.position_m[1])
        slices = np.floor(strip[:, 0] / self._config.slice_m).astype(np.int64)
        # By slice, and by height within one.
        order = np.lexsort((strip[:, 1], slices))
        strip, slices = strip[order], slices[order]
        bounds = np.flatnonzero(np.diff(slices)) + 1
        for part in np.split(strip, bounds):
            if not walk.enter(part):
                break
        return max(0.0, min(walk.free_m, walk.seen_m, self._config.max_range_m))

    def _strip(self, heading: Pose) -> Float[np.ndarray, "n 3"]:
        """Points that the body would sweep: (distance ahead, height, distance when touched)."""
        profile, config = self._profile, self._config
        x, y, z = heading.position_m
        forward_x, _, forward_z = heading.forward
        dx, dz = self._points.points_m[:, 0] - x, self._points.points_m[:, 2] - z
        ahead_m = dx * forward_x + dz * forward_z
        aside_m = dx * forward_z - dz * forward_x
        height_m = self._points.points_m[:, 1]
        reach_m = config.max_range_m + profile.radius_m
        inside = (
            (np.abs(aside_m) < profile.radius_m)
            & (ahead_m > 0.0)
            & (ahead_m <= 2.0 * reach_m)  # what lies behind a drop tells how deep it is
            & (height_m < y + profile.height_m + reach_m)
        )
        touched_m = ahead_m[inside] - np.sqrt(profile.radius_m**2 - aside_m[inside] ** 2)
        return np.stack([ahead_m[inside], height_m[inside], touched_m], axis=1)
