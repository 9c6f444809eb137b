"""Compiled kernels: camera rays out, colours of hits in, one pass each.

Importing this module imports numba; the renderer does so only when it is built. Kernels index
single elements throughout: a view of a row would count references across threads.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float32, UInt8

from c2nav_engine.sensing.atlas import Atlas
from c2nav_engine.sensing.caster import Hits
from c2nav_engine.sensing.colour import alpha_of, decode_channel, encode_level
from c2nav_engine.sensing.mipmap import LEVELS
from c2nav_engine.world.compiled import compiled

LEAST_FACING = 0.05
"""Grazing surfaces are filtered as if seen at this cosine, so that they do not blur away."""


class Lighting(NamedTuple):
    """Light as kernels take it: shares of ambient light, headlight and sky; the background."""

    ambient: float
    headlight: float
    sky: float
    red: int
    green: int
    blue: int


@compiled
def fill_rays(
    rays: Float32[np.ndarray, "rays 6"],
    directions: Float32[np.ndarray, "rays 3"],
    world_from_camera: Float32[np.ndarray, "4 4"],
) -> None:
    """Write the origin and the turned directions of one camera's rays."""
    m = world_from_camera
    for i in range(len(directions)):
        x, y, z = directions[i, 0], directions[i, 1], directions[i, 2]
        for k in range(3):
            rays[i, k] = m[k, 3]
            rays[i, 3 + k] = m[k, 0] * x + m[k, 1] * y + m[k, 2] * z


@compiled
def facing(hits: Hits, i: int) -> tuple[float, float, float]:
    """Of hit i: cosine to the viewer, upward part of the seen side's normal, length of the ray."""
    dx, dy, dz = hits.rays[i, 3], hits.rays[i, 4], hits.rays[i, 5]
    nx, ny, nz = hits.normals[i, 0], hits.normals[i, 1], hits.normals[i, 2]
    length = math.sqrt(dx * dx + dy * dy + dz * dz)
    scale = math.sqrt(nx * nx + ny * ny + nz * nz)
    if length * scale <= 0.0:
        return 0.0, 0.0, length
    cosine = -(dx * nx + dy * ny + dz * nz) / (length * scale)
    up = ny / scale
    return (cosine, up, length) if cosine >= 0.0 else (-cosine, -up, length)


@compiled
def mip_level(texels: float) -> int:
    """The level with one to four texels under a pixel that covers so many of the full texture.

    Rather too sharp than too soft: words and small things are what a model is asked about.
    """
    return min(max((math.frexp(texels)[1] - 1) >> 1, 0), LEVELS - 1)


@compiled
def texel_span(position: float, size: int) -> tuple[int, int, float]:
    """The two texels around a position in texels, wrapped, and the weight of the second."""
    base = math.floor(position)
    first = int(base) % size
    second = first + 1 if first + 1 < size else 0
    return first, second, position - base


@compiled
def mixed(texels: tuple[int, int, int, int], wx: float, wy: float, shift: int) -> float:
    """One linear colour channel between four texels."""
    a, b, c, d = texels
    upper = decode_channel(a, shift) * (1.0 - wx) + decode_channel(b, shift) * wx
    lower = decode_channel(c, shift) * (1.0 - wx) + decode_channel(d, shift) * wx
    return upper * (1.0 - wy) + lower * wy


@compiled
def corners_around(
    atlas: Atlas, hits: Hits, i: int, level: int
) -> tuple[tuple[int, int, int, int], float, float]:
    """The four texels around hit i at a level of its texture, with the weights between them."""
    triangle = int(hits.triangles[i])
    material = atlas.material_of_triangle[triangle]
    b1, b2 = hits.barycentrics[i, 0], hits.barycentrics[i, 1]
    b0 = 1.0 - b1 - b2
    uvs = atlas.uvs
    u = b0 * uvs[triangle, 0, 0] + b1 * uvs[triangle, 1, 0] + b2 * uvs[triangle, 2, 0]
    v = b0 * uvs[triangle, 0, 1] + b1 * uvs[triangle, 1, 1] + b2 * uvs[triangle, 2, 1]
    rows, columns = atlas.sizes_px[material, level, 0], atlas.sizes_px[material, level, 1]
    left, right, wx = texel_span(u * columns - 0.5, columns)
    # Row 0 is the top of the picture while v grows upwards.
    top, bottom, wy = texel_span((1.0 - v) * rows - 0.5, rows)
    upper = atlas.offsets[material, level] + top * columns
    lower = atlas.offsets[material, level] + bottom * columns
    texels = atlas.texels
    four = (
        int(texels[upper + left]),
        int(texels[upper + right]),
        int(texels[lower + left]),
        int(texels[lower + right]),
    )
    return four, wx, wy


