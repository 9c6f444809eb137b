"""Compiled kernels: camera rays out, colours and depths of hits in, one pass each.

Importing this module imports numba; the renderer does so only when it is built. Two rules keep
the kernels fast, by a factor of six: arrays are taken out of their tuples once, before the loop,
because every later look at one counts a reference; and helpers take and return plain numbers.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float32, Int32, UInt8, UInt32

from c2nav_engine.sensing.atlas import Atlas
from c2nav_engine.sensing.caster import Hits
from c2nav_engine.sensing.colour import DECODED, alpha_of, encode_level
from c2nav_engine.sensing.mipmap import LEVELS
from c2nav_engine.world.compiled import compiled

LEAST_FACING = np.float32(0.05)
"""Grazing surfaces are filtered as if seen at this cosine, so that they do not blur away."""

ZERO = np.float32(0.0)
HALF = np.float32(0.5)
ONE = np.float32(1.0)
FOUR = np.float32(4.0)
"""32-bit constants: a 64-bit one would widen everything it meets."""

Real = float | np.float32
Triple = tuple[Real, Real, Real]
Four = tuple[int, int, int, int]


class Look(NamedTuple):
    """What colours depend on beside the scene.

    Attributes:
        ambient: Share of light that reaches every surface.
        headlight: Share from the camera.
        sky: Share from above.
        red: Background in sRGB.
        green: Background in sRGB.
        blue: Background in sRGB.
        pixel_m2: Area of an RGB pixel one metre ahead.
    """

    ambient: float
    headlight: float
    sky: float
    red: int
    green: int
    blue: int
    pixel_m2: float


class Canvas(NamedTuple):
    """Pictures to fill and which pixels of them each hit fills.

    Attributes:
        rgb: Pixels of the RGB picture, row by row.
        depth_m: Pixels of the depth picture, row by row.
        rgb_pixels: Of each hit, −1 for none.
        depth_pixels: Of each hit, −1 for none.
    """

    rgb: UInt8[np.ndarray, "pixels 3"]
    depth_m: Float32[np.ndarray, " depth_pixels"]
    rgb_pixels: Int32[np.ndarray, " rays"]
    depth_pixels: Int32[np.ndarray, " rays"]


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
def keep_depths(
    canvas: Canvas, t_hit: Float32[np.ndarray, " rays"], range_m: tuple[float, float]
) -> None:
    """Fill the depth pixels of a run of hits; 0 outside the sensor's range."""
    depth_m, pixels = canvas.depth_m, canvas.depth_pixels
    near_m, far_m = range_m
    for i in range(len(t_hit)):
        pixel = pixels[i]
        if pixel >= 0:
            t = t_hit[i]
            depth_m[pixel] = t if near_m <= t <= far_m else ZERO


@compiled
def facing(ray: Triple, normal: Triple) -> Triple:
    """Cosine to the viewer, upward part of the seen side's normal, length of the ray."""
    (dx, dy, dz), (nx, ny, nz) = ray, normal
    length = math.sqrt(dx * dx + dy * dy + dz * dz)
    scale = math.sqrt(nx * nx + ny * ny + nz * nz)
    if scale <= 0.0:
        return ONE, scale, length
    cosine = -(dx * nx + dy * ny + dz * nz) / (length * scale)
    up = ny / scale
    return (cosine, up, length) if cosine >= 0.0 else (-cosine, -up, length)


@compiled
def mip_level(texels: Real) -> int:
    """The level with one to four texels under a pixel that covers so many of the full texture.

    Rather too sharp than too soft: words and small things are what a model is asked about.
    """
    level = 0
    while texels >= FOUR and level < LEVELS - 1:
        texels /= FOUR
        level += 1
    return level


@compiled
def wrapped(base: Real, size: int) -> int:
    """A texel's index on a texture that repeats."""
    index = int(base)
    # Most coordinates need no wrapping, and a division is slow.
    return index if 0 <= index < size else index % size


@compiled
def texels_around(
    texels: UInt32[np.ndarray, " texels"], level: tuple[int, int, int], uv: tuple[Real, Real]
) -> tuple[Four, Triple]:
    """The four texels around (u, v), and the weights of the last three.

    `level` is a texture's first texel with its rows and columns.
    """
    first, rows, columns = level
    x = uv[0] * columns - HALF
    # Row 0 is the top of the picture while v grows upwards.
    y = (ONE - uv[1]) * rows - HALF
    across, down = math.floor(x), math.floor(y)
    left, top = wrapped(across, columns), wrapped(down, rows)
    right = left + 1 if left + 1 < columns else 0
    bottom = top + 1 if top + 1 < rows else 0
    upper, lower = first + top * columns, first + bottom * columns
    four = (
        int(texels[upper + left]),
        int(texels[upper + right]),
        int(texels[lower + left]),
        int(texels[lower + right]),
    )
    wx, wy = x - np.float32(across), y - np.float32(down)
    both = wx * wy
    return four, (wx - both, wy - both, both)


@compiled
def mixed(four: Four, weights: Triple, shift: int) -> Real:
    """One linear colour channel between four packed texels."""
    a, b, c, d = four
    wb, wc, wd = weights
    return (
        (ONE - wb - wc - wd) * DECODED[(a >> shift) & 255]
        + wb * DECODED[(b >> shift) & 255]
        + wc * DECODED[(c >> shift) & 255]
        + wd * DECODED[(d >> shift) & 255]
    )


