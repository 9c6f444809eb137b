"""One material's triangles below the cut, as they are sent: vertices are shared where they may be.

A browser reckons with every vertex of every frame, so a scan whose triangles share theirs is drawn
several times faster than a heap of single triangles. A vertex is shared where its triangles agree
about it; the corners of a box, lit from three sides, stay three.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Int, Int64

from app.inspector.scene.cutting import cut_below
from app.inspector.scene.glb import Surface
from app.inspector.scene.shading import shades_of
from c2nav_engine.world.scene import Material, Scene

_UV, _COLOUR, _LIGHT = 1e-5, 0.5, 0.1
"""How far triangles may differ about a vertex that they share: in pictures, in steps of 255, in
shares of light [C]."""


@dataclass(frozen=True, slots=True)
class _Layout:
    """What a corner holds besides its position: texture coordinates, colour, light."""

    textured: bool
    coloured: bool
    lit: bool

    @property
    def tolerances(self) -> Float32[np.ndarray, " values"]:
        kinds = ((self.textured, _UV, 2), (self.coloured, _COLOUR, 4), (self.lit, _LIGHT, 1))
        return np.array([tol for held, tol, count in kinds if held for _ in range(count)], "f4")

    @property
    def width(self) -> int:
        return len(self.tolerances)

    def values(
        self,
        mesh: Scene,
        rows: Int64[np.ndarray, " n"],
        corners_m: Float32[np.ndarray, "n 3 3"],
    ) -> Float32[np.ndarray, "n 3 values"]:
        found = [np.zeros((len(rows), 3, 0), np.float32)]
        if self.textured and mesh.uvs is not None:
            found.append(mesh.uvs[rows])
        if self.coloured and mesh.colours is not None:
            found.append(mesh.colours[mesh.triangles[rows]].astype(np.float32))
        if self.lit:
            found.append(np.repeat(shades_of(corners_m), 3).reshape(-1, 3, 1))
        return np.concatenate(found, axis=2)

    def surface(
        self,
        positions_m: Float32[np.ndarray, "m 3"],
        triangles: Int64[np.ndarray, "n 3"],
        values: Float32[np.ndarray, "m values"],
        material: Material,
    ) -> Surface:
        uvs, colours, light = np.split(values, [2 * self.textured, self.width - self.lit], 1)
        return Surface(
            positions_m=positions_m,
            triangles=triangles.astype(np.uint32),
            material=material,
            # Ours count from the bottom, glTF's from the top.
            uvs=uvs * np.array([1.0, -1.0], "f4") + np.array([0.0, 1.0], "f4")
            if self.textured
            else None,
            colours=colours.round().clip(0, 255).astype(np.uint8) if self.coloured else None,
            shades=light[:, 0] if self.lit else None,
        )


def surface_below(
    mesh: Scene, material: int, rows: Int64[np.ndarray, " n"], height_m: float
) -> Surface | None:
    """Triangles of one material, cut off at a height, the topmost first; None where none is left.

    Seen from above, what is high hides what is low: drawn first, it saves the browser pixels.
    """
    look = mesh.materials[material]
    textured = mesh.uvs is not None and look.texture is not None
    # Photographs hold their own light.
    layout = _Layout(textured, mesh.colours is not None, not look.unlit)
    used, corners = _renumbered(mesh.triangles[rows], len(mesh.vertices_m))
    vertices_m = mesh.vertices_m[used]
    corners_m = vertices_m[corners]
    values = layout.values(mesh, rows, corners_m)
    below = corners_m[:, :, 1] <= height_m
    whole = below[:, 0] & below[:, 1] & below[:, 2]
    crossing = (below[:, 0] | below[:, 1] | below[:, 2]) & ~whole
    agreed, shared = _agreed(corners, values, layout.tolerances, len(used))
    shared &= whole
    single = whole & ~shared
    soup = cut_below(corners_m[crossing], values[crossing], height_m)
    used, triangles = _renumbered(corners[shared], len(used))
    heap_m = np.concatenate([corners_m[single], soup.corners_m])
    heap_values = np.concatenate([values[single], soup.extra])
    positions_m = np.concatenate([vertices_m[used], heap_m.reshape(-1, 3)])
    if not len(positions_m):
        return None
    heap = np.arange(len(used), len(positions_m)).reshape(-1, 3)
    triangles = np.concatenate([triangles, heap])
    heights_m = positions_m[:, 1][triangles]
    top_m = np.maximum(np.maximum(heights_m[:, 0], heights_m[:, 1]), heights_m[:, 2])
    topmost_first = np.argsort(-top_m, kind="stable")
    heap_values = heap_values.reshape(3 * len(heap_m), layout.width)
    return layout.surface(
        positions_m.astype(np.float32),
        triangles[topmost_first],
        np.concatenate([agreed[used], heap_values]).astype(np.float32),
        look,
    )


def _agreed(
    corners: Int64[np.ndarray, "n 3"],
    values: Float32[np.ndarray, "n 3 values"],
    tolerances: Float32[np.ndarray, " values"],
    count: int,
) -> tuple[Float32[np.ndarray, "count values"], Bool[np.ndarray, " n"]]:
    """Mean over the corners that share each vertex; which triangles agree with all of theirs."""
    flat = corners.reshape(-1)
    sharing = np.bincount(flat, minlength=count)
    agreed = np.empty((count, values.shape[2]), np.float32)
    agrees = np.ones(len(corners), np.bool_)
    # Value by value: a scan has millions of corners, and numpy is slow along short axes.
    for number, tolerance in enumerate(tolerances):
        column = values[:, :, number]
        mean = np.bincount(flat, weights=column.reshape(-1), minlength=count) / sharing
        agreed[:, number] = mean
        near = np.abs(column - agreed[:, number][corners]) <= tolerance
        agrees &= near[:, 0] & near[:, 1] & near[:, 2]
    return agreed, agrees


def _renumbered(
    vertices: Int[np.ndarray, "n 3"], count: int
) -> tuple[Int64[np.ndarray, " used"], Int64[np.ndarray, "n 3"]]:
    """The vertices that occur, and the triangles in terms of these."""
    occurs: Bool[np.ndarray, " count"] = np.zeros(count, np.bool_)
    occurs[vertices] = True
    return np.flatnonzero(occurs), (np.cumsum(occurs) - 1)[vertices]
