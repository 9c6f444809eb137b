"""Small scenes of boxes, and the true shortest way around one convex obstacle."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull

from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.world.walkable import WalkableSurface, build_surface

_FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


@dataclass(frozen=True)
class Box:
    """An axis-aligned box in the world frame, metres."""

    low_m: tuple[float, float, float]
    high_m: tuple[float, float, float]

    def mesh(self) -> tuple[np.ndarray, np.ndarray]:
        low, high = np.array(self.low_m), np.array(self.high_m)
        bits = np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)])
        quads = np.array(_FACES)
        return low + bits * (high - low), np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]])

    def gap_m(self, x: float, z: float) -> float:
        """Distance in plan from a point to the box."""
        dx = max(self.low_m[0] - x, 0.0, x - self.high_m[0])
        dz = max(self.low_m[2] - z, 0.0, z - self.high_m[2])
        return math.hypot(dx, dz)


def wall(x0: float, z0: float, x1: float, z1: float, *, base_m: float = 0.0) -> Box:
    return Box((x0, base_m, z0), (x1, base_m + 2.4, z1))


def slab(x0: float, z0: float, x1: float, z1: float, *, top_m: float = 0.0) -> Box:
    return Box((x0, top_m - 0.1, z0), (x1, top_m, z1))


def stairs(x0: float, x1: float, z0: float, steps: int) -> list[Box]:
    """A solid flight of 0.18 m risers and 0.28 m treads that climbs towards +z."""
    return [
        Box((x0, -0.1, z0 + 0.28 * i), (x1, 0.18 * (i + 1), z0 + 0.28 * (i + 1)))
        for i in range(steps)
    ]


def room(width_m: float, depth_m: float) -> list[Box]:
    """A floor from the origin with walls around it."""
    t = 0.1
    return [
        slab(-t, -t, width_m + t, depth_m + t),
        wall(-t, -t, width_m + t, 0.0),
        wall(-t, depth_m, width_m + t, depth_m + t),
        wall(-t, 0.0, 0.0, depth_m),
        wall(width_m, 0.0, width_m + t, depth_m),
    ]


def merged(boxes: list[Box]) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles of all boxes."""
    meshes = [box.mesh() for box in boxes]
    offsets = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    triangles = [faces + offset for (_, faces), offset in zip(meshes, offsets, strict=False)]
    return np.concatenate([vertices for vertices, _ in meshes]), np.concatenate(triangles)


def surface_of(boxes: list[Box], **changes: float) -> WalkableSurface:
    """The surface for the default body, or one that differs as said."""
    body = {
        "height_m": VLNCE.height_m,
        "radius_m": VLNCE.radius_m,
        "climb_m": VLNCE.climb_m,
        "slope_rad": VLNCE.slope_rad,
    }
    vertices_m, triangles = merged(boxes)
    return build_surface(vertices_m, triangles, **(body | changes))


def way_around_m(
    start: tuple[float, float],
    end: tuple[float, float],
    corners: list[tuple[float, float]],
    *,
    radius_m: float = VLNCE.radius_m,
) -> float:
    """Shortest way of a disc from start to end, in plan, around a convex obstacle's corners.

    The string pulled tight around the corners grown by the radius: their hull with both ends,
    without the edge between the ends.
    """
    angles = np.linspace(0.0, math.tau, 720)
    circle = radius_m * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points = np.concatenate([[start, end], *(np.array(corner) + circle for corner in corners)])
    hull = ConvexHull(points)
    return float(hull.area) - math.dist(start, end)
