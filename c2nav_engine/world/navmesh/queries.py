"""Compiled questions to a mesh, many at once: what `NavMesh` wraps and `query_pairs` times."""

from __future__ import annotations

import numpy as np

from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.navmesh.arrays import MeshArrays, Records
from c2nav_engine.world.navmesh.corridor import Workspace, find_corridor
from c2nav_engine.world.navmesh.funnel import line_length, straighten
from c2nav_engine.world.navmesh.nearest import nearest_polygon
from c2nav_engine.world.navmesh.plane import ONE, ZERO, Vector, distance, vector
from c2nav_engine.world.navmesh.slide import move_along

_NUDGE_M = np.float32(1e-4)


@compiled
def store(row: Records, point: Vector) -> None:
    """Write a point into an array of three."""
    row[0], row[1], row[2] = point[0], point[1], point[2]


@compiled
def _store_found(row: Records, polygon: int, point: Vector) -> None:
    store(row, point)
    if polygon < 0:
        row[:] = np.nan


@compiled
def snap(mesh: MeshArrays, point: Records, snapped: Records) -> int:
    """Fill the nearest surface point; its polygon, or -1 where none is in reach."""
    polygon, nearest = nearest_polygon(mesh, vector(point))
    store(snapped, nearest)
    return polygon


@compiled
def find_line(
    mesh: MeshArrays, work: Workspace, ends: Records, snapped: Records
) -> tuple[int, float]:
    """The line between two points: how many corners of `work.corners` it has, and its length.

    The corridor runs between the snapped points, which are filled in (nan: none in reach). The line
    in it runs between the points as given; pass one array as both for the line between the snapped
    ones. Without a way there are 0 corners and the length is infinite.
    """
    start, goal = vector(ends[0]), vector(ends[1])
    start_polygon, from_point = nearest_polygon(mesh, start)
    goal_polygon, to_point = nearest_polygon(mesh, goal)
    _store_found(snapped[0], start_polygon, from_point)
    _store_found(snapped[1], goal_polygon, to_point)
    if start_polygon < 0 or goal_polygon < 0:
        return 0, np.inf
    if mesh.island[start_polygon] != mesh.island[goal_polygon]:
        return 0, np.inf
    length = find_corridor(mesh, work, (start_polygon, from_point, goal_polygon, to_point))
    if length == 0:
        return 0, np.inf
    count = straighten(mesh, work, length, (vector(ends[0]), vector(ends[1])))
    return count, line_length(work, count) if count > 0 else np.inf


@compiled
def find_lengths(mesh: MeshArrays, work: Workspace, pairs: Records, lengths: Records) -> None:
    """Snap every pair in place and fill the length of the line between the snapped points."""
    for row in range(len(pairs)):
        _, lengths[row] = find_line(mesh, work, pairs[row], pairs[row])


@compiled
def find_moves(mesh: MeshArrays, pairs: Records, ended: Records) -> None:
    """Fill where each move from a surface point ends, sliding; nan where the start is off."""
    for row in range(len(pairs)):
        start, target = vector(pairs[row, 0]), vector(pairs[row, 1])
        polygon, _ = nearest_polygon(mesh, start)
        ended[row, :] = np.nan
        if polygon >= 0:
            polygon, end = move_along(mesh, polygon, (start, target), True)
            store(ended[row], end)


@compiled
def try_step(mesh: MeshArrays, move: Records, sliding: bool, ended: Records) -> None:
    """Fill where habitat-sim's own step ends.

    It refuses a target whose nearest surface lies on another island, and keeps an end point on a
    wall without thickness from being snapped to the other side of it.
    """
    start, target = vector(move[0]), vector(move[1])
    store(ended, start)
    polygon, snapped = nearest_polygon(mesh, start)
    goal, _ = nearest_polygon(mesh, target)
    if polygon < 0 or goal < 0 or mesh.island[polygon] != mesh.island[goal]:
        return
    last, end = move_along(mesh, polygon, (snapped, target), sliding)
    if last < 0:
        return
    landed, _ = nearest_polygon(mesh, end)
    if landed < 0 or mesh.island[landed] != mesh.island[polygon]:
        end = _nudged(mesh, last, end)
    store(ended, end)


@compiled
def _nudged(mesh: MeshArrays, polygon: int, point: Vector) -> Vector:
    record = mesh.polygons[polygon]
    x, y, z = ZERO, ZERO, ZERO
    for corner in range(record["corners"]):
        x += record["points"][corner, 0]
        y += record["points"][corner, 1]
        z += record["points"][corner, 2]
    share = ONE / np.float32(record["corners"])
    centre = (x * share, y * share, z * share)
    length = distance(point, centre)
    if not length > ZERO:
        return point
    step = _NUDGE_M / length
    return (
        point[0] + (centre[0] - point[0]) * step,
        point[1] + (centre[1] - point[1]) * step,
        point[2] + (centre[2] - point[2]) * step,
    )
