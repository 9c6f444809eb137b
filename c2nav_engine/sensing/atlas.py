"""A scene's looks packed into flat arrays, so that one kernel can shade any pixel."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, Int32, Int64, UInt8

from c2nav_engine.world.scene import Scene


class Atlas(NamedTuple):
    """Textures end to end, with tables by material and by triangle.

    A named tuple, because compiled kernels take it as it is.

    Attributes:
        texels: Colours in sRGB with alpha of all textures, each row by row from its top.
        offsets: First texel of each material's texture.
        sizes_px: (rows, columns) of each material's texture; zeros where it has none.
        colours: Linear colour factor of each material, with alpha.
        unlit: 1 where a material is not shaded.
        cutout_alphas: Alpha below which a material's surface is not there.
        material_of_triangle: Index into these tables.
        uvs: Texture coordinates of the corners; no rows where the scene has none.
        triangles: Vertex indices; needed for vertex colours only.
        vertex_colours: Colours in sRGB with alpha; no rows where the scene has none.
    """

    texels: UInt8[np.ndarray, "texels 4"]
    offsets: Int64[np.ndarray, " materials"]
    sizes_px: Int32[np.ndarray, "materials 2"]
    colours: Float32[np.ndarray, "materials 4"]
    unlit: UInt8[np.ndarray, " materials"]
    cutout_alphas: Float32[np.ndarray, " materials"]
    material_of_triangle: Int32[np.ndarray, " triangles"]
    uvs: Float32[np.ndarray, "cornered 3 2"]
    triangles: Int32[np.ndarray, "triangles 3"]
    vertex_colours: UInt8[np.ndarray, "coloured 4"]


def atlas_of(scene: Scene) -> Atlas:
    """Pack a scene; textures that materials share are stored once."""
    textures = {
        id(material.texture): material.texture
        for material in scene.materials
        if material.texture is not None
    }
    starts = np.cumsum([0, *(texture.size // 4 for texture in textures.values())])
    offset_of = dict(zip(textures, starts.tolist(), strict=False))
    flat = [texture.reshape(-1, 4) for texture in textures.values()]
    sizes = [part.stop - part.first for part in scene.parts]
    materials = np.asarray([part.material for part in scene.parts], np.int32)
    return Atlas(
        texels=np.concatenate(flat) if flat else np.zeros((1, 4), np.uint8),
        offsets=np.asarray([offset_of.get(id(m.texture), 0) for m in scene.materials], np.int64),
        sizes_px=np.asarray(
            [(0, 0) if m.texture is None else m.texture.shape[:2] for m in scene.materials],
            np.int32,
        ),
        colours=np.asarray([m.colour for m in scene.materials], np.float32),
        unlit=np.asarray([m.unlit for m in scene.materials], np.uint8),
        cutout_alphas=np.asarray([m.cutout_alpha for m in scene.materials], np.float32),
        material_of_triangle=np.repeat(materials, sizes),
        uvs=np.zeros((0, 3, 2), np.float32) if scene.uvs is None else scene.uvs,
        triangles=scene.triangles,
        vertex_colours=np.zeros((0, 4), np.uint8) if scene.colours is None else scene.colours,
    )
