"""Compiled geometry of the X–Z plane in single precision, in the order of Detour's own rounding.

Results must equal another program's to the last bit, or ties fall the other way; so every constant
is a `float32` and no expression is rearranged. Points are (x, y, z) tuples of `float32`, which the
compiler knows and a type checker does not.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.navmesh.arrays import Records

Real = Any
Vector = tuple[Real, Real, Real]

ZERO: Real = np.float32(0.0)
ONE: Real = np.float32(1.0)
HALF: Real = np.float32(0.5)
LARGEST: Real = np.float32(3.4028234663852886e38)
SAME_POINT_SQUARED: Real = np.float32((1.0 / 16384.0) ** 2)


@compiled
def vector(row: Records) -> Vector:
    """The three numbers of an array."""
    return row[0], row[1], row[2]


@compiled
def between(start: Vector, end: Vector, share: Real) -> Vector:
    """The point at `share` of the way."""
    return (
        start[0] + (end[0] - start[0]) * share,
        start[1] + (end[1] - start[1]) * share,
        start[2] + (end[2] - start[2]) * share,
    )


@compiled
def squared_distance(a: Vector, b: Vector) -> Real:
    """In space."""
    dx = b[0] - a[0]
    dy = b[1] - a[1]
    dz = b[2] - a[2]
    return dx * dx + dy * dy + dz * dz


@compiled
def distance(a: Vector, b: Vector) -> Real:
    """In space, metres."""
    return math.sqrt(squared_distance(a, b))


@compiled
def side_of(a: Vector, b: Vector, c: Vector) -> Real:
    """Twice the signed area of a triangle in the plane: the sign tells on which side c lies."""
    abx = b[0] - a[0]
    abz = b[2] - a[2]
    acx = c[0] - a[0]
    acz = c[2] - a[2]
    return acx * abz - abx * acz


@compiled
def to_segment(point: Vector, start: Vector, end: Vector) -> tuple[Real, Real]:
    """Squared plane distance to a segment, and the share of the way where it is nearest."""
    along_x = end[0] - start[0]
    along_z = end[2] - start[2]
    dx = point[0] - start[0]
    dz = point[2] - start[2]
    length = along_x * along_x + along_z * along_z
    share = along_x * dx + along_z * dz
    if length > ZERO:
        share /= length
    if share < ZERO:
        share = ZERO
    elif share > ONE:
        share = ONE
    dx = start[0] + share * along_x - point[0]
    dz = start[2] + share * along_z - point[2]
    return dx * dx + dz * dz, share


@compiled
def crossing(a: tuple[Vector, Vector], b: tuple[Vector, Vector]) -> tuple[bool, Real, Real]:
    """Whether two lines cross, and at which share of each segment; parallel lines do not."""
    ux, uz = a[1][0] - a[0][0], a[1][2] - a[0][2]
    vx, vz = b[1][0] - b[0][0], b[1][2] - b[0][2]
    wx, wz = a[0][0] - b[0][0], a[0][2] - b[0][2]
    area = ux * vz - uz * vx
    if abs(area) < np.float32(1e-6):
        return False, ZERO, ZERO
    return True, (vx * wz - vz * wx) / area, (ux * wz - uz * wx) / area


@compiled
def contains(points: Records, count: int, point: Vector) -> bool:
    """Whether a polygon holds a point of the plane: crossings of a ray towards +X."""
    inside = False
    before = count - 1
    for here in range(count):
        here_x, here_z = points[here, 0], points[here, 2]
        before_x, before_z = points[before, 0], points[before, 2]
        if (here_z > point[2]) != (before_z > point[2]) and point[0] < (before_x - here_x) * (
            point[2] - here_z
        ) / (before_z - here_z) + here_x:
            inside = not inside
        before = here
    return inside


@compiled
def height_in_triangle(points: Records, point: Vector) -> tuple[bool, Real]:
    """The height of a triangle under or over a point; False where the point is beside it."""
    ax, ay, az = points[0, 0], points[0, 1], points[0, 2]
    v0x, v0y, v0z = points[2, 0] - ax, points[2, 1] - ay, points[2, 2] - az
    v1x, v1y, v1z = points[1, 0] - ax, points[1, 1] - ay, points[1, 2] - az
    v2x, v2z = point[0] - ax, point[2] - az
    area = v0x * v1z - v0z * v1x
    if abs(area) < np.float32(1e-6):
        return False, ZERO
    u = v1z * v2x - v1x * v2z
    v = v0x * v2z - v0z * v2x
    if area < ZERO:
        area = -area
        u = -u
        v = -v
    if u >= ZERO and v >= ZERO and u + v <= area:
        return True, ay + (v0y * u + v1y * v) / area
    return False, ZERO
