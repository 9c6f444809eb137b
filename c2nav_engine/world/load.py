"""Scene files to scenes: glTF, PLY and OBJ, turned into the world frame."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
from jaxtyping import Float32, Int32

from c2nav_engine.errors import SceneError
from c2nav_engine.world.load_file import FORMATS, read_pieces
from c2nav_engine.world.load_paths import scene_path
from c2nav_engine.world.scene import Piece, Scene, scene_of

__all__ = ["Up", "load_scene", "scene_path"]

Up = Literal["auto", "y", "z"]
"""Which axis of the file points up; `auto` takes the one with more floor and ceiling across it."""

CLEARLY_MORE = 1.25
"""How much clearer z must be than y before a file is called Z up: glTF prescribes Y."""

SAMPLED_TRIANGLES = 500_000
"""Enough to tell floors from walls in a mesh of any size."""


def load_scene(path: Path, *, up: Up = "auto") -> Scene:
    """Read a scene file into the world frame (Y up, metres).

    Node transforms are applied, object names become part names, textures, material colours and
    vertex colours are kept. Points, lines and cameras in the file are left out.

    Args:
        path: A `.glb`, `.gltf`, `.ply` or `.obj` file.
        up: The file's up axis; habitat's Matterport3D files have Z up against glTF's rule,
            so the default looks at the mesh. Z up is turned as habitat does: (x, y, z) becomes
            (x, z, −y).

    Raises:
        SceneError: The file is missing, empty, cut short or holds no triangle.
    """
    _check_file(path)
    contents = read_pieces(path)
    if not contents.pieces:
        message = f"scene {path}: expected triangles, came none; export it again as a mesh"
        raise SceneError(message)
    axis = up if up != "auto" else up_axis(contents.pieces)
    pieces = [_turned(piece) for piece in contents.pieces] if axis == "z" else contents.pieces
    return scene_of(path.stem, pieces, licence=contents.licence)


def up_axis(pieces: list[Piece]) -> Literal["y", "z"]:
    """The axis, y or z, that is up: much surface lies square to it, and little length along it.

    Floors and ceilings outweigh the walls that face any one way, and buildings are flat.
    """
    across_m2, low_m, high_m = np.zeros(3), np.full(3, np.inf), np.full(3, -np.inf)
    for piece in pieces:
        across_m2 += _area_across_m2(piece.vertices_m, piece.triangles)
        low_m = np.minimum(low_m, piece.vertices_m.min(axis=0))
        high_m = np.maximum(high_m, piece.vertices_m.max(axis=0))
    _, y_score, z_score = across_m2 / np.maximum(high_m - low_m, 1e-6)
    return "z" if z_score > CLEARLY_MORE * y_score else "y"


def _area_across_m2(
    vertices_m: Float32[np.ndarray, "vertices 3"], triangles: Int32[np.ndarray, "triangles 3"]
) -> np.ndarray:
    """Area of the triangles whose normal lies along each axis."""
    stride = max(1, len(triangles) // SAMPLED_TRIANGLES)
    corners = vertices_m[triangles[::stride]].astype(np.float64)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled_m2 = np.linalg.norm(normals, axis=1, keepdims=True)
    along = np.abs(normals) > 0.95 * doubled_m2
    return (along * doubled_m2).sum(axis=0) * (0.5 * stride)


def _turned(piece: Piece) -> Piece:
    x, y, z = piece.vertices_m.T
    vertices_m = np.stack([x, z, -y], axis=1)
    return Piece(piece.name, piece.material, vertices_m, piece.triangles, piece.uvs, piece.colours)


def _check_file(path: Path) -> None:
    if not path.is_file():
        message = f"scene {path}: expected a file, found none; check the scenes folder (--scenes)"
        raise SceneError(message)
    if path.suffix.lower() not in FORMATS:
        message = (
            f"scene {path}: expected one of {', '.join(FORMATS)}, came {path.suffix!r}; "
            "convert it to .glb"
        )
        raise SceneError(message)
    if path.stat().st_size == 0:
        message = f"scene {path}: expected a mesh, came an empty file; fetch it again"
        raise SceneError(message)
