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

SAMPLED_TRIANGLES = 500_000
"""Enough to tell floors from walls in a mesh of any size."""


def load_scene(path: Path, *, up: Up = "y") -> Scene:
    """Read a scene file into the world frame (Y up, metres).

    Node transforms are applied, object names become part names, textures, material colours and
    vertex colours are kept. Points, lines and cameras in the file are left out.

    Args:
        path: A `.glb`, `.gltf`, `.ply` or `.obj` file.
        up: The file's up axis. Z up is turned as habitat does: (x, y, z) becomes (x, z, −y).

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
    """The axis, y or z, that more surface lies square to: floors and ceilings outweigh walls."""
    across_m2 = np.zeros(3)
    for piece in pieces:
        across_m2 += _area_across_m2(piece.vertices_m, piece.triangles)
    return "z" if across_m2[2] > across_m2[1] else "y"


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
