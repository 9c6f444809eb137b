"""Distances to one fixed target, prepared once: the true shortest lines on the surface.

**Not Detour's answer, and never longer than it.** `geodesic_m` first picks a corridor of polygons
by the middles of their edges, in single precision, then the shortest line inside that corridor; a
better corridor may exist. A field takes the shortest line over all corridors: every corner of the
mesh knows which corners it sees, one search from the target gives each its distance, and a question
looks around for the corner that is best to walk to. Fields have no limit of 2,048 nodes or 256
polygons either. They obey the triangle inequality; reported metrics use `geodesic_m`.

Both measure straight in space from bend to bend, and both run between surface points. Where tiles
meet, an opening is kept in 255ths of the edge and differs by one of them from side to side; by that
much a field, searched from the target's side, may exceed Detour's answer.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from c2nav_engine.geometry import Point
from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.navmesh.arrays import MeshArrays, Records
from c2nav_engine.world.navmesh.nearest import nearest_polygon
from c2nav_engine.world.navmesh.plane import Real, vector
from c2nav_engine.world.navmesh.sight import Corners, View, corners_of, look, view_of

_NOWHERE = -1


class Sights(NamedTuple):
    """Which corner sees which, whatever the target.

    Attributes:
        corners: The mesh's corners.
        first: Where in `neighbours` each corner's part starts, and the end of the last one's.
        neighbours: The corners in sight of it.
    """

    corners: Corners
    first: Records
    neighbours: Records


class Goal(NamedTuple):
    """A target: its polygon (-1: off the surface) and its point on it."""

    polygon: int
    x: float
    y: float
    z: float


def sights_of(mesh: MeshArrays) -> Sights:
    """Look around from every corner, once for a mesh."""
    corners = corners_of(mesh)
    view = view_of(corners)
    first = np.zeros(len(corners.points) + 1, np.int64)
    parts: list[Records] = []
    for corner, (x, _, z) in enumerate(corners.points):
        spot = (int(corners.polygon[corner]), float(x), float(z))
        look(mesh, corners, view, (spot, (_NOWHERE, 0.0, 0.0)))
        seen = np.unique(view.seen[: view.tally[0]])
        parts.append(seen[seen != corner])
        first[corner + 1] = first[corner] + len(parts[-1])
    return Sights(corners, first, np.concatenate([*parts, np.empty(0, np.int64)]))


@compiled
def _apart(points: Records, corner: int, other: tuple[Real, Real, Real]) -> float:
    dx, dy, dz = (
        points[corner, 0] - other[0],
        points[corner, 1] - other[1],
        points[corner, 2] - other[2],
    )
    return np.sqrt(dx * dx + dy * dy + dz * dz)


@compiled
def _spread(mesh: MeshArrays, sights: Sights, view: View, goal: Goal) -> Records:
    """Distance of every corner to the target: Dijkstra over lines of sight."""
    points = sights.corners.points
    distances = np.full(len(points), np.inf)
    place = (goal.x, goal.y, goal.z)
    look(mesh, sights.corners, view, ((goal.polygon, goal.x, goal.z), (_NOWHERE, 0.0, 0.0)))
    heap: list[tuple[Any, Any]] = [(np.inf, np.int64(_NOWHERE))]
    for index in range(view.tally[0]):
        corner = view.seen[index]
        distances[corner] = _apart(points, corner, place)
        heapq.heappush(heap, (distances[corner], corner))
    while heap[0][1] != _NOWHERE:
        reached, corner = heapq.heappop(heap)
        if reached > distances[corner]:
            continue
        here = (points[corner, 0], points[corner, 1], points[corner, 2])
        for index in range(sights.first[corner], sights.first[corner + 1]):
            neighbour = sights.neighbours[index]
            length = reached + _apart(points, neighbour, here)
            if length < distances[neighbour]:
                distances[neighbour] = length
                heapq.heappush(heap, (length, neighbour))
    return distances


@compiled
def _measure(
    setting: tuple[MeshArrays, Corners, View, Goal],
    known: Records,
    starts: Records,
    distances: Records,
) -> None:
    """Fill the distance of every start; `known` are the corners' own."""
    mesh, corners, view, goal = setting
    for row in range(len(starts)):
        distances[row] = np.inf
        polygon, start = nearest_polygon(mesh, vector(starts[row]))
        if polygon < 0 or mesh.island[polygon] != mesh.island[goal.polygon]:
            continue
        here = (np.float64(start[0]), np.float64(start[1]), np.float64(start[2]))
        spot = (polygon, here[0], here[2])
        if look(mesh, corners, view, (spot, (goal.polygon, goal.x, goal.z))):
            dx, dy, dz = here[0] - goal.x, here[1] - goal.y, here[2] - goal.z
            distances[row] = np.sqrt(dx * dx + dy * dy + dz * dz)
            continue
        for index in range(view.tally[0]):
            corner = view.seen[index]
            length = known[corner] + _apart(corners.points, corner, here)
            distances[row] = min(distances[row], length)


@dataclass(frozen=True, slots=True, eq=False)
class NavMeshField:
    """A `DistanceField` on a navigation mesh; the module says how it differs from Detour.

    Attributes:
        mesh: The mesh that is asked.
        corners: Its corners.
        goal: The target on the surface.
        known_m: Distance of every corner to it; `inf` where there is no way.
    """

    mesh: MeshArrays
    corners: Corners
    goal: Goal
    known_m: Float[np.ndarray, " corners"]

    def distance_m(self, point_m: Point) -> float:
        """Walkable distance from one point to the target; `inf` where there is no way."""
        return float(self.distances_m(np.array([point_m], np.float64))[0])

    def distances_m(self, points_m: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        """The same for many points at once."""
        distances = np.full(len(points_m), np.inf)
        with np.errstate(over="ignore"):
            points = points_m.astype(np.float32)
        sound = np.isfinite(points).all(axis=1)
        if self.goal.polygon >= 0:
            inner = np.empty(int(sound.sum()))
            setting = (self.mesh, self.corners, view_of(self.corners), self.goal)
            _measure(setting, self.known_m, points[sound], inner)
            distances[sound] = inner
        return distances


def field_to(mesh: MeshArrays, sights: Sights, target_m: Point) -> NavMeshField:
    """Search from a target, which is snapped first."""
    x, y, z = (np.float32(value) for value in target_m)
    polygon, point = nearest_polygon(mesh, (x, y, z))
    goal = Goal(int(polygon), float(point[0]), float(point[1]), float(point[2]))
    if polygon < 0:
        known = np.full(len(sights.corners.points), np.inf)
    else:
        known = _spread(mesh, sights, view_of(sights.corners), goal)
    return NavMeshField(mesh, sights.corners, goal, known)
