"""In which order a camera's rays are cast, and which pixels each of them fills."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Float64, Int32, Int64

from c2nav_engine.geometry import Pinhole

TILE_PX = 8
"""Rays go tile by tile: neighbours meet the same triangles while those are still in cache.

On a mesh of ten million triangles this saves a fifth of a cast; small meshes do not mind.
"""


class RayPlan(NamedTuple):
    """Rays of one camera in casting order.

    Attributes:
        directions: In the camera frame, with z = −1.
        rgb_pixels: Index of the RGB pixel that each ray fills, −1 for none.
        depth_pixels: Index of the pixel in the depth grid, −1 for none.
    """

    directions: Float32[np.ndarray, "rays 3"]
    rgb_pixels: Int32[np.ndarray, " rays"]
    depth_pixels: Int32[np.ndarray, " rays"]


def ray_plan(rgb: Pinhole, depth: Pinhole, depth_stride: int = 1) -> RayPlan:
    """Rays through the pixel centres of both pinholes; equal pinholes share theirs.

    Of the depth picture only every `depth_stride`-th row and column are cast.
    """
    directions = rgb.ray_directions().reshape(-1, 3)
    rgb_pixels = np.arange(len(directions))
    if depth == rgb:
        depth_pixels = np.full((rgb.height_px, rgb.width_px), -1)
        grid = depth_pixels[::depth_stride, ::depth_stride]
        grid[:] = np.arange(grid.size).reshape(grid.shape)
        depth_pixels = depth_pixels.reshape(-1)
    else:
        others = depth.ray_directions()[::depth_stride, ::depth_stride].reshape(-1, 3)
        depth_pixels = np.concatenate([np.full(len(directions), -1), np.arange(len(others))])
        rgb_pixels = np.concatenate([rgb_pixels, np.full(len(others), -1)])
        directions = np.concatenate([directions, others])
    order = np.argsort(_tiles(directions, rgb), kind="stable")
    return RayPlan(
        np.ascontiguousarray(directions[order], np.float32),
        rgb_pixels[order].astype(np.int32),
        depth_pixels[order].astype(np.int32),
    )


def _tiles(
    directions: Float64[np.ndarray, "rays 3"], pinhole: Pinhole
) -> Int64[np.ndarray, " rays"]:
    """Number of the tile of the RGB picture that each direction falls into, row by row."""
    columns = pinhole.width_px / 2.0 + directions[:, 0] * pinhole.focal_px
    rows = pinhole.height_px / 2.0 - directions[:, 1] * pinhole.focal_px
    across, down = np.floor(columns / TILE_PX), np.floor(rows / TILE_PX)
    across, down = across - across.min(), down - down.min()
    return (down * (across.max() + 1) + across).astype(np.int64)
