"""Moving on the surface: as near to the target as walls allow, after Detour's moveAlongSurface.

A breadth-first walk over the polygons around the move looks for the one that holds the target; the
walls on the way offer their nearest points. It sees at most 64 polygons and queues at most 48.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.navmesh.arrays import PORTAL, WALL, MeshArrays, Records
from c2nav_engine.world.navmesh.nearest import polygon_height
from c2nav_engine.world.navmesh.plane import (
    HALF,
    LARGEST,
    ONE,
    ZERO,
    Real,
    Vector,
    between,
    contains,
    crossing,
    distance,
    to_segment,
    vector,
)

MAX_SEEN = 64
MAX_QUEUE = 48
_MAX_NEIGHBOURS = 8
_SEEN, _HEAD, _TAIL = 0, 1, 2
_SLACK_M = np.float32(0.001)


@compiled
def _neighbours(mesh: MeshArrays, polygon: int, edge: int, found: Records) -> int:
    record = mesh.polygons[polygon]
    target = record["neighbours"][edge]
    if target == WALL:
        return 0
    if target != PORTAL:
        found[0] = target
        return 1 if mesh.passable[target] else 0
    count = 0
    for index in range(record["first_link"], record["end_link"]):
        link = mesh.links[index]
        if link["edge"] == edge and mesh.passable[link["target"]] and count < _MAX_NEIGHBOURS:
            found[count] = link["target"]
            count += 1
    return count


@compiled
def _crossed(move: tuple[Vector, Vector], edge: tuple[Vector, Vector]) -> tuple[bool, Real]:
    """Whether the straight move meets the edge, and at which share of the edge."""
    meets, of_edge, of_move = crossing(edge, move)
    return meets and ZERO <= of_edge <= ONE and ZERO <= of_move <= ONE, of_edge


@compiled
def _wall_point(
    move: tuple[Vector, Vector], edge: tuple[Vector, Vector], sliding: bool
) -> tuple[Real, Vector]:
    """Squared plane distance to the target, and the wall's point, where a blocked move ends."""
    if sliding:
        squared, share = to_segment(move[1], edge[0], edge[1])
        return squared, between(edge[0], edge[1], share)
    meets, share = _crossed(move, edge)
    if not meets:
        return LARGEST, move[0]
    point = between(edge[0], edge[1], share)
    dx, dz = move[1][0] - point[0], move[1][2] - point[2]
    return dx * dx + dz * dz, point


class _Front(NamedTuple):
    """The breadth-first walk so far.

    Attributes:
        seen: Polygons looked at, in the order of meeting them.
        queued: 1 for those that are or were in the queue.
        queue: Polygons to visit.
        tally: How many are seen; the queue's first place and the one behind its last.
        neighbours: Scratch memory.
    """

    seen: Records
    queued: Records
    queue: Records
    tally: Records
    neighbours: Records


@compiled
def _start(polygon: int) -> _Front:
    front = _Front(
        np.empty(MAX_SEEN, np.int32),
        np.zeros(MAX_SEEN, np.uint8),
        np.empty(MAX_SEEN, np.int32),
        np.zeros(3, np.int64),
        np.empty(_MAX_NEIGHBOURS, np.int32),
    )
    front.seen[0], front.queue[0], front.queued[0] = polygon, polygon, 1
    front.tally[_SEEN], front.tally[_TAIL] = 1, 1
    return front


@compiled
def _number(front: _Front, polygon: int) -> int:
    """The polygon's place among those seen, which it takes now if it is new; -1: no room."""
    known = front.tally[_SEEN]
    for index in range(known):
        if front.seen[index] == polygon:
            return index
    if known == MAX_SEEN:
        return -1
    front.seen[known] = polygon
    front.tally[_SEEN] = known + 1
    return known


@compiled
def _offer(front: _Front, polygon: int, near: bool) -> None:
    """Queue a polygon unless it was queued before, is out of reach, or the queue is full."""
    # Even a polygon out of reach takes a place among those seen.
    index = _number(front, polygon)
    if index < 0 or front.queued[index] or not near:
        return
    tail = front.tally[_TAIL]
    if tail - front.tally[_HEAD] < MAX_QUEUE:
        front.queued[index] = 1
        front.queue[tail] = polygon
        front.tally[_TAIL] = tail + 1


@compiled
def _within_reach(move: tuple[Vector, Vector], edge: tuple[Vector, Vector], sliding: bool) -> bool:
    centre = between(move[0], move[1], HALF)
    reach = distance(move[0], move[1]) * HALF + _SLACK_M
    if to_segment(centre, edge[0], edge[1])[0] > reach * reach:
        return False
    return sliding or _crossed(move, edge)[0]


@compiled
def move_along(
    mesh: MeshArrays, polygon: int, move: tuple[Vector, Vector], sliding: bool
) -> tuple[int, Vector]:
    """The polygon that the move ends on, or -1, and its end point at the surface's height."""
    front = _start(polygon)
    best, found, end = LARGEST, -1, move[0]
    while front.tally[_HEAD] < front.tally[_TAIL]:
        here = front.queue[front.tally[_HEAD]]
        front.tally[_HEAD] += 1
        record = mesh.polygons[here]
        count = record["corners"]
        if contains(record["points"], count, move[1]):
            found, end = here, move[1]
            break
        for step in range(count):
            before = count - 1 if step == 0 else step - 1
            edge = (vector(record["points"][before]), vector(record["points"][step]))
            ways = _neighbours(mesh, here, before, front.neighbours)
            if ways == 0:
                squared, point = _wall_point(move, edge, sliding)
                if squared < best:
                    best, found, end = squared, here, point
            else:
                near = _within_reach(move, edge, sliding)
                for way in range(ways):
                    _offer(front, front.neighbours[way], near)
    if found >= 0:
        on_surface, height = polygon_height(mesh, found, end)
        if on_surface:
            end = (end[0], height, end[2])
    return found, end
