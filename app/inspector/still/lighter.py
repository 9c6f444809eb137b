"""A scene light enough to travel inside a page, and still like itself.

Surfaces of large triangles (the floors and walls of a model) keep their pictures, made small;
surfaces of small triangles (scans, detailed furniture) take their pictures' colours into the
vertices, because an atlas made small would smear one patch into the next.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import UInt8

from c2nav_engine.world.lighten import lightened, means
from c2nav_engine.world.scene import Material, Part, Piece, Scene, scene_of


@dataclass(frozen=True, slots=True)
class Lightness:
    """How light a scene is made [C]: about two megabytes in a page.

    Attributes:
        triangles: How many it may have.
        texture_px: Longest side of a picture that is kept.
        large_m: Surfaces whose triangles are larger keep their picture.
    """

    triangles: int = 45_000
    texture_px: int = 192
    large_m: float = 0.3


def lighter(scene: Scene, *, below_m: float, lightness: Lightness | None = None) -> Scene:
    """What of a scene begins below a height, within the budget.

    Args:
        scene: Any scene.
        below_m: Triangles that lie wholly above are dropped: the ceiling goes anyway.
        lightness: The budget.
    """
    lightness = lightness or Lightness()
    pieces = [piece for part in scene.parts for piece in _below(scene, part, below_m)]
    looks = _Looks(pieces, lightness)
    plain = scene_of(scene.name, [looks.of(piece) for piece in pieces], licence=scene.licence)
    return lightened(plain, triangles=lightness.triangles)


def _below(scene: Scene, part: Part, below_m: float) -> Iterator[Piece]:
    """A part on its own, without what lies above."""
    rows = np.arange(part.first, part.stop)
    low_m = scene.vertices_m[scene.triangles[rows]][:, :, 1].min(axis=1)
    rows = rows[low_m < below_m]
    if not len(rows):
        return
    used, inverse = np.unique(scene.triangles[rows].reshape(-1), return_inverse=True)
    yield Piece(
        part.name,
        scene.materials[part.material],
        scene.vertices_m[used],
        inverse.reshape(-1, 3).astype(np.int32),
        None if scene.uvs is None else scene.uvs[rows],
        None if scene.colours is None else scene.colours[used],
    )


class _Looks:
    """Gives pieces their light looks; materials that were shared stay shared."""

    def __init__(self, pieces: list[Piece], lightness: Lightness) -> None:
        self._lightness = lightness
        self._load: Counter[int] = Counter()
        for piece in pieces:
            self._load[id(piece.material)] += len(piece.triangles)
        self._small: dict[int, Material] = {}
        self._plain: dict[int, Material] = {}
        self._grains: dict[int, np.ndarray] = {}

    def of(self, piece: Piece) -> Piece:
        """A piece with a small picture or painted vertices; without a picture as it is."""
        material, texture = piece.material, piece.material.texture
        if texture is None or piece.uvs is None:
            return piece
        key = id(material)
        if triangle_size_m(piece) > self._lightness.large_m:
            if key not in self._small:
                small = shrunk(texture, self._lightness.texture_px)
                self._small[key] = replace(material, texture=small)
            return replace(piece, material=self._small[key])
        if key not in self._plain:
            # About as many texels as corners: finer grain would only be noise at the vertices.
            self._grains[key] = shrunk(texture, 2 * math.isqrt(self._load[key]) + 8)
            self._plain[key] = replace(material, texture=None, cutout_alpha=0.0)
        return _painted(piece, self._grains[key], self._plain[key])


def triangle_size_m(piece: Piece) -> float:
    """Side of a square of twice the mean triangle."""
    corners = piece.vertices_m[piece.triangles].astype(np.float64)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return float(np.sqrt(np.linalg.norm(normals, axis=1).mean()))


def shrunk(
    texture: UInt8[np.ndarray, "rows columns 4"], most_px: int
) -> UInt8[np.ndarray, "less fewer 4"]:
    """A picture no larger than that."""
    rows, columns = texture.shape[:2]
    scale = most_px / max(rows, columns)
    if scale >= 1.0:
        return texture
    size = (max(1, round(columns * scale)), max(1, round(rows * scale)))
    return np.asarray(cv2.resize(texture, size, interpolation=cv2.INTER_AREA), np.uint8)


def _painted(piece: Piece, grain: UInt8[np.ndarray, "rows columns 4"], plain: Material) -> Piece:
    """The picture's colours at the vertices; what was cut out of the picture goes."""
    if piece.uvs is None:
        return piece
    rows, columns = grain.shape[:2]
    # A corner on the picture's edge would read its other side: look a little inside.
    uvs = 0.9 * piece.uvs + 0.1 * piece.uvs.mean(axis=1, keepdims=True)
    u, v = uvs[:, :, 0] % 1.0, (1.0 - uvs[:, :, 1]) % 1.0
    column = np.floor(u * columns).astype(int).clip(0, columns - 1)
    row = np.floor(v * rows).astype(int).clip(0, rows - 1)
    corners = grain[row, column].astype(np.float64)
    kept = corners[:, :, 3].mean(axis=1) >= 255.0 * piece.material.cutout_alpha
    corners, triangles = corners[kept], piece.triangles[kept]
    colours = means(corners.reshape(-1, 4), triangles.reshape(-1), len(piece.vertices_m))
    colours[:, 3] = 255.0
    if piece.colours is not None:
        colours = colours * piece.colours / 255.0
    painted = colours.round().clip(0, 255).astype(np.uint8)
    return Piece(piece.name, plain, piece.vertices_m, triangles, None, painted)
