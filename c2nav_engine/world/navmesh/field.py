"""Distances to one fixed target: one search backwards from it, then a line for every question.

**Not quite Detour's answer.** `geodesic_m` searches forwards over polygons, places each where it
was first seen, and stops at the first way it proves; a field searches backwards over *openings*,
placed in the middle of their edges, to the end. Both then draw the shortest line in the corridor
they found. Where two corridors are about equally long they may choose differently, either being the
shorter one. Which points can be reached is the same, but for searches of more than 2,048 nodes,
which Detour gives up. Reported metrics use `geodesic_m`.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from numpy.typing import NDArray

from c2nav_engine.geometry import Point
from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.navmesh.arrays import MeshArrays
from c2nav_engine.world.navmesh.corridor import MAX_POLYGONS, Workspace, midpoint, portal, workspace
from c2nav_engine.world.navmesh.funnel import line_length, straighten
from c2nav_engine.world.navmesh.nearest import nearest_polygon
from c2nav_engine.world.navmesh.plane import Vector, distance, vector

_TARGET = -1


class Openings(NamedTuple):
    """The crossings of a mesh, one entry a link, whatever the target.

    Attributes:
        middle: Where each link leaves its polygon.
        source: The polygon it leaves.
        incoming: Links sorted by the polygon they enter; closed ones left out.
        first: Where in `incoming` each polygon's part starts, and the end of the last one's.
    """

    middle: NDArray[np.float32]
    source: NDArray[np.int64]
    incoming: NDArray[np.int64]
    first: NDArray[np.int64]


class Ways(NamedTuple):
    """The result of one search, one entry a link.

    Attributes:
        distance: From the link's opening to the target; infinite where there is no way.
        onward: The link to cross next, or -1 where the target's polygon is reached.
        polygon: Where the target lies; -1 where it is off the surface.
        target: Its surface point.
    """

    distance: NDArray[np.float64]
    onward: NDArray[np.int64]
    polygon: int
    target: Vector


def openings_of(mesh: MeshArrays) -> Openings:
    """Prepare the backward search once for a mesh."""
    count = len(mesh.polygons)
    source = np.repeat(np.arange(count), mesh.polygons["end_link"] - mesh.polygons["first_link"])
    target = mesh.links["target"].astype(np.int64)
    usable = np.flatnonzero((mesh.passable[source] & mesh.passable[target]).astype(bool))
    incoming = usable[np.argsort(target[usable], kind="stable")]
    first = np.searchsorted(target[incoming], np.arange(count + 1))
    middle = np.zeros((len(source), 3), np.float32)
    _fill_middles(mesh, source, middle)
    return Openings(middle, source, incoming, first)


@compiled
def _fill_middles(mesh: MeshArrays, source: np.ndarray, middle: np.ndarray) -> None:
    for link in range(len(source)):
        point = midpoint(portal(mesh, source[link], mesh.links[link]["target"]))
        middle[link, 0], middle[link, 1], middle[link, 2] = point[0], point[1], point[2]


@compiled
def _spread(openings: Openings, ways: Ways) -> None:
    """Dijkstra backwards from the target over all openings."""
    heap = [(0.0, np.int64(_TARGET))]
    while len(heap) > 0:
        reached, link = heapq.heappop(heap)
        polygon, here = ways.polygon, ways.target
        if link != _TARGET:
            if reached > ways.distance[link]:
                continue
            polygon, here = openings.source[link], vector(openings.middle[link])
        for index in range(openings.first[polygon], openings.first[polygon + 1]):
            before = openings.incoming[index]
            length = reached + np.float64(distance(here, vector(openings.middle[before])))
            if length < ways.distance[before]:
                ways.distance[before] = length
                ways.onward[before] = link
                heapq.heappush(heap, (length, before))


@compiled
def _best_exit(mesh: MeshArrays, openings: Openings, ways: Ways, start: tuple[int, Vector]) -> int:
    polygon, point = start
    record = mesh.polygons[polygon]
    best, chosen = np.inf, _TARGET
    for link in range(record["first_link"], record["end_link"]):
        length = ways.distance[link] + distance(point, vector(openings.middle[link]))
        if length < best:
            best, chosen = length, link
    return chosen


@compiled
def _distances(
    setting: tuple[MeshArrays, Openings, Ways],
    work: Workspace,
    points: np.ndarray,
    distances: np.ndarray,
) -> None:
    mesh, openings, ways = setting
    for row in range(len(points)):
        distances[row] = np.inf
        polygon, start = nearest_polygon(mesh, vector(points[row]))
        if polygon < 0 or ways.polygon < 0:
            continue
        work.corridor[0] = polygon
        length = 1
        if polygon != ways.polygon:
            link = _best_exit(mesh, openings, ways, (polygon, start))
            if link == _TARGET:
                continue
            while link != _TARGET and length < MAX_POLYGONS:
                work.corridor[length] = mesh.links[link]["target"]
                length += 1
                link = ways.onward[link]
            if link != _TARGET:
                continue
        count = straighten(mesh, work, length, (start, ways.target))
        if count > 0:
            distances[row] = line_length(work, count)


@dataclass(frozen=True, slots=True, eq=False)
class NavMeshField:
    """A `DistanceField` on a navigation mesh; see the module for how it differs from Detour.

    Distances run between surface points: both ends are snapped first.
    """

    mesh: MeshArrays
    openings: Openings
    ways: Ways

    def distance_m(self, point_m: Point) -> float:
        """Walkable distance from one point to the target; `inf` where there is no way."""
        return float(self.distances_m(np.array([point_m]))[0])

    def distances_m(self, points_m: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        """The same for many points at once."""
        distances = np.empty(len(points_m))
        points = np.nan_to_num(points_m, nan=np.inf).astype(np.float32)
        sound = np.isfinite(points).all(axis=1)
        inner = np.empty(int(sound.sum()))
        setting = (self.mesh, self.openings, self.ways)
        _distances(setting, workspace(self.mesh), points[sound], inner)
        distances[sound], distances[~sound] = inner, np.inf
        return distances


def field_to(mesh: MeshArrays, openings: Openings, target_m: Point) -> NavMeshField:
    """Search backwards from a target."""
    x, y, z = (np.float32(value) for value in target_m)
    polygon, point = nearest_polygon(mesh, (x, y, z))
    ways = Ways(
        distance=np.full(len(mesh.links), np.inf),
        onward=np.full(len(mesh.links), _TARGET, np.int64),
        polygon=int(polygon),
        target=point,
    )
    if polygon >= 0:
        _spread(openings, ways)
    return NavMeshField(mesh, openings, ways)
