"""Pictures that hang or shine: paintings, views out of windows, screens and clocks."""

from __future__ import annotations

import math

import numpy as np

from c2nav_engine.world.builtin.palette import Rgb, mix, shade
from c2nav_engine.world.builtin.textures import Texture, blend, noise, paint


def _plain(rgb: Rgb, size: int = 160) -> Texture:
    return paint(rgb, np.ones((size, size)))


def outdoors(seed: int) -> Texture:
    """The view from a window: sky, clouds, a tree line and lawn."""
    size = 192
    row, column = np.mgrid[0:size, 0:size] / size
    sky = blend(_plain((150, 190, 226), size), _plain((226, 238, 244), size), row / 0.6)
    clouds = noise(size, across=40, down=14, seed=seed)
    sky = blend(sky, _plain((252, 252, 252), size), np.clip((clouds - 0.5) * 0.7, 0, 0.85))
    hills = 0.56 + 0.03 * np.sin(column * math.tau + seed) + 0.015 * np.sin(3 * column * math.tau)
    picture = blend(sky, _plain((150, 176, 166), size), ((row - hills) * 40).clip(0, 1))
    crowns = 0.62 + 0.03 * noise(size, across=9, down=200, seed=seed + 1)
    leaves = paint((74, 112, 66), 1.0 + 0.2 * noise(size, across=4, down=4, seed=seed + 2))
    picture = blend(picture, leaves, ((row - crowns) * 60).clip(0, 1))
    grass = paint((122, 158, 86), 1.0 + 0.07 * noise(size, across=12, down=3, seed=seed + 3))
    return blend(picture, grass, ((row - 0.76) * 30).clip(0, 1))


def landscape(accent: Rgb, seed: int) -> Texture:
    """A painted landscape in layers of one colour."""
    row, column = np.mgrid[0:160, 0:160] / 160
    random = np.random.default_rng(seed)
    sky = blend(_plain(mix(accent, (250, 240, 220), 0.7)), _plain((250, 226, 186)), row)
    sun = np.hypot(row - random.uniform(0.2, 0.4), column - random.uniform(0.25, 0.75))
    picture = blend(sky, _plain((252, 246, 214)), (sun < 0.11).astype(float))
    for layer, share in enumerate((0.35, 0.1, 0.0)):
        level = 0.5 + 0.15 * layer
        phase, waves = random.uniform(0, math.tau), random.uniform(0.6, 1.8)
        ridge = level + 0.07 * np.sin(column * math.tau * waves + phase)
        colour = shade(mix(accent, (235, 225, 210), share), 1.0 - 0.22 * max(layer - 1, 0))
        picture = blend(picture, _plain(colour), ((row - ridge) * 80).clip(0, 1))
    return picture


def abstract(accent: Rgb, seed: int) -> Texture:
    """Overlapping discs and bars around one colour."""
    row, column = np.mgrid[0:160, 0:160] / 160
    random = np.random.default_rng(seed)
    ground = paint((238, 230, 214), 1.0 + 0.02 * noise(160, across=3, down=3, seed=seed))
    tones = (accent, shade(accent, 0.6), mix(accent, (245, 235, 215), 0.55), (44, 46, 54))
    picture = ground
    for index in range(5):
        tone = _plain(tones[index % len(tones)])
        y, x, radius = random.uniform(0.2, 0.8), random.uniform(0.2, 0.8), random.uniform(0.1, 0.3)
        if index % 2:
            shape = (np.abs(column - x) < radius / 3) & (np.abs(row - y) < radius * 1.3)
        else:
            shape = np.hypot(row - y, column - x) < radius
        picture = blend(picture, tone, shape * 0.92)
    return picture


def screen() -> Texture:
    """A switched-off television with a faint reflection."""
    row, column = np.mgrid[0:64, 0:64] / 64
    return blend(_plain((22, 24, 28), 64), _plain((74, 80, 90), 64), (column - row) * 0.5)


def clock() -> Texture:
    """A clock face at ten past ten."""
    row, column = np.mgrid[-1:1:96j, -1:1:96j]
    radius, angle = np.hypot(row, column), np.arctan2(column, -row)
    picture = blend(_plain((60, 44, 34), 96), _plain((246, 244, 236), 96), (0.9 - radius) * 30)
    hours = (np.abs(np.sin(6 * angle)) < 0.25) & (radius > 0.68) & (radius < 0.82)
    for hand, reach in ((-math.tau / 6, 0.42), (math.tau / 6, 0.62)):
        along = column * math.sin(hand) - row * math.cos(hand)
        aside = column * math.cos(hand) + row * math.sin(hand)
        hours |= (np.abs(aside) < 0.045) & (along > -0.08) & (along < reach)
    return blend(picture, _plain((38, 36, 38), 96), hours.astype(float))


def mirror() -> Texture:
    """What a blind mirror shows: a bright, cool gradient."""
    row, column = np.mgrid[0:64, 0:64] / 64
    return blend(_plain((178, 194, 202), 64), _plain((226, 234, 238), 64), (row + column) / 2)


def aquarium() -> Texture:
    """Water with plants and fish, seen from the side."""
    row, column = np.mgrid[0:128, 0:128] / 128
    picture = blend(_plain((110, 196, 214), 128), _plain((28, 92, 132), 128), row)
    weeds = np.abs(np.sin(column * 22 + 0.8 * np.sin(row * 9))) < 0.22
    weeds &= row > 0.45 + 0.2 * np.sin(column * 9)
    picture = blend(picture, _plain((48, 120, 70), 128), weeds.astype(float))
    for y, x in ((0.3, 0.25), (0.45, 0.7), (0.6, 0.42)):
        fish = ((row - y) / 0.045) ** 2 + ((column - x) / 0.08) ** 2 < 1
        picture = blend(picture, _plain((240, 140, 52), 128), fish.astype(float))
    return blend(picture, _plain((196, 172, 130), 128), ((row - 0.9) * 40).clip(0, 1))
