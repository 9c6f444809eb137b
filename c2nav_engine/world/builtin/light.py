"""Soft light baked into vertex colours: corners and the floor under furniture grow darker.

Each vertex looks into 32 fixed directions of its hemisphere. Near surfaces hide the light of the
room, glowing ones (windows, lamps) add to it. The result is rounded to coarse levels, so that
the last digit of a ray cast never shows.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int, UInt8

from c2nav_engine.world.open3d_lean import open3d

_RAYS = 32
_REACH_M = 1.3
"""Surfaces nearer than this hide light, the more the nearer."""
_DARKEST = 0.45
_LEVEL = 4
"""Step of the rounded 0–255 levels."""


def baked(
    vertices_m: Float[np.ndarray, "vertices 3"],
    triangles: Int[np.ndarray, "triangles 3"],
    glow: Float[np.ndarray, " triangles"],
    casts: Bool[np.ndarray, " triangles"],
) -> UInt8[np.ndarray, "vertices 4"]:
    """Grey vertex colours of a whole house.

    Args:
        vertices_m: Positions.
        triangles: Vertex indices, counter-clockwise from outside.
        glow: How much light each triangle gives off.
        casts: Whether each triangle hides light from others.
    """
    normals = _normals(vertices_m, triangles)
    directions = _directions()
    frames = _frames(normals)
    rays = np.empty((len(vertices_m), _RAYS, 6), np.float32)
    # From just inside the face: an edge lies in the plane of the face it meets.
    origins = vertices_m + 0.012 * normals + 0.04 * _inward(vertices_m, triangles, normals)
    rays[:, :, :3] = origins[:, None, :]
    rays[:, :, 3:] = np.einsum("kc,vcx->vkx", directions, frames)
    distance, hit = _cast(vertices_m, triangles[casts], rays)
    glow = glow[casts].astype(np.float64)
    open_share: np.ndarray = np.clip(distance / _REACH_M, 0.0, 1.0) ** 0.7
    shining: np.ndarray = np.take(glow, hit) * (hit >= 0)
    # Windows far away still light a room, only less.
    bonus = 0.16 * np.clip(shining / (0.4 + 0.25 * distance), 0.0, 2.0)
    light: np.ndarray = np.clip(open_share + bonus, 0.0, 1.6).mean(axis=1)
    grey: np.ndarray = np.clip(_DARKEST + (1.0 - _DARKEST) * light * 1.2, 0.0, 1.0)
    levels: np.ndarray = np.clip(np.round(grey * 255.0 / _LEVEL) * _LEVEL, 0, 255).astype(np.uint8)
    return np.stack([levels, levels, levels, np.full_like(levels, 255)], axis=1)


def _normals(
    vertices_m: Float[np.ndarray, "vertices 3"], triangles: Int[np.ndarray, "triangles 3"]
) -> Float[np.ndarray, "vertices 3"]:
    corners = vertices_m[triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.stack(
        [
            np.bincount(triangles.reshape(-1), np.repeat(faces[:, k], 3), len(vertices_m))
            for k in range(3)
        ],
        axis=1,
    )
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)


def _inward(
    vertices_m: Float[np.ndarray, "vertices 3"],
    triangles: Int[np.ndarray, "triangles 3"],
    normals: Float[np.ndarray, "vertices 3"],
) -> Float[np.ndarray, "vertices 3"]:
    """Direction along the surface from each vertex into it; 0 where the surface surrounds it."""
    corners = vertices_m[triangles]
    away = corners.mean(axis=1, keepdims=True) - corners
    sums = np.stack(
        [
            np.bincount(triangles.reshape(-1), away[:, :, k].reshape(-1), len(vertices_m))
            for k in range(3)
        ],
        axis=1,
    )
    # Of a round body only the part along its surface counts: the rest leads inside.
    sums -= (sums * normals).sum(axis=1, keepdims=True) * normals
    return sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), 1e-2)


def _directions() -> Float[np.ndarray, "rays 3"]:
    """Cosine-weighted directions around +z on a golden spiral."""
    index = np.arange(_RAYS) + 0.5
    radius = np.sqrt(index / _RAYS)
    angle = index * math.pi * (3.0 - math.sqrt(5.0))
    up = np.sqrt(1.0 - radius**2)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), up], axis=1)


def _frames(normals: Float[np.ndarray, "vertices 3"]) -> Float[np.ndarray, "vertices 3 3"]:
    """Two tangents and the normal of each vertex, as rows."""
    steep = np.abs(normals[:, 1]) > 0.9
    helper = np.where(steep[:, None], (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    first = np.cross(helper, normals)
    first /= np.maximum(np.linalg.norm(first, axis=1, keepdims=True), 1e-12)
    return np.stack([first, np.cross(normals, first), normals], axis=1)


def _cast(
    vertices_m: Float[np.ndarray, "vertices 3"],
    triangles: Int[np.ndarray, "triangles 3"],
    rays: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Distance and triangle of each ray's first hit; inf and −1 for none."""
    o3d = open3d()
    tensor: Any = o3d.core.Tensor.from_numpy
    scene: Any = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(tensor(vertices_m.astype(np.float32)), tensor(triangles.astype(np.uint32)))
    answer = scene.cast_rays(tensor(rays))
    hit = answer["primitive_ids"].numpy().astype(np.int64)
    hit[hit >= len(triangles)] = -1
    return answer["t_hit"].numpy().astype(np.float64), hit
