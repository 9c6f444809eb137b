"""Our poses in viser's conventions: quaternions first w, cameras looking along +z."""

from __future__ import annotations

import math

import numpy as np

from c2nav_engine.geometry import Point

Wxyz = tuple[float, float, float, float]

LIFT_M = 0.04
"""Lines on the floor are drawn this far above it, so that they do not flicker."""


def yaw_wxyz(yaw_rad: float) -> Wxyz:
    """A rotation about +Y."""
    return (math.cos(yaw_rad / 2.0), 0.0, math.sin(yaw_rad / 2.0), 0.0)


def camera_wxyz(yaw_rad: float, pitch_rad: float = 0.0) -> Wxyz:
    """A camera of ours (looking along −z, y up) as viser's (along +z, y down).

    Args:
        yaw_rad: Left of −Z.
        pitch_rad: Up from level.
    """
    cy, sy = math.cos(yaw_rad / 2.0), math.sin(yaw_rad / 2.0)
    angle = pitch_rad + math.pi
    cx, sx = math.cos(angle / 2.0), math.sin(angle / 2.0)
    return (cy * cx, cy * sx, sy * cx, -sy * sx)


def raised(point_m: Point, height_m: float = LIFT_M) -> Point:
    """The point above a foot point."""
    x, y, z = point_m
    return (x, y + height_m, z)


def polyline(points_m: list[Point]) -> np.ndarray:
    """Corners as (n − 1, 2, 3) segments, lifted off the floor."""
    array = np.array([raised(point) for point in points_m], dtype=np.float32)
    return np.stack([array[:-1], array[1:]], axis=1)


def dashes(points_m: list[Point], *, dash_m: float, gap_m: float) -> np.ndarray:
    """A dashed polyline as (n, 2, 3) segments, lifted off the floor."""
    corners = np.array([raised(point) for point in points_m], dtype=np.float64)
    lengths = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    starts = np.arange(0.0, along[-1], dash_m + gap_m)
    stops = np.minimum(starts + dash_m, along[-1])
    ends = [
        np.stack([np.interp(at, along, corners[:, axis]) for axis in range(3)], axis=1)
        for at in (starts, stops)
    ]
    return np.stack(ends, axis=1).astype(np.float32)


def disc(radius_m: float, corners: int = 48) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of a flat disc in the floor plane, facing up."""
    angles = np.linspace(0.0, math.tau, corners, endpoint=False)
    rim = np.stack([np.cos(angles), np.zeros(corners), -np.sin(angles)], axis=1) * radius_m
    vertices = np.concatenate([[[0.0, 0.0, 0.0]], rim]).astype(np.float32)
    index = np.arange(corners)
    faces = np.stack([np.zeros(corners, int), index + 1, (index + 1) % corners + 1], axis=1)
    return vertices, faces.astype(np.uint32)


def ring_points(centre_m: Point, radius_m: float, corners: int = 64) -> list[Point]:
    """A closed circle on the floor."""
    x, y, z = centre_m
    return [
        (x + radius_m * math.cos(angle), y, z + radius_m * math.sin(angle))
        for angle in np.linspace(0.0, math.tau, corners + 1)
    ]


def wedge(pose_radius_m: float) -> tuple[np.ndarray, np.ndarray]:
    """A flat arrow head that looks along −Z, its foot point inside."""
    r = pose_radius_m
    vertices = np.array(
        [[0.0, 0.0, -1.5 * r], [-r, 0.0, r], [0.0, 0.0, 0.45 * r], [r, 0.0, r]], dtype=np.float32
    )
    faces = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32)
    return vertices, faces


def vertical_fov(hfov_rad: float, aspect: float) -> float:
    """Vertical field of view of a pinhole with square pixels."""
    return 2.0 * math.atan(math.tan(hfov_rad / 2.0) / aspect)
