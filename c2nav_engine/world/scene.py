"""A scene: one triangle mesh in the world frame, cut into named parts with materials."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import InitVar, dataclass, field

import numpy as np
from jaxtyping import Float32, Int32, UInt8

from c2nav_engine.errors import SceneError


@dataclass(frozen=True, slots=True, eq=False)
class Material:
    """How a surface looks; compared by identity.

    Attributes:
        name: As in the file, possibly "".
        colour: Linear red, green, blue and alpha factors in [0, 1], multiplied with the texture.
        texture: sRGB colour with alpha; row 0 is the top of the picture, which repeats in both
            directions. None means plain colour.
        cutout_alpha: Where alpha falls below this, the surface is not there (leaves, panes);
            0 for an opaque surface.
        unlit: The colour holds its own light (photographed scenes): no shading.
    """

    name: str
    colour: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    texture: UInt8[np.ndarray, "rows columns 4"] | None = None
    cutout_alpha: float = 0.0
    unlit: bool = False


@dataclass(frozen=True, slots=True)
class Part:
    """A named run of triangles with one material.

    Attributes:
        name: Object or node name of the file: for people and tests, never for a ranker.
        material: Index into the scene's materials.
        first: Index of its first triangle.
        stop: Index after its last triangle.
    """

    name: str
    material: int
    first: int
    stop: int


@dataclass(frozen=True, slots=True)
class Scene:
    """Everything a renderer and a surface builder need, in the world frame (Y up, metres).

    Attributes:
        name: What records call it.
        vertices_m: Vertex positions.
        triangles: Vertex indices; either winding, every triangle is seen from both sides.
        parts: Named runs that cover all triangles in order.
        materials: What the parts refer to.
        uvs: Texture coordinates per triangle corner, origin at the bottom left of the picture;
            None where no part has a texture.
        colours: sRGB colour with alpha per vertex, multiplied with the material; None for white.
        licence: Licence of the pictures, "" when unknown.
        sha256: Hex digest of the content, for caches; the name does not count.
        known_sha256: That digest, where a store kept it; the content is then taken as checked.
    """

    name: str
    vertices_m: Float32[np.ndarray, "vertices 3"]
    triangles: Int32[np.ndarray, "triangles 3"]
    parts: tuple[Part, ...]
    materials: tuple[Material, ...]
    uvs: Float32[np.ndarray, "triangles 3 2"] | None = None
    colours: UInt8[np.ndarray, "vertices 4"] | None = None
    licence: str = ""
    sha256: str = field(init=False, compare=False)
    known_sha256: InitVar[str] = ""

    def __post_init__(self, known_sha256: str) -> None:
        """Check what every reader relies on and fix the content key; raises `SceneError`."""
        if not known_sha256:
            _check(self)
        object.__setattr__(self, "sha256", known_sha256 or _digest(self))

    @property
    def part_of_triangle(self) -> Int32[np.ndarray, " triangles"]:
        """Index of the part that each triangle belongs to."""
        sizes = [part.stop - part.first for part in self.parts]
        return np.repeat(np.arange(len(sizes), dtype=np.int32), sizes)

    @property
    def bounds_m(self) -> Float32[np.ndarray, "2 3"]:
        """Lowest and highest corner of the box around all used vertices."""
        used = self.vertices_m[self.triangles.reshape(-1)]
        return np.stack([used.min(axis=0), used.max(axis=0)])


@dataclass(frozen=True, slots=True)
class Piece:
    """A mesh on its own, before it becomes a part of a scene.

    Attributes:
        name: Becomes the part's name.
        material: Pieces that share the object share it in the scene.
        vertices_m: Positions in the world frame.
        triangles: Indices into its own vertices.
        uvs: As in `Scene`; None for plain colour.
        colours: As in `Scene`; None for white.
    """

    name: str
    material: Material
    vertices_m: Float32[np.ndarray, "vertices 3"]
    triangles: Int32[np.ndarray, "triangles 3"]
    uvs: Float32[np.ndarray, "triangles 3 2"] | None = None
    colours: UInt8[np.ndarray, "vertices 4"] | None = None


def scene_of(name: str, pieces: Sequence[Piece], *, licence: str = "") -> Scene:
    """Join pieces, in order, to one scene; raises `SceneError` when they hold no triangle."""
    pieces = [piece for piece in pieces if len(piece.triangles)]
    if not pieces:
        message = f"scene {name!r}: expected at least one triangle, came none"
        raise SceneError(message)
    materials = list({id(piece.material): piece.material for piece in pieces}.values())
    index_of = {id(material): index for index, material in enumerate(materials)}
    stops = np.cumsum([len(piece.triangles) for piece in pieces]).tolist()
    parts = tuple(
        Part(piece.name, index_of[id(piece.material)], stop - len(piece.triangles), stop)
        for piece, stop in zip(pieces, stops, strict=True)
    )
    starts = np.cumsum([0, *(len(piece.vertices_m) for piece in pieces[:-1])]).tolist()
    return Scene(
        name=name,
        vertices_m=_joined([piece.vertices_m for piece in pieces]),
        triangles=_joined(
            [piece.triangles + np.int32(start) for piece, start in zip(pieces, starts, strict=True)]
        ),
        parts=parts,
        materials=tuple(materials),
        uvs=_joined_uvs(pieces),
        colours=_joined_colours(pieces),
        licence=licence,
    )


def _joined(arrays: list[np.ndarray]) -> np.ndarray:
    return arrays[0] if len(arrays) == 1 else np.concatenate(arrays)


def _joined_uvs(pieces: Sequence[Piece]) -> np.ndarray | None:
    if all(piece.uvs is None for piece in pieces):
        return None
    return _joined(
        [
            np.zeros((len(piece.triangles), 3, 2), np.float32) if piece.uvs is None else piece.uvs
            for piece in pieces
        ]
    )


def _joined_colours(pieces: Sequence[Piece]) -> np.ndarray | None:
    if all(piece.colours is None for piece in pieces):
        return None
    return _joined(
        [
            np.full((len(piece.vertices_m), 4), 255, np.uint8)
            if piece.colours is None
            else piece.colours
            for piece in pieces
        ]
    )


def _check(scene: Scene) -> None:
    problem = _problem(scene)
    if problem:
        message = f"scene {scene.name!r}: {problem}"
        raise SceneError(message)


def _problem(scene: Scene) -> str:
    vertices, triangles = len(scene.vertices_m), len(scene.triangles)
    if not triangles:
        return "expected at least one triangle, came none"
    lowest, highest = int(scene.triangles.min()), int(scene.triangles.max())
    if lowest < 0 or highest >= vertices:
        return f"expected indices of {vertices} vertices, came {lowest} to {highest}"
    if not np.isfinite(scene.vertices_m).all():
        return "expected finite vertices, came nan or inf; export the mesh again"
    if scene.uvs is not None and not np.isfinite(scene.uvs).all():
        return "expected finite texture coordinates, came nan or inf; export the mesh again"
    edges = [0, *(part.stop for part in scene.parts)]
    starts = [*(part.first for part in scene.parts), triangles]
    if edges != starts:
        return f"expected parts that cover {triangles} triangles in order, came {scene.parts[:3]}…"
    if any(not 0 <= part.material < len(scene.materials) for part in scene.parts):
        return f"expected parts with one of {len(scene.materials)} materials"
    return ""


def _digest(scene: Scene) -> str:
    digest = hashlib.sha256(repr(scene.parts).encode())
    arrays = [scene.vertices_m, scene.triangles, scene.uvs, scene.colours]
    for material in scene.materials:
        look = (material.colour, material.cutout_alpha, material.unlit)
        digest.update(repr(look).encode())
        arrays.append(material.texture)
    for array in arrays:
        # A shape before each array keeps two scenes apart whose bytes merely run together alike.
        digest.update(repr(None if array is None else array.shape).encode())
        if array is not None:
            digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()
