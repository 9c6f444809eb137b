"""A scene's looks packed into flat arrays, so that one kernel can shade any pixel."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Int32, Int64, UInt8, UInt32

from c2nav_engine.sensing.mipmap import LEVELS, fill_densities, mipmaps
from c2nav_engine.world.scene import Scene


class Atlas(NamedTuple):
    """Textures end to end, with tables by material and by triangle.

    A named tuple, because compiled kernels take it as it is. Texels and vertex colours are
    packed into one integer each, red in the lowest byte, alpha in the highest.

    Attributes:
        texels: All textures with their smaller copies, each row by row from its top.
        offsets: First texel of each level of each material's texture.
        sizes_px: (rows, columns) of each level; zeros where a material has no texture.
        colours: Linear colour factor of each material, with alpha.
        unlit: 1 where a material is not shaded.
        cutout_alphas: Alpha below which a material's surface is not there.
        surfaces: One row a triangle, so that a hit reads one place in memory: its material,
            its texels a square metre, and u, v of its corners; the material alone where the
            scene has no textures.
        triangles: Vertex indices; needed for vertex colours only.
        vertex_colours: Packed; empty where the scene has none.
    """

    texels: UInt32[np.ndarray, " texels"]
    offsets: Int64[np.ndarray, "materials levels"]
    sizes_px: Int32[np.ndarray, "materials levels 2"]
    colours: Float32[np.ndarray, "materials 4"]
    unlit: UInt8[np.ndarray, " materials"]
    cutout_alphas: Float32[np.ndarray, " materials"]
    surfaces: Float32[np.ndarray, "triangles columns"]
    triangles: Int32[np.ndarray, "triangles 3"]
    vertex_colours: UInt32[np.ndarray, " coloured"]


def atlas_of(scene: Scene) -> Atlas:
    """Pack a scene; textures that materials share are stored once."""
    # Without texture coordinates, a texture cannot be placed: plain colours remain.
    textures = [m.texture if scene.uvs is not None else None for m in scene.materials]
    texels, offsets, sizes_px = _packed(textures)
    return Atlas(
        texels=texels,
        offsets=offsets,
        sizes_px=sizes_px,
        colours=np.asarray([m.colour for m in scene.materials], np.float32),
        unlit=np.asarray([m.unlit for m in scene.materials], np.uint8),
        cutout_alphas=np.asarray([m.cutout_alpha for m in scene.materials], np.float32),
        surfaces=_surfaces(scene, sizes_px),
        triangles=scene.triangles,
        vertex_colours=np.zeros(0, np.uint32) if scene.colours is None else packed(scene.colours),
    )


def _surfaces(
    scene: Scene, sizes_px: Int32[np.ndarray, "materials levels 2"]
) -> Float32[np.ndarray, "triangles columns"]:
    surfaces = np.zeros((len(scene.triangles), 1 if scene.uvs is None else 8), np.float32)
    for part in scene.parts:
        surfaces[part.first : part.stop, 0] = part.material
    if scene.uvs is not None:
        surfaces[:, 2:] = scene.uvs.reshape(-1, 6)
        fill_densities(surfaces, scene.vertices_m, scene.triangles, sizes_px[:, 0])
    return surfaces


def packed(rgba: UInt8[np.ndarray, "*shape 4"]) -> UInt32[np.ndarray, "*shape"]:
    """Four bytes as one integer, red lowest."""
    return np.ascontiguousarray(rgba).view("<u4").astype(np.uint32, copy=False)[..., 0]


def _packed(
    textures: list[UInt8[np.ndarray, "_ _ 4"] | None],
) -> tuple[
    UInt32[np.ndarray, " texels"],
    Int64[np.ndarray, "materials levels"],
    Int32[np.ndarray, "materials levels 2"],
]:
    chunks: list[UInt32[np.ndarray, " texels"]] = []
    row_of: dict[int, int] = {}
    offsets = np.zeros((len(textures), LEVELS), np.int64)
    sizes_px = np.zeros((len(textures), LEVELS, 2), np.int32)
    start = 0
    for index, texture in enumerate(textures):
        if texture is None:
            continue
        known = row_of.setdefault(id(texture), index)
        if known != index:
            offsets[index], sizes_px[index] = offsets[known], sizes_px[known]
            continue
        for level, picture in enumerate(mipmaps(packed(texture))):
            offsets[index, level], sizes_px[index, level] = start, picture.shape
            chunks.append(picture.reshape(-1))
            start += picture.size
    return np.concatenate(chunks) if chunks else np.zeros(1, np.uint32), offsets, sizes_px
