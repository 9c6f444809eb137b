"""The shortest line inside a corridor of polygons: the funnel rule, after findStraightPath.

An apex, a left and a right boundary narrow portal by portal; when they cross, the inner one becomes
a corner and the walk starts again from there.
"""

from __future__ import annotations

import numpy as np

from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.navmesh.arrays import MeshArrays
from c2nav_engine.world.navmesh.corridor import MAX_POLYGONS, Workspace, portal
from c2nav_engine.world.navmesh.nearest import on_polygon_edge
from c2nav_engine.world.navmesh.plane import (
    SAME_POINT_SQUARED,
    ZERO,
    Vector,
    contains,
    side_of,
    squared_distance,
    to_segment,
    vector,
)

_NOTHING, _NARROWS, _CROSSES = 0, 1, 2
_AT_PORTAL_SQUARED = np.float32(0.001) * np.float32(0.001)


@compiled
def same_point(a: Vector, b: Vector) -> bool:
    """Whether two points are less than 1/16384 m apart."""
    return squared_distance(a, b) < SAME_POINT_SQUARED


@compiled
def _into_polygon(mesh: MeshArrays, polygon: int, point: Vector) -> Vector:
    """A point of the plane inside the polygon, height kept; outside, the nearest edge point."""
    record = mesh.polygons[polygon]
    if contains(record["points"], record["corners"], point):
        return point
    return on_polygon_edge(mesh, polygon, point)


@compiled
def _append(work: Workspace, count: int, point: Vector) -> int:
    corners = work.corners
    if count > 0 and same_point(vector(corners[count - 1]), point):
        return count
    corners[count, 0], corners[count, 1], corners[count, 2] = point
    return count + 1


@compiled
def _right_of_funnel(apex: Vector, left: Vector, right: Vector, point: Vector) -> int:
    """What a portal's right end does: 0 nothing, 1 narrows the funnel, 2 crosses its left side."""
    if side_of(apex, right, point) > ZERO:
        return _NOTHING
    if same_point(apex, right) or side_of(apex, left, point) > ZERO:
        return _NARROWS
    return _CROSSES


@compiled
def _left_of_funnel(apex: Vector, left: Vector, right: Vector, point: Vector) -> int:
    """The same for a portal's left end."""
    if side_of(apex, left, point) < ZERO:
        return _NOTHING
    if same_point(apex, left) or side_of(apex, right, point) < ZERO:
        return _NARROWS
    return _CROSSES


@compiled
def _portal_at(
    mesh: MeshArrays, work: Workspace, where: tuple[int, int], last: Vector
) -> tuple[Vector, Vector]:
    """The opening behind a place of the corridor; the end of the line stands for the last one."""
    place, length = where
    if place + 1 < length:
        return portal(mesh, work.corridor[place], work.corridor[place + 1])
    return last, last


@compiled
def _walk(
    mesh: MeshArrays, work: Workspace, length: int, ends: tuple[Vector, Vector]
) -> tuple[int, bool]:
    """Corners so far, and whether the line is complete without its end."""
    first, last = ends
    count = _append(work, 0, first)
    apex, left, right = first, first, first
    left_at, right_at = 0, 0
    place = -1
    while place + 1 < length:
        place += 1
        next_left, next_right = _portal_at(mesh, work, (place, length), last)
        # A start on the first portal itself would collapse the funnel.
        if place == 0 and to_segment(apex, next_left, next_right)[0] < _AT_PORTAL_SQUARED:
            continue
        on_right = _right_of_funnel(apex, left, right, next_right)
        if on_right == _NARROWS:
            right, right_at = next_right, place
        on_left = _NOTHING
        if on_right != _CROSSES:
            on_left = _left_of_funnel(apex, left, right, next_left)
        if on_left == _NARROWS:
            left, left_at = next_left, place
        if on_right != _CROSSES and on_left != _CROSSES:
            continue
        apex, place = (left, left_at) if on_right == _CROSSES else (right, right_at)
        before, count = count, _append(work, count, apex)
        # Full, or the end itself became the corner.
        if count == MAX_POLYGONS or (place + 1 == length and count > before):
            return count, True
        left, right, left_at, right_at = apex, apex, place, place
    return count, False


@compiled
def straighten(mesh: MeshArrays, work: Workspace, length: int, ends: tuple[Vector, Vector]) -> int:
    """Fill `work.corners` with the line through the corridor; the number of corners.

    0 where 256 corners do not suffice, which habitat-sim reports as no path.
    """
    first = _into_polygon(mesh, work.corridor[0], ends[0])
    last = _into_polygon(mesh, work.corridor[length - 1], ends[1])
    if length == 1:
        count = _append(work, _append(work, 0, first), last)
    else:
        count, complete = _walk(mesh, work, length, (first, last))
        if not complete:
            count = _append(work, count, last)
    return 0 if count == MAX_POLYGONS else count


@compiled
def line_length(work: Workspace, count: int) -> float:
    """Length of the first `count` corners' line in space, metres."""
    total = 0.0
    for index in range(1, count):
        squared = squared_distance(vector(work.corners[index - 1]), vector(work.corners[index]))
        total += np.sqrt(np.float64(squared))
    return total
