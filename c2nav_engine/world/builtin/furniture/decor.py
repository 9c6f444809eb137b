"""Lamps, plants, vases, rugs, pictures and other landmarks."""

from __future__ import annotations

import math

import numpy as np

from c2nav_engine.world.builtin.furniture.model import Tones, mirrored
from c2nav_engine.world.builtin.looks import (
    clock_face,
    fabric,
    lacquer,
    lamp_glow,
    leaves,
    metal,
    mirror,
    painting,
    rug,
    solid,
    water,
    wood,
)
from c2nav_engine.world.builtin.mesh import (
    Solid,
    box,
    cushion,
    cylinder,
    disc_facing_front,
    lathe,
    sheet,
)


def _blade(length: float, width: float, *, lift: float, droop: float) -> Solid:
    """One bent leaf from the origin along +z, in three segments."""
    along = np.linspace(0.0, 1.0, 4)
    height = lift * along - droop * along**2
    half = width / 2 * np.array((0.25, 1.0, 0.8, 0.03))
    left = np.stack([-half, height, length * along], axis=1)
    right = np.stack([half, height, length * along], axis=1)
    vertices = np.concatenate([left, right])
    triangles = np.array([t for k in range(3) for t in ((k, k + 4, k + 5), (k, k + 5, k + 1))])
    uvs = np.stack([np.tile(along, 2), np.repeat((1.0, 0.0), 4)], axis=1)[triangles[:, ::-1]]
    return Solid(leaves(), vertices, triangles[:, ::-1], uvs)


def _pot(colour: str, radius: float, height: float) -> list[Solid]:
    profile = (
        (0.0, 0.0),
        (radius * 0.72, 0.0),
        (radius * 0.95, height * 0.85),
        (radius, height * 0.86),
        (radius, height),
        (radius * 0.88, height),
        (radius * 0.86, height * 0.9),
    )
    soil = cylinder(solid((70, 52, 40)), radius * 0.87, 0.01, (0, height * 0.9, 0))
    return [lathe(lacquer(colour), profile, sides=18), soil]


def plant(tones: Tones) -> list[Solid]:
    """Broad leaves in rings above a coloured pot."""
    solids = _pot(tones.colour, 0.2, 0.36)
    random = np.random.default_rng(100 + tones.variant)
    for index in range(26):
        level = index / 26
        blade = _blade(
            0.2 + 0.16 * math.sin(math.pi * (0.15 + 0.7 * level)),
            0.11,
            lift=0.12 + 0.34 * level,
            droop=0.16,
        )
        yaw = index * 2.4 + float(random.uniform(-0.2, 0.2))
        solids.append(blade.turned(yaw).at(0, 0.36 + 0.5 * level, 0))
    return [*solids, cylinder(solid((92, 76, 50)), 0.018, 0.6, (0, 0.3, 0), sides=7)]


def palm(tones: Tones) -> list[Solid]:
    """A tall trunk with long drooping fronds in a coloured pot."""
    solids = _pot(tones.colour, 0.23, 0.4)
    solids.append(cylinder(solid((120, 92, 62)), 0.035, 0.85, (0, 0.32, 0), sides=8))
    for index in range(16):
        frond = _blade(0.42, 0.09, lift=0.46 - 0.02 * index, droop=0.4)
        solids.append(frond.turned(index * 2.4).at(0, 1.15 - 0.012 * index, 0))
    return solids


def tall_vase(tones: Tones) -> list[Solid]:
    """A floor vase in a strong colour with dry branches."""
    shapes = (
        (
            (0.0, 0.0),
            (0.12, 0.0),
            (0.19, 0.16),
            (0.21, 0.34),
            (0.13, 0.56),
            (0.08, 0.66),
            (0.11, 0.74),
            (0.09, 0.74),
            (0.0, 0.6),
        ),
        (
            (0.0, 0.0),
            (0.1, 0.0),
            (0.13, 0.2),
            (0.19, 0.5),
            (0.2, 0.62),
            (0.12, 0.72),
            (0.13, 0.76),
            (0.1, 0.76),
            (0.0, 0.6),
        ),
    )
    solids = [lathe(lacquer(tones.colour), shapes[tones.variant % 2], sides=20)]
    band = (
        ((0.205, 0.3), (0.213, 0.33), (0.205, 0.36))
        if tones.variant % 2 == 0
        else ((0.195, 0.5), (0.2, 0.52), (0.198, 0.54))
    )
    solids.append(lathe(lacquer("cream"), band, sides=20))
    for index in range(5):
        twig = cylinder(solid((128, 100, 70)), 0.006, 0.55, sides=5).tilted(0.14 + 0.03 * index)
        solids.append(twig.turned(index * 1.3).at(0, 0.62, 0))
    return solids


