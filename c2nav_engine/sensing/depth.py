"""What the controller reads from a depth picture: its statistics, and points in the world."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Float32

from c2nav_engine.geometry import Pinhole


def valid_depth(
    depth_m: Float32[np.ndarray, "rows columns"], *, near_m: float, far_m: float
) -> Bool[np.ndarray, "rows columns"]:
    """Where the sensor returned something: holes are 0 or nan, never the maximum range."""
    with np.errstate(invalid="ignore"):
        return (depth_m > 0.0) & (depth_m >= near_m) & (depth_m <= far_m)


def depth_facts(
    depth_m: Float32[np.ndarray, "rows columns"], *, near_m: float = 0.0, far_m: float = np.inf
) -> tuple[float, float]:
    """Median of the valid depths in metres (0.0 without any), and the fraction of holes."""
    returned = depth_m[valid_depth(depth_m, near_m=near_m, far_m=far_m)]
    holes = 1.0 - returned.size / depth_m.size
    return (float(np.median(returned)) if returned.size else 0.0, holes)


def depth_points(
    depth_m: Float32[np.ndarray, "rows columns"],
    pinhole: Pinhole,
    world_from_camera: Float[np.ndarray, "4 4"],
    *,
    near_m: float,
    far_m: float,
    stride: int = 1,
) -> Float[np.ndarray, "points 3"]:
    """World points of the valid depths at every `stride`-th row and column of a pinhole.

    Rays run through pixel centres, so a noiseless point lies on the surface that was rendered.
    """
    valid = valid_depth(depth_m, near_m=near_m, far_m=far_m)
    # Directions have unit length along the axis: scaled by depth, they end at the hit.
    rays = pinhole.ray_directions()[::stride, ::stride][valid]
    points_m = rays * depth_m[valid][:, None].astype(np.float64)
    return points_m @ world_from_camera[:3, :3].T + world_from_camera[:3, 3]
