"""Smaller copies of textures, and how finely each triangle is textured.

Without them, a texture seen from afar is sampled at every n-th texel and shimmers into noise:
a model would be asked about a pattern that is not there.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float32, Int32, UInt32

from c2nav_engine.sensing.colour import alpha_of, decode_channel, encode_level
from c2nav_engine.world.compiled import compiled

LEVELS = 12
"""Full size and eleven halvings at most."""


def mipmaps(
    texture: UInt32[np.ndarray, "rows columns"],
) -> list[UInt32[np.ndarray, "small_rows small_columns"]]:
    """The packed texture and its halvings, down to one texel; the last one stays for the rest."""
    pictures = [texture]
    while len(pictures) < LEVELS:
        rows, columns = pictures[-1].shape
        if rows == columns == 1:
            pictures.append(pictures[-1])
            continue
        half = np.empty((max(1, rows // 2), max(1, columns // 2)), np.uint32)
        halve(pictures[-1], half)
        pictures.append(half)
    return pictures


@compiled
def halve(
    texture: UInt32[np.ndarray, "rows columns"],
    half: UInt32[np.ndarray, "small_rows small_columns"],
) -> None:
    """Mean of 2 × 2 texels in linear light, weighted by alpha so that no fringe appears."""
    rows, columns = texture.shape
    for row in range(half.shape[0]):
        for column in range(half.shape[1]):
            red = green = blue = alpha = weight = 0.0
            for k in range(4):
                texel = texture[
                    min(2 * row + k // 2, rows - 1), min(2 * column + k % 2, columns - 1)
                ]
                share = alpha_of(texel) + 1e-3
                red += share * decode_channel(texel, 0)
                green += share * decode_channel(texel, 8)
                blue += share * decode_channel(texel, 16)
                alpha += 0.25 * alpha_of(texel)
                weight += share
            half[row, column] = (
                np.uint32(encode_level(red / weight))
                | (np.uint32(encode_level(green / weight)) << np.uint32(8))
                | (np.uint32(encode_level(blue / weight)) << np.uint32(16))
                | (np.uint32(alpha * 255.0 + 0.5) << np.uint32(24))
            )


@compiled
def fill_densities(
    surfaces: Float32[np.ndarray, "triangles 8"],
    vertices_m: Float32[np.ndarray, "vertices 3"],
    triangles: Int32[np.ndarray, "triangles 3"],
    sizes_px: Int32[np.ndarray, "materials 2"],
) -> None:
    """Write each triangle's texels a square metre into column 1 (see `sensing.atlas`)."""
    for i in range(len(triangles)):
        a, b, c = triangles[i, 0], triangles[i, 1], triangles[i, 2]
        ux, uy = surfaces[i, 4] - surfaces[i, 2], surfaces[i, 5] - surfaces[i, 3]
        vx, vy = surfaces[i, 6] - surfaces[i, 2], surfaces[i, 7] - surfaces[i, 3]
        px = vertices_m[b, 0] - vertices_m[a, 0]
        py = vertices_m[b, 1] - vertices_m[a, 1]
        pz = vertices_m[b, 2] - vertices_m[a, 2]
        qx = vertices_m[c, 0] - vertices_m[a, 0]
        qy = vertices_m[c, 1] - vertices_m[a, 1]
        qz = vertices_m[c, 2] - vertices_m[a, 2]
        nx, ny, nz = py * qz - pz * qy, pz * qx - px * qz, px * qy - py * qx
        area = np.sqrt(nx * nx + ny * ny + nz * nz)
        if area > 0.0:
            material = int(surfaces[i, 0])
            texels = abs(ux * vy - uy * vx) * sizes_px[material, 0] * sizes_px[material, 1]
            surfaces[i, 1] = texels / area
