"""What can be seen along the surface from a point: cones of sight through opening after opening.

Walls end sight, heights do not: everything happens in the X–Z plane, on the polygons that openings
lead to, so storeys above one another stay apart. Shortest lines bend only where openings end
("corners"); two points see each other when the straight line between them stays on the surface.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.navmesh.arrays import MeshArrays, Records
from c2nav_engine.world.navmesh.corridor import portal
from c2nav_engine.world.navmesh.plane import Real

_ON_EDGE_M = 2e-5
_MOST_CONES = 4096
_MOST_STARTS = 32
_SEEN, _STARTS, _CONES = 0, 1, 2

Spot = tuple[int, Real, Real]
"""A polygon and a point (x, z) on it."""
Plane = tuple[Real, Real]
"""A point (x, z)."""


class Corners(NamedTuple):
    """Ends of openings, each position once.

    Attributes:
        points: Positions, double precision.
        ends: Left and right corner of every link, in the order of the mesh's links.
        usable: 1 for links between two passable polygons.
        polygon: For each corner, a polygon that it lies on.
    """

    points: Records
    ends: Records
    usable: Records
    polygon: Records


class View(NamedTuple):
    """Scratch memory and result of looking around.

    Attributes:
        seen: Corners in sight; some more than once.
        starts: Polygons that the eye lies on.
        cones: Polygon of each waiting cone.
        rays: Its bounds: (left x, left z, right x, right z).
        tally: How many of each: corners, starts, cones.
    """

    seen: Records
    starts: Records
    cones: Records
    rays: Records
    tally: Records


def corners_of(mesh: MeshArrays) -> Corners:
    """Collect the corners of a mesh."""
    count = len(mesh.polygons)
    source = np.repeat(np.arange(count), mesh.polygons["end_link"] - mesh.polygons["first_link"])
    target = mesh.links["target"].astype(np.int64)
    positions = np.zeros((2 * len(source), 3))
    _fill_ends(mesh, source, positions)
    points, index = np.unique(positions, axis=0, return_inverse=True)
    ends = index.reshape(-1, 2).astype(np.int64)
    polygon = np.zeros(len(points), np.int64)
    polygon[ends[:, 0]] = source
    polygon[ends[:, 1]] = source
    usable = (mesh.passable[source] & mesh.passable[target]).astype(np.uint8)
    return Corners(points, ends, usable, polygon)


def view_of(corners: Corners) -> View:
    """Scratch memory for looking around."""
    # Cones do not overlap, so a corner is met about once for each opening that ends in it.
    return View(
        seen=np.empty(8 * len(corners.ends) + 1024, np.int64),
        starts=np.empty(_MOST_STARTS, np.int64),
        cones=np.empty(_MOST_CONES, np.int64),
        rays=np.empty((_MOST_CONES, 4)),
        tally=np.zeros(3, np.int64),
    )


@compiled
def _fill_ends(mesh: MeshArrays, source: Records, positions: Records) -> None:
    for link in range(len(source)):
        left, right = portal(mesh, source[link], mesh.links[link]["target"])
        for axis in range(3):
            positions[2 * link, axis] = left[axis]
            positions[2 * link + 1, axis] = right[axis]


@compiled
def _opening(corners: Corners, link: int) -> tuple[Plane, Plane]:
    left, right = corners.points[corners.ends[link, 0]], corners.points[corners.ends[link, 1]]
    return (left[0], left[2]), (right[0], right[2])


@compiled
def _turn(eye: Spot, left: Plane, right: Plane) -> Real:
    """Twice an area: positive where the first point lies left of the second, seen from the eye."""
    return (right[0] - eye[1]) * (left[1] - eye[2]) - (left[0] - eye[1]) * (right[1] - eye[2])


@compiled
def _see(view: View, corner: int) -> None:
    count = view.tally[_SEEN]
    if count < len(view.seen):
        view.seen[count] = corner
        view.tally[_SEEN] = count + 1


@compiled
def _stand_on(view: View, polygon: int) -> None:
    count = view.tally[_STARTS]
    for index in range(count):
        if view.starts[index] == polygon:
            return
    if count < _MOST_STARTS:
        view.starts[count] = polygon
        view.tally[_STARTS] = count + 1


@compiled
def _add_cone(view: View, polygon: int, left: Plane, right: Plane) -> None:
    count = view.tally[_CONES]
    if count < _MOST_CONES:
        view.cones[count] = polygon
        view.rays[count, 0], view.rays[count, 1] = left
        view.rays[count, 2], view.rays[count, 3] = right
        view.tally[_CONES] = count + 1


@compiled
def _look_out(corners: Corners, view: View, eye: Spot, step: tuple[int, int]) -> None:
    """Through one opening (link, polygon behind it) of a polygon that the eye lies on."""
    link, behind = step
    left, right = _opening(corners, link)
    _see(view, corners.ends[link, 0])
    _see(view, corners.ends[link, 1])
    along_x, along_z = right[0] - left[0], right[1] - left[1]
    squared = along_x * along_x + along_z * along_z
    slack = _ON_EDGE_M * np.sqrt(squared)
    if _turn(eye, left, right) > slack:
        _add_cone(view, behind, left, right)
        return
    # An eye on the opening itself stands on the polygon behind it, too.
    share = (eye[1] - left[0]) * along_x + (eye[2] - left[1]) * along_z
    if -slack <= share <= squared + slack:
        _stand_on(view, behind)


@compiled
def _look_on(corners: Corners, view: View, eye: Spot, step: tuple[int, int, Plane, Plane]) -> None:
    """Through one more opening (link, polygon behind it) inside a cone (its left, its right)."""
    link, behind, cone_left, cone_right = step
    left, right = _opening(corners, link)
    # The opening through which the cone came in shows its back.
    if not _turn(eye, left, right) > 0.0:
        return
    inside_left, inside_right = _turn(eye, cone_left, left), _turn(eye, right, cone_right)
    if inside_left >= 0.0 and _turn(eye, left, cone_right) >= 0.0:
        _see(view, corners.ends[link, 0])
    if inside_right >= 0.0 and _turn(eye, cone_left, right) >= 0.0:
        _see(view, corners.ends[link, 1])
    if inside_left >= 0.0:
        cone_left = left
    if inside_right >= 0.0:
        cone_right = right
    if _turn(eye, cone_left, cone_right) > 0.0:
        _add_cone(view, behind, cone_left, cone_right)


@compiled
def look(mesh: MeshArrays, corners: Corners, view: View, spots: tuple[Spot, Spot]) -> bool:
    """List the corners in sight of the first spot; whether the second spot is in sight.

    More than 4,096 cones at once, or more than 65,536 in all, are given up: no sound mesh has them.
    """
    eye, watched = spots
    view.tally[:] = 0
    _stand_on(view, eye[0])
    hit = False
    index = 0
    while index < view.tally[_STARTS]:
        polygon = view.starts[index]
        index += 1
        hit = hit or polygon == watched[0]
        record = mesh.polygons[polygon]
        for link in range(record["first_link"], record["end_link"]):
            if corners.usable[link]:
                _look_out(corners, view, eye, (link, mesh.links[link]["target"]))
    for _ in range(65536):
        if view.tally[_CONES] == 0:
            break
        view.tally[_CONES] -= 1
        top = view.tally[_CONES]
        polygon = view.cones[top]
        left, right = (view.rays[top, 0], view.rays[top, 1]), (view.rays[top, 2], view.rays[top, 3])
        if polygon == watched[0]:
            point = (watched[1], watched[2])
            hit = hit or (_turn(eye, left, point) >= 0.0 and _turn(eye, point, right) >= 0.0)
        record = mesh.polygons[polygon]
        for link in range(record["first_link"], record["end_link"]):
            if corners.usable[link]:
                _look_on(corners, view, eye, (link, mesh.links[link]["target"], left, right))
    return hit