@compiled
def vertex_channel(atlas: Atlas, hits: Hits, i: int, shift: int) -> float:
    """One linear channel of the vertex colours at hit i."""
    triangle = int(hits.triangles[i])
    b1, b2 = hits.barycentrics[i, 0], hits.barycentrics[i, 1]
    colours, corners = atlas.vertex_colours, atlas.triangles
    first = decode_channel(int(colours[corners[triangle, 0]]), shift)
    second = decode_channel(int(colours[corners[triangle, 1]]), shift)
    third = decode_channel(int(colours[corners[triangle, 2]]), shift)
    return (1.0 - b1 - b2) * first + b1 * second + b2 * third


@compiled
def shade(
    rgb: UInt8[np.ndarray, "rays 3"], hits: Hits, atlas: Atlas, look: tuple[Lighting, float]
) -> None:
    """Colour of each ray's first hit, or the background.

    `look` holds the light and the squared width of a pixel at one metre.
    """
    light, pixel_m2 = look
    for i in range(len(rgb)):
        triangle = int(hits.triangles[i])
        if triangle >= len(atlas.material_of_triangle):
            rgb[i, 0], rgb[i, 1], rgb[i, 2] = light.red, light.green, light.blue
            continue
        material = atlas.material_of_triangle[triangle]
        cosine, up, length = facing(hits, i)
        red, green, blue = (
            atlas.colours[material, 0],
            atlas.colours[material, 1],
            atlas.colours[material, 2],
        )
        if not atlas.unlit[material]:
            lit = light.ambient + light.headlight * cosine + light.sky * (0.5 + 0.5 * up)
            red, green, blue = red * lit, green * lit, blue * lit
        if atlas.sizes_px[material, 0, 0] > 0:
            area_m2 = pixel_m2 * hits.t_hit[i] * hits.t_hit[i]
            seen = max(cosine, LEAST_FACING) * length
            level = mip_level(atlas.texel_density[triangle] * area_m2 / seen)
            four, wx, wy = corners_around(atlas, hits, i, level)
            red *= mixed(four, wx, wy, 0)
            green *= mixed(four, wx, wy, 8)
            blue *= mixed(four, wx, wy, 16)
        if len(atlas.vertex_colours) > 0:
            red *= vertex_channel(atlas, hits, i, 0)
            green *= vertex_channel(atlas, hits, i, 8)
            blue *= vertex_channel(atlas, hits, i, 16)
        rgb[i, 0] = encode_level(red)
        rgb[i, 1] = encode_level(green)
        rgb[i, 2] = encode_level(blue)


@compiled
def find_cutouts(through: Bool[np.ndarray, " rays"], hits: Hits, atlas: Atlas) -> int:
    """Mark hits on surfaces that are not there by alpha; returns how many."""
    count = 0
    for i in range(len(through)):
        through[i] = False
        triangle = int(hits.triangles[i])
        if triangle >= len(atlas.material_of_triangle):
            continue
        material = atlas.material_of_triangle[triangle]
        if atlas.cutout_alphas[material] <= 0.0:
            continue
        alpha = atlas.colours[material, 3]
        if atlas.sizes_px[material, 0, 0] > 0:
            (a, b, c, d), wx, wy = corners_around(atlas, hits, i, 0)
            upper = alpha_of(a) * (1.0 - wx) + alpha_of(b) * wx
            lower = alpha_of(c) * (1.0 - wx) + alpha_of(d) * wx
            alpha *= upper * (1.0 - wy) + lower * wy
        if alpha < atlas.cutout_alphas[material]:
            through[i] = True
            count += 1
    return count
