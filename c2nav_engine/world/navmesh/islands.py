"""Islands: groups of polygons with a way between any two of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from numpy.typing import NDArray

from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.navmesh.arrays import MAX_CORNERS, MeshArrays, Records


@dataclass(frozen=True, slots=True)
class Island:
    """One connected part of the surface.

    Attributes:
        polygons: How many it has.
        area_m2: Its floor, slopes measured along the slope.
        lowest_m: Height of its lowest corner.
        highest_m: Height of its highest corner: stairs join storeys into one island.
    """

    polygons: int
    area_m2: float
    lowest_m: float
    highest_m: float


def polygon_areas_m2(mesh: MeshArrays) -> Float[np.ndarray, " p"]:
    """Area of every polygon's detail triangles, along the slope."""
    points = mesh.triangles["points"].astype(np.float64)
    cross = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    areas = 0.5 * np.linalg.norm(cross, axis=1)
    owner = np.repeat(
        np.arange(len(mesh.polygons)),
        mesh.polygons["end_triangle"] - mesh.polygons["first_triangle"],
    )
    return np.bincount(owner, areas, len(mesh.polygons))


def label_islands(mesh: MeshArrays) -> Int[np.ndarray, " p"]:
    """The island of every polygon, numbered in order of first appearance; -1 where none may walk.

    A link in one direction is enough to belong together, so different islands have no way between
    them in either direction.
    """
    labels = np.arange(len(mesh.polygons), dtype=np.int64)
    _merge(mesh, labels)
    open_ = mesh.passable.astype(bool)
    _, first_seen = np.unique(labels[open_], return_inverse=True)
    labels[open_], labels[~open_] = first_seen, -1
    return labels


@compiled
def _merge(mesh: MeshArrays, labels: Records) -> None:
    """Replace every label by the lowest polygon number of its island."""
    for polygon in range(len(labels)):
        if not mesh.passable[polygon]:
            continue
        record = mesh.polygons[polygon]
        for index in range(record["first_link"], record["end_link"]):
            target = mesh.links[index]["target"]
            if mesh.passable[target]:
                a, b = _root(labels, polygon), _root(labels, target)
                labels[max(a, b)] = min(a, b)
    for polygon in range(len(labels)):
        labels[polygon] = _root(labels, polygon)


@compiled
def _root(labels: Records, polygon: int) -> int:
    while labels[polygon] != polygon:
        labels[polygon] = labels[labels[polygon]]
        polygon = labels[polygon]
    return polygon


def describe_islands(mesh: MeshArrays) -> tuple[Island, ...]:
    """Size and height of every island, in the order of their numbers."""
    areas = polygon_areas_m2(mesh)
    corners: NDArray[np.int32] = mesh.polygons["corners"]
    heights: NDArray[np.float32] = mesh.polygons["points"][..., 1]
    used: NDArray[np.bool_] = np.arange(MAX_CORNERS) < corners[:, None]
    islands: list[Island] = []
    for number in range(int(mesh.island.max(initial=-1)) + 1):
        members = mesh.island == number
        inside = heights[members[:, None] & used]
        islands.append(
            Island(
                int(members.sum()),
                float(areas[members].sum()),
                float(inside.min()),
                float(inside.max()),
            )
        )
    return tuple(islands)
