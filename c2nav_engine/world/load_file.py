"""The one wrapper of trimesh: a scene file to pieces with materials."""

from __future__ import annotations

import importlib
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float32, UInt8

from c2nav_engine.errors import SceneError
from c2nav_engine.world.load_gltf import GltfFacts, gltf_facts
from c2nav_engine.world.load_material import Materials, srgb_from_linear
from c2nav_engine.world.scene import Piece

FORMATS = (".glb", ".gltf", ".ply", ".obj")

PHOTOGRAPHED = ("mp3d", "hm3d", "gibson", "replica")
"""Folders of scanned scenes: their textures are photographs that hold their own light."""


@dataclass(frozen=True, slots=True)
class Contents:
    """What a scene file holds.

    Attributes:
        pieces: Meshes with node transforms applied, in the file's own axes.
        licence: As the file says, "" when it says nothing.
    """

    pieces: list[Piece]
    licence: str


def read_pieces(path: Path) -> Contents:
    """All triangle meshes of a file; raises `SceneError` when it cannot be read."""
    facts = gltf_facts(path) if path.suffix.lower() in (".glb", ".gltf") else GltfFacts()
    materials = Materials(facts.unlit, all_unlit=is_photographed(path))
    try:
        scene = _parse(path)
        pieces = [
            _piece(name, *scene.graph[name], scene=scene, materials=materials, facts=facts)
            for name in _mesh_nodes(scene)
        ]
    except SceneError:
        raise
    except Exception as error:
        message = (
            f"scene {path}: expected a readable {path.suffix[1:]} mesh, came "
            f"{type(error).__name__}: {error}; fetch or export it again"
        )
        raise SceneError(message) from error
    return Contents(pieces, facts.licence)


def is_photographed(path: Path) -> bool:
    """Whether a file lies in a folder of scans, whose textures hold their own light."""
    return any(folder.lower() in PHOTOGRAPHED for folder in path.parts)


def _trimesh() -> Any:
    """The loader, imported when a file is read: it takes seconds."""
    return importlib.import_module("trimesh")


def _parse(path: Path) -> Any:
    options = {"split_objects": True} if path.suffix.lower() == ".obj" else {}
    with warnings.catch_warnings():
        # trimesh parses numbers with a deprecated numpy call; what it warns of is checked here.
        warnings.simplefilter("ignore")
        return _trimesh().load_scene(str(path), process=False, **options)


def _mesh_nodes(scene: Any) -> list[str]:
    """Nodes that carry triangles, in the file's order; points and lines are left out."""
    carriers = set(scene.graph.nodes_geometry)

    def has_triangles(name: str) -> bool:
        geometry = scene.geometry[scene.graph[name][1]]
        return isinstance(geometry, _trimesh().Trimesh) and len(geometry.faces) > 0

    return [name for name in scene.graph.nodes if name in carriers and has_triangles(name)]


def _piece(
    name: str, transform: Any, geometry: str, *, scene: Any, materials: Materials, facts: GltfFacts
) -> Piece:
    mesh = scene.geometry[geometry]
    vertices = np.asarray(mesh.vertices, np.float64) @ transform[:3, :3].T + transform[:3, 3]
    triangles = np.ascontiguousarray(mesh.faces, np.int32)
    _check_indices(name, triangles, len(vertices))
    material = materials.of(mesh.visual)
    colours = _vertex_colours(mesh, linear=facts.is_gltf)
    if mesh.visual.kind == "face":
        # One colour a triangle: every triangle gets vertices of its own.
        vertices = vertices[triangles.reshape(-1)]
        colours = np.repeat(np.asarray(mesh.visual.face_colors, np.uint8), 3, axis=0)
        triangles = np.arange(len(vertices), dtype=np.int32).reshape(-1, 3)
    return Piece(
        name=name,
        material=material,
        vertices_m=np.ascontiguousarray(vertices, np.float32),
        triangles=triangles,
        uvs=_corner_uvs(mesh) if material.texture is not None else None,
        colours=colours,
    )


def _check_indices(name: str, triangles: Any, vertices: int) -> None:
    if triangles.min() < 0 or triangles.max() >= vertices:
        message = (
            f"part {name!r} of the scene: expected indices of {vertices} vertices, came "
            f"{triangles.min()} to {triangles.max()}; the file is damaged, fetch it again"
        )
        raise SceneError(message)


def _corner_uvs(mesh: Any) -> Float32[np.ndarray, "triangles 3 2"]:
    return np.ascontiguousarray(np.nan_to_num(np.asarray(mesh.visual.uv, np.float32))[mesh.faces])


def _vertex_colours(mesh: Any, *, linear: bool) -> UInt8[np.ndarray, "vertices 4"] | None:
    """Vertex colours in sRGB, beside a texture or without one."""
    visual = mesh.visual
    if visual.kind == "vertex":
        colours = np.asarray(visual.vertex_colors)
    elif visual.kind == "texture" and "color" in visual.vertex_attributes:
        colours = _trimesh().visual.color.to_rgba(visual.vertex_attributes["color"])
    else:
        return None
    if len(colours) != len(mesh.vertices):
        return None
    colours = np.ascontiguousarray(colours, np.uint8)
    # glTF keeps vertex colours linear; everything else keeps them as seen.
    return srgb_from_linear(colours) if linear else colours
