"""Procedural surfaces: small pictures that repeat without a seam, from fixed seeds."""

from __future__ import annotations

import math

import numpy as np
from jaxtyping import Float, UInt8

from c2nav_engine.world.builtin.palette import Rgb, mix, shade

Texture = UInt8[np.ndarray, "rows columns 4"]
Field = Float[np.ndarray, "rows columns"]


def noise(size: int, *, across: float, down: float, seed: int) -> Field:
    """Smooth noise that wraps around, zero mean, unit deviation.

    Args:
        size: Rows and columns.
        across: Typical feature length along columns, in pixels.
        down: The same along rows.
        seed: Of a generator of its own.
    """
    white = np.random.default_rng(seed).standard_normal((size, size))
    rows = np.fft.fftfreq(size)[:, None] * down
    columns = np.fft.rfftfreq(size)[None, :] * across
    kept = np.exp(-2.0 * (rows**2 + columns**2))
    smooth = np.fft.irfft2(np.fft.rfft2(white) * kept, s=(size, size))
    smooth -= smooth.mean()
    return smooth / max(float(smooth.std()), 1e-9)


def paint(rgb: Rgb, light: Field) -> Texture:
    """One colour modulated by relative lightness (1 leaves it as it is)."""
    picture = np.empty((*light.shape, 4), np.uint8)
    picture[..., :3] = np.clip(np.asarray(rgb)[None, None, :] * light[..., None], 0, 255)
    picture[..., 3] = 255
    return picture


def blend(first: Texture, second: Texture, share: Field) -> Texture:
    """`share` (0–1 per pixel) of the second picture over the first."""
    weight = np.clip(share, 0.0, 1.0)[..., None]
    return np.round(first * (1.0 - weight) + second * weight).astype(np.uint8)


def plaster(rgb: Rgb) -> Texture:
    """Painted wall: hardly visible roller marks."""
    light = 1.0 + 0.012 * noise(128, across=2, down=2, seed=1)
    return paint(rgb, light + 0.010 * noise(128, across=30, down=30, seed=2))


def fabric(rgb: Rgb) -> Texture:
    """Woven cloth."""
    row, column = np.mgrid[0:128, 0:128]
    weave = 0.035 * np.sin(column * math.tau / 4) * np.cos(row * math.tau / 4)
    return paint(rgb, 1.0 + weave + 0.045 * noise(128, across=3, down=3, seed=3))


def carpet(rgb: Rgb) -> Texture:
    """Short pile, mottled."""
    light = 1.0 + 0.085 * noise(128, across=1.5, down=1.5, seed=4)
    return paint(rgb, light + 0.03 * noise(128, across=24, down=24, seed=5))


def wood(rgb: Rgb) -> Texture:
    """Grain along the columns of the picture (its horizontal)."""
    streaks = 0.07 * noise(128, across=90, down=3, seed=6)
    rings = 0.05 * np.sin(6.0 * noise(128, across=120, down=22, seed=7))
    return paint(rgb, 1.0 + streaks + rings + 0.02 * noise(128, across=20, down=1, seed=8))


def planks(rgb: Rgb) -> Texture:
    """Floorboards: eight staggered rows, each board of its own lightness."""
    size, rows = 256, 8
    height = size // rows
    row, column = np.mgrid[0:size, 0:size]
    board_row = row // height
    along = (column + board_row * 97) % size
    tone = np.random.default_rng(9).uniform(0.86, 1.08, rows)[board_row]
    grain = 0.05 * noise(size, across=140, down=2, seed=10)
    grain += 0.03 * np.sin(5.0 * noise(size, across=160, down=9, seed=11) + board_row)
    seam = (row % height < 1) | (along < 1)
    return paint(rgb, np.where(seam, 0.66, tone + grain))