def floor_lamp(tones: Tones) -> list[Solid]:
    """A coloured shade on a slim stand."""
    iron = metal(dark=True)
    shade = ((0.22, 1.32), (0.15, 1.62), (0.145, 1.62), (0.215, 1.32))
    return [
        cylinder(iron, 0.15, 0.025, sides=16),
        cylinder(iron, 0.014, 1.5, sides=8),
        lathe(fabric(tones.colour), shade, sides=20),
        lathe(lamp_glow(), ((0.0, 1.4), (0.05, 1.44), (0.0, 1.52)), sides=8),
    ]


def rug_of(tones: Tones) -> list[Solid]:
    """A patterned rug, flat enough to walk over."""
    width, depth = ((2.3, 1.6), (1.7, 1.7), (2.6, 1.8))[tones.variant % 3]
    look = rug(tones.colour, tones.variant)
    top = sheet(
        look,
        (-width / 2, 0.012, depth / 2),
        ((width, 0, 0), (0, 0, -depth)),
        parts=(8, 6),
        whole=True,
    )
    return [top, box(fabric(tones.colour, light=0.7), (width, 0.011, depth))]


def runner(tones: Tones) -> list[Solid]:
    """A long narrow rug for corridors."""
    width, depth = 2.4, 0.75
    look = rug(tones.colour, 2 * tones.variant + 1)
    top = sheet(
        look,
        (-width / 2, 0.012, depth / 2),
        ((width, 0, 0), (0, 0, -depth)),
        parts=(8, 3),
        whole=True,
    )
    return [top, box(fabric(tones.colour, light=0.7), (width, 0.011, depth))]


def painting_of(tones: Tones) -> list[Solid]:
    """A framed canvas around one colour; hangs with its centre at eye height."""
    width, height = ((0.9, 0.66), (0.66, 0.86), (1.1, 0.7))[tones.variant % 3]
    frame = wood(tones.wood)
    low = 1.5 - height / 2
    canvas = sheet(
        painting(tones.colour, tones.variant),
        (-width / 2, low, 0.022),
        ((width, 0, 0), (0, height, 0)),
        whole=True,
    )
    solids = [canvas, box(solid((236, 230, 218)), (width, height, 0.02), (0, low, 0.01))]
    for side in (-1, 1):
        solids.append(
            box(frame, (width + 0.1, 0.05, 0.045), (0, 1.475 + side * (height / 2 + 0.025), 0.015))
        )
        solids.append(box(frame, (0.05, height, 0.045), (side * (width / 2 + 0.025), low, 0.015)))
    return solids


def wall_mirror(tones: Tones) -> list[Solid]:
    """A round mirror in a coloured frame."""
    ring = lathe(
        lacquer(tones.colour), ((0.0, 0.0), (0.42, 0.0), (0.42, 0.03), (0.36, 0.035)), sides=24
    )
    return [
        ring.tilted(math.pi / 2).at(0, 1.5, 0),
        disc_facing_front(mirror(), 0.37, (0, 1.5, 0.036)),
    ]


def wall_clock(tones: Tones) -> list[Solid]:
    """A round clock in a coloured case."""
    case = lathe(
        lacquer(tones.colour), ((0.0, 0.0), (0.26, 0.0), (0.26, 0.05), (0.22, 0.055)), sides=24
    )
    return [
        case.tilted(math.pi / 2).at(0, 1.8, 0),
        disc_facing_front(clock_face(), 0.225, (0, 1.8, 0.056)),
    ]


def aquarium(tones: Tones) -> list[Solid]:
    """A lit tank on a coloured cabinet."""
    solids = [
        box(lacquer(tones.colour), (1.05, 0.7, 0.42)),
        box(metal(dark=True), (1.07, 0.05, 0.44), (0, 1.22, 0)),
    ]
    solids.append(box(solid((60, 128, 160)), (1.0, 0.52, 0.38), (0, 0.7, 0)))
    front = sheet(water(), (-0.5, 0.7, 0.192), ((1.0, 0, 0), (0, 0.52, 0)), whole=True)
    solids += [
        box(lacquer(tones.colour, light=1.15), (0.5, 0.6, 0.015), (x, 0.05, 0.212))
        for x in (-0.26, 0.26)
    ]
    return [*solids, front]


def globe(tones: Tones) -> list[Solid]:
    """A globe on a wooden stand."""
    angle = np.linspace(-math.pi / 2, math.pi / 2, 9)
    ball = [(0.22 * math.cos(a) + 1e-6, 0.82 + 0.22 * math.sin(a)) for a in angle]
    stand = (
        (0.0, 0.0),
        (0.2, 0.0),
        (0.18, 0.03),
        (0.03, 0.08),
        (0.03, 0.56),
        (0.1, 0.6),
        (0.0, 0.6),
    )
    ring = lathe(
        wood(tones.wood), ((0.235, 0.8), (0.27, 0.8), (0.27, 0.83), (0.235, 0.83)), sides=20
    )
    return [lathe(lacquer(tones.colour), ball, sides=18), lathe(wood(tones.wood), stand), ring]


