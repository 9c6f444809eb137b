"""Meshes of millions of triangles made light enough for a browser: for people, never for the robot.

Vertices that share a cell of a grid become one, at their mean; triangles that collapse go. Texture
coordinates belong to corners, so pictures shift by less than a cell and never bleed across seams.
"""

from __future__ import annotations

import math

import numpy as np
from jaxtyping import Bool, Float32, Float64, Int, Int32, Int64, Shaped

from c2nav_engine.world.scene import Part, Scene

LIGHT_VERSION = 1
"""Counts changes of the method: lighter meshes of an older one are made again."""

LIGHT_TRIANGLES = 1_000_000
"""What a browser on a laptop turns without stutter [C]."""

REGION_M = 4.0
"""Side of the regions that a mesh is split into, so that it arrives piece by piece [C]."""

_LEAST_GROWTH = 1.15
_SAMPLED = 200_000
"""Triangles that the area is estimated from."""


def lightened(scene: Scene, *, triangles: int = LIGHT_TRIANGLES) -> Scene:
    """The scene with at most that many triangles, each part split into regions.

    A scene that has no more triangles than asked for is split but otherwise left as it is.

    Args:
        scene: Any scene.
        triangles: The most that may stay; at least 1.
    """
    cell_m = _cell_for(scene, triangles)
    kept, corners, vertices_m, colours = _untouched(scene)
    while len(kept) > triangles:
        cell_of, count = _cells(scene.vertices_m, cell_m)
        kept, corners = _survivors(scene, cell_of)
        vertices_m = means(scene.vertices_m, cell_of, count).astype(np.float32)
        colours = None if scene.colours is None else _colours(scene.colours, cell_of, count)
        # Triangles of a surface go with the square of the cell, so this lands near the target.
        cell_m *= max(_LEAST_GROWTH, math.sqrt(len(kept) / triangles))
    part_of = scene.part_of_triangle[kept]
    order, parts = _regions(scene, part_of, vertices_m[corners].mean(axis=1))
    return Scene(
        name=scene.name,
        vertices_m=vertices_m,
        triangles=np.ascontiguousarray(corners[order]),
        parts=parts,
        materials=scene.materials,
        uvs=None if scene.uvs is None else np.ascontiguousarray(scene.uvs[kept[order]]),
        colours=colours,
        licence=scene.licence,
    )


def _cell_for(scene: Scene, triangles: int) -> float:
    """A cell that leaves about so many: a smooth surface crosses one cell in two triangles."""
    corners_m = scene.vertices_m[scene.triangles[:: max(1, len(scene.triangles) // _SAMPLED)]]
    cross = np.cross(corners_m[:, 1] - corners_m[:, 0], corners_m[:, 2] - corners_m[:, 0])
    area_m2 = float(np.linalg.norm(cross, axis=1).mean()) / 2.0 * len(scene.triangles)
    return math.sqrt(2.0 * area_m2 / triangles)


def _untouched(
    scene: Scene,
) -> tuple[
    Int64[np.ndarray, " n"], Int32[np.ndarray, "n 3"], Float32[np.ndarray, "v 3"], np.ndarray | None
]:
    return np.arange(len(scene.triangles)), scene.triangles, scene.vertices_m, scene.colours


def _cells(
    vertices_m: Float32[np.ndarray, "v 3"], cell_m: float
) -> tuple[Int32[np.ndarray, " v"], int]:
    """Number of the occupied cell that each vertex lies in, and how many cells there are."""
    steps = np.floor((vertices_m - vertices_m.min(axis=0)) / np.float32(cell_m)).astype(np.int64)
    span = steps.max(axis=0) + 1
    keys = (steps[:, 0] * span[1] + steps[:, 1]) * span[2] + steps[:, 2]
    found, cell_of = np.unique(keys, return_inverse=True)
    return cell_of.astype(np.int32), len(found)


def _survivors(
    scene: Scene, cell_of: Int32[np.ndarray, " v"]
) -> tuple[Int64[np.ndarray, " n"], Int32[np.ndarray, "n 3"]]:
    """Triangles whose corners lie in three cells, one of each set of three and each material."""
    corners = cell_of[scene.triangles]
    kept = np.flatnonzero(_distinct(corners))
    corners = corners[kept]
    material = np.array([part.material for part in scene.parts])[scene.part_of_triangle[kept]]
    low, middle, high = np.sort(corners, axis=1).T
    order = np.lexsort((high, middle, low, material))
    same = np.ones(len(order), dtype=np.bool_)
    for column in (high, middle, low, material):
        same[1:] &= column[order[1:]] == column[order[:-1]]
    same[:1] = False
    first = np.sort(order[~same])
    return kept[first], corners[first]


def _distinct(corners: Int32[np.ndarray, "n 3"]) -> Bool[np.ndarray, " n"]:
    a, b, c = corners.T
    return (a != b) & (b != c) & (a != c)


def means(
    values: Shaped[np.ndarray, "n k"], group: Int[np.ndarray, " n"], count: int
) -> Float64[np.ndarray, "count k"]:
    """Mean of the values of each group from 0 to `count`; zeros for a group without any."""
    weights = np.maximum(np.bincount(group, minlength=count), 1)
    sums = [np.bincount(group, column, minlength=count) for column in values.T]
    return np.stack([total / weights for total in sums], axis=1)


def _colours(colours: np.ndarray, cell_of: Int32[np.ndarray, " v"], count: int) -> np.ndarray:
    return means(colours, cell_of, count).round().astype(np.uint8)


def _regions(
    scene: Scene, part_of: Int32[np.ndarray, " n"], centres_m: Float32[np.ndarray, "n 3"]
) -> tuple[Int64[np.ndarray, " n"], tuple[Part, ...]]:
    """The order that puts triangles of one part and region together, and the parts that result."""
    steps = np.floor((centres_m - scene.bounds_m[0]) / REGION_M).astype(np.int64)
    span = steps.max(axis=0) + 1
    key = ((part_of * span[1] + steps[:, 1]) * span[0] + steps[:, 0]) * span[2] + steps[:, 2]
    order = np.argsort(key, kind="stable")
    starts = np.flatnonzero(np.diff(key[order], prepend=-1))
    stops = [*starts[1:].tolist(), len(order)]
    parts = [scene.parts[part_of[order[start]]] for start in starts]
    return order, tuple(
        Part(part.name, part.material, int(first), int(stop))
        for part, first, stop in zip(parts, starts, stops, strict=True)
    )