def herringbone(rgb: Rgb) -> Texture:
    """Parquet of short blocks in zigzag."""
    size, block = 256, 32
    row, column = np.mgrid[0:size, 0:size]
    stripe = column // (2 * block)
    slanted = row + column * (1 - 2 * (stripe % 2))
    index = (slanted // block) % 8
    tone = np.random.default_rng(12).uniform(0.84, 1.12, (4, 8))[stripe % 4, index]
    seam = (slanted % block < 2) | (column % (2 * block) < 2)
    grain = 0.05 * noise(size, across=5, down=40, seed=13)
    return paint(rgb, np.where(seam, 0.66, tone + grain))


def tiles(rgb: Rgb, *, count: int = 4, second: Rgb | None = None) -> Texture:
    """Square tiles with grout; a chessboard when a second colour is given."""
    size = 256
    row, column = np.mgrid[0:size, 0:size]
    tile_row, tile_column = row * count // size, column * count // size
    tone = np.random.default_rng(14).uniform(0.95, 1.04, (count, count))
    light = tone[tile_row, tile_column] + 0.02 * noise(size, across=20, down=20, seed=15)
    grout = ((row * count) % size < 3 * count) | ((column * count) % size < 3 * count)
    picture = paint(rgb, np.where(grout, 0.72, light))
    if second is None:
        return picture
    odd = ((tile_row + tile_column) % 2 == 1) & ~grout
    return blend(picture, paint(second, light), odd.astype(float))


def brick(rgb: Rgb) -> Texture:
    """Running bond: eight courses."""
    size, courses = 256, 8
    height, width = size // courses, size // 4
    row, column = np.mgrid[0:size, 0:size]
    course = row // height
    along = (column + (course % 2) * width // 2) % size
    tone = np.random.default_rng(16).uniform(0.80, 1.14, (courses, 4))[course, along // width]
    mortar = (row % height < 3) | (along % width < 3)
    rough = 0.06 * noise(size, across=4, down=4, seed=17)
    laid = paint(rgb, tone + rough)
    return blend(laid, paint((206, 198, 186), 1.0 + rough), mortar.astype(float))


def stripes(first: Rgb, second: Rgb, *, count: int = 4) -> Texture:
    """Upright stripes, as on wallpaper."""
    column = np.broadcast_to(np.arange(128)[None, :], (128, 128))
    share = (np.sin((column + 0.5) * math.tau * count / 128) > 0).astype(float)
    soft = 1.0 + 0.012 * noise(128, across=3, down=3, seed=18)
    return blend(paint(first, soft), paint(second, soft), share)


def dots(first: Rgb, second: Rgb) -> Texture:
    """Staggered small diamonds, as on wallpaper."""
    row, column = np.mgrid[0:128, 0:128]
    shifted = column + 16 * ((row // 32) % 2)
    distance = np.abs(row % 32 - 16) + 1.6 * np.abs(shifted % 32 - 16)
    return blend(
        paint(first, np.ones((128, 128))), paint(second, np.ones((128, 128))), 4.5 - distance / 2
    )


def marble(rgb: Rgb) -> Texture:
    """Stone with veins."""
    warp = noise(256, across=60, down=60, seed=19)
    veins = np.abs(np.sin(2.2 * warp + 0.6 * noise(256, across=14, down=14, seed=20)))
    return paint(rgb, 1.02 - 0.16 * np.exp(-9.0 * veins) + 0.015 * warp)


def plain(rgb: Rgb) -> Texture:
    """Lacquer, metal, ceramics: one colour."""
    return paint(rgb, np.ones((4, 4)))


def leaf(rgb: Rgb) -> Texture:
    """A leaf along the columns: light midrib, darker edges."""
    row = (np.arange(32)[:, None] - 15.5) / 16.0
    light = np.broadcast_to(1.08 - 0.35 * row**2 + 0.3 * np.exp(-((row / 0.1) ** 2)), (32, 32))
    return paint(rgb, light * np.linspace(0.8, 1.1, 32)[None, :])


def rug(rgb: Rgb, accent: Rgb) -> Texture:
    """A whole rug with border and medallion; does not repeat."""
    row, column = np.mgrid[-1:1:192j, -1:1:192j]
    pile = 1.0 + 0.06 * noise(192, across=1.5, down=1.5, seed=23)
    ground, trim = paint(rgb, pile), paint(accent, pile)
    pale = paint(mix(accent, (240, 232, 214), 0.65), pile)
    edge = np.maximum(np.abs(row), np.abs(column))
    picture = blend(ground, trim, (edge > 0.86).astype(float))
    picture = blend(picture, pale, ((edge > 0.76) & (edge < 0.81)).astype(float))
    radius = np.abs(row) + np.abs(column)
    picture = blend(picture, pale, (radius < 0.55).astype(float))
    picture = blend(picture, trim, (radius < 0.46).astype(float))
    return blend(picture, ground, (np.hypot(row, column) < 0.2).astype(float))


def striped_rug(rgb: Rgb, accent: Rgb) -> Texture:
    """A whole rug with cross stripes; does not repeat."""
    row = np.broadcast_to(np.linspace(0.0, 1.0, 192)[:, None], (192, 192))
    pile = 1.0 + 0.06 * noise(192, across=1.5, down=1.5, seed=24)
    pale = mix(rgb, (244, 238, 226), 0.75)
    picture = blend(paint(rgb, pile), paint(pale, pile), (np.sin(row * 44) > 0.35).astype(float))
    return blend(picture, paint(accent, pile), (np.sin(row * 22 + 1.2) > 0.86).astype(float))


def books(seed: int) -> Texture:
    """A shelf's worth of book spines on a dark back."""
    random = np.random.default_rng(seed)
    tones = (
        (120, 40, 38),
        (40, 70, 110),
        (60, 96, 62),
        (200, 176, 120),
        (90, 60, 92),
        (70, 70, 74),
    )
    picture = paint((44, 36, 31), np.ones((64, 256)))
    column = 3
    while column < 238:
        width, height = int(random.integers(7, 17)), int(random.integers(40, 61))
        if random.random() < 0.86:
            spine = shade(tones[int(random.integers(len(tones)))], float(random.uniform(0.7, 1.1)))
            picture[64 - height :, column : column + width, :3] = spine
            band = 64 - height + 8
            picture[band : band + 3, column : column + width, :3] = shade(spine, 1.5)
            picture[64 - height :, column + width - 1, :3] = shade(spine, 0.6)
        column += width
    return picture