@compiled
def paint(canvas: Canvas, hits: Hits, atlas: Atlas, look: Look) -> None:
    """Fill the RGB pixels of a run of hits: colour × light, or the background."""
    rgb, pixels = canvas.rgb, canvas.rgb_pixels
    triangles, t_hit, barycentrics = hits.triangles, hits.t_hit, hits.barycentrics
    rays, normals = hits.rays, hits.normals
    surfaces, colours, unlit = atlas.surfaces, atlas.colours, atlas.unlit
    texels, offsets, sizes_px = atlas.texels, atlas.offsets, atlas.sizes_px
    corners, vertex_colours = atlas.triangles, atlas.vertex_colours
    ambient, headlight, sky = (
        np.float32(look.ambient),
        np.float32(look.headlight),
        np.float32(look.sky),
    )
    pixel_m2 = np.float32(look.pixel_m2)
    has_vertex_colours = len(vertex_colours) > 0
    for i in range(len(pixels)):
        pixel = pixels[i]
        if pixel < 0:
            continue
        triangle = triangles[i]
        if triangle >= len(surfaces):
            rgb[pixel, 0], rgb[pixel, 1], rgb[pixel, 2] = look.red, look.green, look.blue
            continue
        material = int(surfaces[triangle, 0])
        ray = rays[i, 3], rays[i, 4], rays[i, 5]
        cosine, up, length = facing(ray, (normals[i, 0], normals[i, 1], normals[i, 2]))
        lit = ONE if unlit[material] else ambient + headlight * cosine + sky * (HALF + HALF * up)
        red = lit * colours[material, 0]
        green = lit * colours[material, 1]
        blue = lit * colours[material, 2]
        b1, b2 = barycentrics[i, 0], barycentrics[i, 1]
        b0 = ONE - b1 - b2
        if sizes_px[material, 0, 0] > 0:
            seen_m2 = pixel_m2 * t_hit[i] * t_hit[i] / (max(cosine, LEAST_FACING) * length)
            level = mip_level(surfaces[triangle, 1] * seen_m2)
            u = b0 * surfaces[triangle, 2] + b1 * surfaces[triangle, 4] + b2 * surfaces[triangle, 6]
            v = b0 * surfaces[triangle, 3] + b1 * surfaces[triangle, 5] + b2 * surfaces[triangle, 7]
            shape = (
                offsets[material, level],
                sizes_px[material, level, 0],
                sizes_px[material, level, 1],
            )
            four, weights = texels_around(texels, shape, (u, v))
            red *= mixed(four, weights, 0)
            green *= mixed(four, weights, 8)
            blue *= mixed(four, weights, 16)
        if has_vertex_colours:
            p = int(vertex_colours[corners[triangle, 0]])
            q = int(vertex_colours[corners[triangle, 1]])
            r = int(vertex_colours[corners[triangle, 2]])
            three, shares = (p, q, r, r), (b1, b2, ZERO)
            red *= mixed(three, shares, 0)
            green *= mixed(three, shares, 8)
            blue *= mixed(three, shares, 16)
        rgb[pixel, 0] = encode_level(red)
        rgb[pixel, 1] = encode_level(green)
        rgb[pixel, 2] = encode_level(blue)


@compiled
def alpha_mixed(four: Four, weights: Triple) -> Real:
    """Alpha between four packed texels."""
    a, b, c, d = four
    wb, wc, wd = weights
    return (
        (ONE - wb - wc - wd) * alpha_of(a) + wb * alpha_of(b) + wc * alpha_of(c) + wd * alpha_of(d)
    )


@compiled
def find_cutouts(through: Bool[np.ndarray, " rays"], hits: Hits, atlas: Atlas) -> int:
    """Mark hits on surfaces that are not there by alpha; returns how many."""
    triangles, barycentrics = hits.triangles, hits.barycentrics
    surfaces, colours, cutout_alphas = atlas.surfaces, atlas.colours, atlas.cutout_alphas
    texels, offsets, sizes_px = atlas.texels, atlas.offsets, atlas.sizes_px
    count = 0
    for i in range(len(through)):
        through[i] = False
        triangle = triangles[i]
        if triangle >= len(surfaces):
            continue
        material = int(surfaces[triangle, 0])
        if cutout_alphas[material] <= 0.0:
            continue
        alpha = colours[material, 3]
        if sizes_px[material, 0, 0] > 0:
            b1, b2 = barycentrics[i, 0], barycentrics[i, 1]
            b0 = ONE - b1 - b2
            u = b0 * surfaces[triangle, 2] + b1 * surfaces[triangle, 4] + b2 * surfaces[triangle, 6]
            v = b0 * surfaces[triangle, 3] + b1 * surfaces[triangle, 5] + b2 * surfaces[triangle, 7]
            full = offsets[material, 0], sizes_px[material, 0, 0], sizes_px[material, 0, 1]
            four, weights = texels_around(texels, full, (u, v))
            alpha *= alpha_mixed(four, weights)
        if alpha < cutout_alphas[material]:
            through[i] = True
            count += 1
    return count
