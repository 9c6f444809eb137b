"""What a level depth camera sees of boxes: exact rays, no renderer."""

from __future__ import annotations

import numpy as np

from c2nav_engine.episodes.profile import Profile
from c2nav_engine.geometry import Pose, world_from_camera
from tests.helpers.meshes import Box


def depth_points_m(
    boxes: list[Box], pose: Pose, profile: Profile, *, offset_rad: float = 0.0, stride: int = 4
) -> np.ndarray:
    """World points of every `stride`-th depth pixel that hits something in range."""
    camera = world_from_camera(pose, height_m=profile.camera_height_m, offset_rad=offset_rad)
    rays = profile.depth.ray_directions()[::stride, ::stride].reshape(-1, 3) @ camera[:3, :3].T
    rays = np.where(rays == 0.0, 1e-12, rays)
    origin = camera[:3, 3]
    nearest = np.full(len(rays), np.inf)
    for box in boxes:
        to_low = (np.array(box.low_m) - origin) / rays
        to_high = (np.array(box.high_m) - origin) / rays
        enter = np.minimum(to_low, to_high).max(axis=1)
        leave = np.maximum(to_low, to_high).min(axis=1)
        hit = (enter <= leave) & (enter > 0.0)
        nearest[hit] = np.minimum(nearest[hit], enter[hit])
    seen = (nearest >= profile.depth_near_m) & (nearest <= profile.depth_far_m)
    return origin + rays[seen] * nearest[seen][:, None]
