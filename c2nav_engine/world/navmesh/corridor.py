"""Which polygons a path runs through: A* over edge midpoints, after Detour's findPath.

A node is a polygon together with the tile side it was entered by; its position is the midpoint of
the edge over which it was *first* seen and is not moved when a cheaper way is found. The heuristic
is 0.999 of the straight distance. More than 2,048 nodes or 256 polygons are no path at all, as in
habitat-sim. The heap and the order of links decide ties, so both follow Detour.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.navmesh.arrays import INSIDE, MeshArrays, Records
from c2nav_engine.world.navmesh.plane import HALF, ZERO, Vector, between, distance, vector

MAX_NODES = 2048
MAX_POLYGONS = 256
HEURISTIC = np.float32(0.999)
_WHOLE = 255
_STEP = np.float32(1.0) / np.float32(255.0)
_SIDES = 4
_NONE = -1
_NEW, _OPEN, _CLOSED = 0, 1, 2
_USED, _WAITING, _REFUSED, _CURRENT = 0, 1, 2, 3

NODE = np.dtype(
    [
        ("x", np.float32),
        ("y", np.float32),
        ("z", np.float32),
        ("cost", np.float32),
        ("total", np.float32),
        ("polygon", np.int32),
        ("slot", np.int32),
        ("parent", np.int32),
        ("state", np.int32),
    ],
    align=True,
)


class Workspace(NamedTuple):
    """Scratch memory of one thread, reused between searches.

    Attributes:
        nodes: Records of `NODE`.
        slots: Node of each (polygon, side), or -1; left clean by every search.
        heap: Open nodes, cheapest total first.
        tally: Nodes in use, open nodes, nodes refused for want of room, the node popped last.
        corridor: The polygons found.
        corners: Corners of a straightened path.
    """

    nodes: Records
    slots: Records
    heap: Records
    tally: Records
    corridor: Records
    corners: Records


def workspace(mesh: MeshArrays) -> Workspace:
    """Scratch memory for searches on this mesh."""
    return Workspace(
        nodes=np.empty(MAX_NODES, NODE),
        slots=np.full(len(mesh.polygons) * _SIDES, _NONE, np.int32),
        heap=np.empty(MAX_NODES + 1, np.int32),
        tally=np.zeros(4, np.int64),
        corridor=np.empty(MAX_POLYGONS, np.int32),
        corners=np.empty((MAX_POLYGONS, 3), np.float32),
    )


@compiled
def portal(mesh: MeshArrays, polygon: int, target: int) -> tuple[Vector, Vector]:
    """Both ends of the opening into a neighbour, left one first as the polygon sees it.

    Where several links lead there, the first counts.
    """
    record = mesh.polygons[polygon]
    chosen = record["first_link"]
    while mesh.links[chosen]["target"] != target:
        chosen += 1
    link = mesh.links[chosen]
    after = link["edge"] + 1 if link["edge"] + 1 < record["corners"] else 0
    left, right = vector(record["points"][link["edge"]]), vector(record["points"][after])
    if link["side"] != INSIDE and (link["low"] != 0 or link["high"] != _WHOLE):
        low, high = np.float32(link["low"]) * _STEP, np.float32(link["high"]) * _STEP
        return between(left, right, low), between(left, right, high)
    return left, right


@compiled
def midpoint(ends: tuple[Vector, Vector]) -> Vector:
    """Half way between two points."""
    a, b = ends
    return (a[0] + b[0]) * HALF, (a[1] + b[1]) * HALF, (a[2] + b[2]) * HALF


@compiled
def _rise(work: Workspace, place: int, node: int) -> None:
    """Put a node at a place of the heap and move dearer ones above it down."""
    heap, nodes = work.heap, work.nodes
    while place > 0:
        parent = (place - 1) // 2
        if not nodes[heap[parent]]["total"] > nodes[node]["total"]:
            break
        heap[place] = heap[parent]
        place = parent
    heap[place] = node


@compiled
def _pop(work: Workspace) -> int:
    """Take the cheapest node: the hole sinks to a leaf, then the last node rises from there."""
    heap, nodes = work.heap, work.nodes
    work.tally[_WAITING] -= 1
    top, size = heap[0], work.tally[_WAITING]
    place, child = 0, 1
    while child < size:
        if child + 1 < size and nodes[heap[child]]["total"] > nodes[heap[child + 1]]["total"]:
            child += 1
        heap[place] = heap[child]
        place, child = child, 2 * child + 1
    _rise(work, place, heap[size])
    return top


@compiled
def _push(work: Workspace, node: int) -> None:
    """Queue a node, or move one up that has become cheaper while it waited."""
    waiting = work.tally[_WAITING]
    if work.nodes[node]["state"] == _OPEN:
        for place in range(waiting):
            if work.heap[place] == node:
                _rise(work, place, node)
                return
    work.nodes[node]["state"] = _OPEN
    work.tally[_WAITING] = waiting + 1
    _rise(work, waiting, node)


@compiled
def _add(work: Workspace, polygon: int, side: int, position: Vector) -> int:
    """A new node, neither open nor closed; -1 where the pool is used up."""
    index = work.tally[_USED]
    if index == MAX_NODES:
        work.tally[_REFUSED] += 1
        return _NONE
    work.tally[_USED] = index + 1
    node = work.nodes[index]
    node["polygon"], node["slot"] = polygon, polygon * _SIDES + side
    node["parent"], node["state"] = _NONE, _NEW
    node["cost"] = ZERO
    node["x"], node["y"], node["z"] = position
    work.slots[node["slot"]] = index
    return index


@compiled
def _position(node: Records) -> Vector:
    return node["x"], node["y"], node["z"]


@compiled
def _expand(mesh: MeshArrays, work: Workspace, link: Records, goal: tuple[int, Vector]) -> None:
    """Offer the way over one link to its target; the node it leaves was popped just now."""
    best = work.tally[_CURRENT]
    target = link["target"]
    side = link["side"] >> 1 if link["side"] != INSIDE else 0
    index = work.slots[target * _SIDES + side]
    if index == _NONE:
        opening = portal(mesh, work.nodes[best]["polygon"], target)
        index = _add(work, target, side, midpoint(opening))
        if index == _NONE:
            return
    node = work.nodes[index]
    here = _position(node)
    cost = work.nodes[best]["cost"] + distance(_position(work.nodes[best]), here)
    ahead = distance(here, goal[1])
    if target == goal[0]:
        cost += ahead
        total = cost
    else:
        total = cost + ahead * HEURISTIC
    if node["state"] != _NEW and total >= node["total"]:
        return
    node["parent"], node["cost"], node["total"] = best, cost, total
    _push(work, index)


@compiled
def _search(mesh: MeshArrays, work: Workspace, ends: tuple[int, Vector, int, Vector]) -> int:
    """The node that reached the goal, or -1."""
    start_polygon, start, end_polygon, end = ends
    work.tally[:] = 0
    first = _add(work, start_polygon, 0, start)
    work.nodes[first]["total"] = distance(start, end) * HEURISTIC
    _push(work, first)
    while work.tally[_WAITING] > 0:
        best = _pop(work)
        work.tally[_CURRENT] = best
        node = work.nodes[best]
        node["state"] = _CLOSED
        if node["polygon"] == end_polygon:
            return best
        parent = node["parent"]
        came_from = work.nodes[parent]["polygon"] if parent != _NONE else _NONE
        record = mesh.polygons[node["polygon"]]
        for index in range(record["first_link"], record["end_link"]):
            link = mesh.links[index]
            if link["target"] != came_from and mesh.passable[link["target"]]:
                _expand(mesh, work, link, (end_polygon, end))
    return _NONE


@compiled
def find_corridor(mesh: MeshArrays, work: Workspace, ends: tuple[int, Vector, int, Vector]) -> int:
    """Fill `work.corridor` from the start's polygon to the end's; the number of polygons, or 0.

    `ends` are the start's polygon and point, then the end's.
    """
    if ends[0] == ends[2]:
        work.corridor[0] = ends[0]
        return 1
    goal = _search(mesh, work, ends)
    length = 0
    node = goal
    while node != _NONE:
        length += 1
        node = work.nodes[node]["parent"]
    if length <= MAX_POLYGONS:
        node = goal
        for place in range(length - 1, -1, -1):
            work.corridor[place] = work.nodes[node]["polygon"]
            node = work.nodes[node]["parent"]
    for index in range(work.tally[_USED]):
        work.slots[work.nodes[index]["slot"]] = _NONE
    return 0 if work.tally[_REFUSED] > 0 or length > MAX_POLYGONS else length
