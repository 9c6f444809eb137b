"""Snapping: the polygon nearest to a point, and where on it; after Detour's findNearestPoly.

A point over (or under) a polygon by less than the climb counts as on it. Ties go to the polygon
that is met first: tiles by row and column, polygons in the order of the bounding volume tree.
"""

from __future__ import annotations

import math

import numpy as np

from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.navmesh.arrays import MeshArrays, Records
from c2nav_engine.world.navmesh.plane import (
    LARGEST,
    ONE,
    ZERO,
    Real,
    Vector,
    between,
    contains,
    height_in_triangle,
    squared_distance,
    to_segment,
    vector,
)

HALF_EXTENT_X = np.float32(2.0)
HALF_EXTENT_Y = np.float32(4.0)
HALF_EXTENT_Z = np.float32(2.0)


@compiled
def on_polygon_edge(mesh: MeshArrays, polygon: int, point: Vector) -> Vector:
    """The nearest point of the polygon's own edges, without height detail."""
    record = mesh.polygons[polygon]
    best = LARGEST
    nearest = vector(record["points"][0])
    for here in range(record["corners"]):
        after = here + 1 if here + 1 < record["corners"] else 0
        start, end = vector(record["points"][here]), vector(record["points"][after])
        squared, share = to_segment(point, start, end)
        if squared < best:
            best = squared
            nearest = between(start, end, share)
    return nearest


@compiled
def _on_detail_edge(mesh: MeshArrays, polygon: int, point: Vector, outer_only: bool) -> Vector:
    record = mesh.polygons[polygon]
    best = LARGEST
    nearest = point
    for index in range(record["first_triangle"], record["end_triangle"]):
        triangle = mesh.triangles[index]
        before = 2
        for here in range(3):
            # An inner edge belongs to two triangles and is looked at from one of them only.
            order = triangle["order"]
            inner = (triangle["boundary"] >> before) & 1 == 0
            if not (inner and (outer_only or order[before] < order[here])):
                start = vector(triangle["points"][before])
                end = vector(triangle["points"][here])
                squared, share = to_segment(point, start, end)
                if squared < best:
                    best = squared
                    nearest = between(start, end, share)
            before = here
    if best == LARGEST:
        return on_polygon_edge(mesh, polygon, point)
    return nearest


@compiled
def polygon_height(mesh: MeshArrays, polygon: int, point: Vector) -> tuple[bool, Real]:
    """The surface height of a polygon at a point of the plane; False where it lies beside it."""
    record = mesh.polygons[polygon]
    if not contains(record["points"], record["corners"], point):
        return False, ZERO
    for index in range(record["first_triangle"], record["end_triangle"]):
        found, height = height_in_triangle(mesh.triangles[index]["points"], point)
        if found:
            return True, height
    return True, _on_detail_edge(mesh, polygon, point, False)[1]


@compiled
def closest_on_polygon(mesh: MeshArrays, polygon: int, point: Vector) -> tuple[bool, Vector]:
    """The nearest point of a polygon's surface, and whether the polygon lies over or under it."""
    over, height = polygon_height(mesh, polygon, point)
    if over:
        return True, (point[0], height, point[2])
    return False, _on_detail_edge(mesh, polygon, point, True)


@compiled
def _score(mesh: MeshArrays, polygon: int, point: Vector) -> tuple[Real, Vector]:
    over, closest = closest_on_polygon(mesh, polygon, point)
    if not over:
        return squared_distance(closest, point), closest
    climb = mesh.tiles[mesh.polygons[polygon]["tile"]]["climb"]
    above = abs(point[1] - closest[1]) - climb
    return (above * above if above > ZERO else ZERO), closest


@compiled
def _clamped(value: Real, low: Real, high: Real) -> Real:
    return min(max(value, low), high)


@compiled
def _in_tree(mesh: MeshArrays, tile_index: int, point: Vector) -> tuple[Real, int, Vector]:
    tile = mesh.tiles[tile_index]
    low = np.empty(3, np.int64)
    high = np.empty(3, np.int64)
    for axis, half in enumerate((HALF_EXTENT_X, HALF_EXTENT_Y, HALF_EXTENT_Z)):
        bottom, top = tile["low"][axis], tile["high"][axis]
        start = _clamped(point[axis] - half, bottom, top) - bottom
        stop = _clamped(point[axis] + half, bottom, top) - bottom
        low[axis] = np.int64(tile["quantum"] * start) & 0xFFFE
        high[axis] = (np.int64(tile["quantum"] * stop + ONE) & 0xFFFF) | 1
    best, found, nearest = LARGEST, -1, point
    index = tile["first_node"]
    while index < tile["end_node"]:
        node = mesh.nodes[index]
        overlap = True
        for axis in range(3):
            if low[axis] > node["high"][axis] or high[axis] < node["low"][axis]:
                overlap = False
        item = node["item"]
        if item >= 0 and overlap:
            polygon = tile["first_polygon"] + item
            if mesh.passable[polygon]:
                squared, closest = _score(mesh, polygon, point)
                if squared < best:
                    best, found, nearest = squared, polygon, closest
        index += 1 if overlap or item >= 0 else -item
    return best, found, nearest


@compiled
def _overlaps(points: Records, count: int, point: Vector) -> bool:
    for axis, half in enumerate((HALF_EXTENT_X, HALF_EXTENT_Y, HALF_EXTENT_Z)):
        low = points[0, axis]
        high = points[0, axis]
        for corner in range(1, count):
            low = min(low, points[corner, axis])
            high = max(high, points[corner, axis])
        if point[axis] - half > high or point[axis] + half < low:
            return False
    return True


@compiled
def _in_list(mesh: MeshArrays, tile_index: int, point: Vector) -> tuple[Real, int, Vector]:
    tile = mesh.tiles[tile_index]
    best, found, nearest = LARGEST, -1, point
    for polygon in range(tile["first_polygon"], tile["end_polygon"]):
        record = mesh.polygons[polygon]
        if mesh.passable[polygon] and _overlaps(record["points"], record["corners"], point):
            squared, closest = _score(mesh, polygon, point)
            if squared < best:
                best, found, nearest = squared, polygon, closest
    return best, found, nearest


@compiled
def _cell(position: Real, origin: Real, size: Real) -> int:
    return math.floor((position - origin) / size)


@compiled
def nearest_polygon(mesh: MeshArrays, point: Vector) -> tuple[int, Vector]:
    """The polygon within the search box that is nearest, or -1, and the nearest point on it."""
    grid = mesh.grid
    first_x = _cell(point[0] - HALF_EXTENT_X, grid[0], grid[2])
    last_x = _cell(point[0] + HALF_EXTENT_X, grid[0], grid[2])
    first_z = _cell(point[2] - HALF_EXTENT_Z, grid[1], grid[3])
    last_z = _cell(point[2] + HALF_EXTENT_Z, grid[1], grid[3])
    best, found, nearest = LARGEST, -1, point
    for index in range(len(mesh.tiles)):
        tile = mesh.tiles[index]
        if not (first_x <= tile["x"] <= last_x and first_z <= tile["z"] <= last_z):
            continue
        if tile["end_node"] > tile["first_node"]:
            squared, polygon, closest = _in_tree(mesh, index, point)
        else:
            squared, polygon, closest = _in_list(mesh, index, point)
        if squared < best:
            best, found, nearest = squared, polygon, closest
    return found, nearest
