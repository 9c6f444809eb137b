"""Compiled kernels: camera rays out, colours of hits in, one pass each.

Importing this module imports numba; the renderer does so only when it is built.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32, UInt8

from c2nav_engine.sensing.atlas import Atlas
from c2nav_engine.sensing.caster import Hits
from c2nav_engine.world.compiled import compiled

_LEVELS = np.arange(256) / 255.0
DECODED = np.where(_LEVELS <= 0.04045, _LEVELS / 12.92, ((_LEVELS + 0.055) / 1.055) ** 2.4).astype(
    np.float32
)
"""Linear value of each 8-bit sRGB level."""

_STEPS = np.arange(4097) / 4096.0
ENCODED = np.rint(
    255.0 * np.where(_STEPS <= 0.0031308, 12.92 * _STEPS, 1.055 * _STEPS ** (1.0 / 2.4) - 0.055)
).astype(np.uint8)
"""8-bit sRGB level of a linear value in steps of 1/4096, fine enough for the darkest levels."""


class Lighting(NamedTuple):
    """Light as kernels take it.

    Attributes:
        lights: Shares of ambient light, headlight and sky.
        background: Colour in sRGB where nothing is hit.
    """

    lights: Float32[np.ndarray, " 3"]
    background: UInt8[np.ndarray, " 3"]


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
        rays[i, 0] = m[0, 3]
        rays[i, 1] = m[1, 3]
        rays[i, 2] = m[2, 3]
        rays[i, 3] = m[0, 0] * x + m[0, 1] * y + m[0, 2] * z
        rays[i, 4] = m[1, 0] * x + m[1, 1] * y + m[1, 2] * z
        rays[i, 5] = m[2, 0] * x + m[2, 1] * y + m[2, 2] * z


@compiled
def encode_level(linear: float) -> int:
    """The 8-bit sRGB level of a linear value, clipped."""
    return ENCODED[int(min(max(linear, 0.0), 1.0) * 4096.0 + 0.5)]


@compiled
def brightness(
    direction: Float32[np.ndarray, " 3"],
    normal: Float32[np.ndarray, " 3"],
    lights: Float32[np.ndarray, " 3"],
) -> float:
    """Lambert's law for (ambient, headlight, sky), on the side of the surface that is seen."""
    dx, dy, dz = direction[0], direction[1], direction[2]
    nx, ny, nz = normal[0], normal[1], normal[2]
    scale = (dx * dx + dy * dy + dz * dz) * (nx * nx + ny * ny + nz * nz)
    if scale <= 0.0:
        return lights[0]
    facing = -(dx * nx + dy * ny + dz * nz) / np.sqrt(scale)
    up = ny / np.sqrt(nx * nx + ny * ny + nz * nz)
    if facing < 0.0:
        facing, up = -facing, -up
    return lights[0] + lights[1] * facing + lights[2] * (0.5 + 0.5 * up)


@compiled
def texel_span(position: float, size: int) -> tuple[int, int, float]:
    """The two texels around a position in texels, wrapped, and the weight of the second."""
    base = np.floor(position)
    first = int(base) % size
    second = first + 1
    if second == size:
        second = 0
    return first, second, position - base


@compiled
def bilinear(atlas: Atlas, material: int, u: float, v: float) -> tuple[float, float, float]:
    """Linear colour of a material's texture, filtered between four texels."""
    rows, columns = atlas.sizes_px[material, 0], atlas.sizes_px[material, 1]
    left, right, wx = texel_span(u * columns - 0.5, columns)
    # Row 0 is the top of the picture while v grows upwards.
    top, bottom, wy = texel_span((1.0 - v) * rows - 0.5, rows)
    upper = atlas.offsets[material] + top * columns
    lower = atlas.offsets[material] + bottom * columns
    a, b = atlas.texels[upper + left], atlas.texels[upper + right]
    c, d = atlas.texels[lower + left], atlas.texels[lower + right]
    wd = wx * wy
    wb, wc = wx - wd, wy - wd
    wa = 1.0 - wx - wc
    return (
        wa * DECODED[a[0]] + wb * DECODED[b[0]] + wc * DECODED[c[0]] + wd * DECODED[d[0]],
        wa * DECODED[a[1]] + wb * DECODED[b[1]] + wc * DECODED[c[1]] + wd * DECODED[d[1]],
        wa * DECODED[a[2]] + wb * DECODED[b[2]] + wc * DECODED[c[2]] + wd * DECODED[d[2]],
    )


@compiled
def surface_colour(atlas: Atlas, triangle: int, b1: float, b2: float) -> tuple[float, float, float]:
    """Unlit linear colour at barycentrics of a triangle: texture × material × vertex colour."""
    material = atlas.material_of_triangle[triangle]
    b0 = 1.0 - b1 - b2
    colour = atlas.colours[material]
    red, green, blue = colour[0], colour[1], colour[2]
    if atlas.sizes_px[material, 0] > 0:
        uv = atlas.uvs[triangle]
        u = b0 * uv[0, 0] + b1 * uv[1, 0] + b2 * uv[2, 0]
        v = b0 * uv[0, 1] + b1 * uv[1, 1] + b2 * uv[2, 1]
        r, g, b = bilinear(atlas, material, u, v)
        red, green, blue = red * r, green * g, blue * b
    if len(atlas.vertex_colours) > 0:
        corners = atlas.triangles[triangle]
        p = atlas.vertex_colours[corners[0]]
        q = atlas.vertex_colours[corners[1]]
        s = atlas.vertex_colours[corners[2]]
        red *= b0 * DECODED[p[0]] + b1 * DECODED[q[0]] + b2 * DECODED[s[0]]
        green *= b0 * DECODED[p[1]] + b1 * DECODED[q[1]] + b2 * DECODED[s[1]]
        blue *= b0 * DECODED[p[2]] + b1 * DECODED[q[2]] + b2 * DECODED[s[2]]
    return red, green, blue


@compiled
def shade(rgb: UInt8[np.ndarray, "rays 3"], hits: Hits, atlas: Atlas, lighting: Lighting) -> None:
    """Colour of each ray's first hit, or the background."""
    for i in range(len(rgb)):
        triangle = np.int64(hits.triangles[i])
        if triangle >= len(atlas.material_of_triangle):
            for k in range(3):
                rgb[i, k] = lighting.background[k]
            continue
        weights = hits.barycentrics[i]
        red, green, blue = surface_colour(atlas, triangle, weights[0], weights[1])
        light = np.float32(1.0)
        if not atlas.unlit[atlas.material_of_triangle[triangle]]:
            light = brightness(hits.rays[i, 3:], hits.normals[i], lighting.lights)
        rgb[i, 0] = encode_level(red * light)
        rgb[i, 1] = encode_level(green * light)
        rgb[i, 2] = encode_level(blue * light)