def piano(tones: Tones) -> list[Solid]:
    """An upright piano in dark lacquer."""
    body = lacquer("black") if tones.variant % 2 else wood("walnut")
    solids = [
        box(body, (1.45, 1.2, 0.36), (0, 0, -0.12)),
        box(body, (1.45, 0.08, 0.3), (0, 0.62, 0.18)),
        box(lacquer("white"), (1.3, 0.025, 0.16), (0, 0.7, 0.2)),
        cushion(body, (1.5, 0.04, 0.4), (0, 1.2, -0.12), radius=0.015),
    ]
    solids += [box(body, (0.08, 0.62, 0.1), (x, 0, 0.26)) for x in (-0.66, 0.66)]
    for index in range(24):
        if index % 7 not in {2, 6}:
            solids.append(
                box(lacquer("black"), (0.026, 0.025, 0.09), (-0.6 + 0.0525 * index, 0.715, 0.17))
            )
    music = box(lacquer("cream"), (0.42, 0.28, 0.012), (0, 0.8, 0.1)).tilted(-0.12)
    return [
        *solids,
        music.at(0, 0.02, 0.06),
        *[s.at(0.5, 1.24, -0.12) for s in _small_pot(tones.colour)],
    ]


def _small_pot(colour: str) -> list[Solid]:
    solids = _pot(colour, 0.09, 0.14)
    return solids + [
        _blade(0.18, 0.05, lift=0.16, droop=0.06).turned(k * 1.05).at(0, 0.13, 0) for k in range(6)
    ]


def fireplace(tones: Tones) -> list[Solid]:
    """A mantelpiece around glowing logs."""
    surround = lacquer(tones.colour)
    solids = [box(surround, (0.3, 1.05, 0.36), (side * 0.55, 0, 0)) for side in (-1, 1)]
    solids.append(box(surround, (1.4, 0.28, 0.36), (0, 0.8, 0)))
    solids.append(cushion(surround, (1.6, 0.07, 0.44), (0, 1.08, 0.02), radius=0.02))
    solids.append(box(solid((34, 30, 30)), (0.82, 0.8, 0.02), (0, 0, -0.15)))
    solids.append(box(solid((78, 74, 72)), (1.5, 0.04, 0.5), (0, 0, 0.06)))
    for index in range(3):
        log = cylinder(wood("walnut"), 0.05, 0.5, sides=8).leaned(math.pi / 2)
        solids.append(log.at(0.25, 0.09 + 0.09 * (index == 2), -0.05 + 0.09 * (index % 2)))
    flame = lathe(lamp_glow(), ((0.0, 0.0), (0.1, 0.06), (0.05, 0.2), (0.0, 0.3)), sides=8)
    return [
        *solids,
        flame.at(0, 0.14, -0.05),
        *[s.at(-0.5, 1.15, 0.02) for s in _small_pot("white")],
    ]


def pedestal(tones: Tones) -> list[Solid]:
    """A white pedestal that carries a coloured sphere."""
    angle = np.linspace(-math.pi / 2, math.pi / 2, 9)
    ball = [(0.17 * math.cos(a) + 1e-6, 1.08 + 0.17 * math.sin(a)) for a in angle]
    return [
        box(lacquer("white"), (0.36, 0.06, 0.36)),
        box(lacquer("white"), (0.3, 0.8, 0.3), (0, 0.06, 0)),
        box(lacquer("white"), (0.36, 0.05, 0.36), (0, 0.86, 0)),
        lathe(lacquer(tones.colour), ball, sides=18),
    ]


def umbrella_stand(tones: Tones) -> list[Solid]:
    """A coloured drum with two umbrellas."""
    drum = ((0.0, 0.0), (0.15, 0.0), (0.16, 0.5), (0.145, 0.5), (0.14, 0.1), (0.0, 0.1))
    solids = [lathe(lacquer(tones.colour), drum, sides=16)]
    for side, colour in ((-1, "charcoal"), (1, "navy")):
        folded = lathe(
            fabric(colour),
            ((0.0, 0.0), (0.035, 0.3), (0.03, 0.55), (0.008, 0.62), (0.008, 0.8), (0.0, 0.8)),
            sides=8,
        )
        solids.append(folded.leaned(-side * 0.1).at(side * 0.05, 0.06, 0))
    return solids


def suitcase(tones: Tones) -> list[Solid]:
    """An upright case on wheels with its handle out."""
    solids = [cushion(lacquer(tones.colour), (0.44, 0.64, 0.27), (0, 0.05, 0), radius=0.05)]
    solids += [
        box(lacquer(tones.colour, light=0.7), (0.03, 0.56, 0.28), (x, 0.09, 0))
        for x in (-0.1, 0.0, 0.1)
    ]
    solids += [
        cylinder(metal(dark=True), 0.025, 0.05, (x, 0, z), sides=8) for x, z in mirrored(0.17, 0.09)
    ]
    solids += [box(metal(), (0.015, 0.34, 0.015), (x, 0.69, -0.1)) for x in (-0.1, 0.1)]
    return [*solids, box(metal(dark=True), (0.24, 0.03, 0.03), (0, 1.02, -0.1))]
