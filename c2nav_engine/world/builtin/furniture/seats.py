"""Things to sit or lie on."""

from __future__ import annotations

import math

from c2nav_engine.world.builtin.furniture.model import Tones, mirrored
from c2nav_engine.world.builtin.looks import fabric, lacquer, metal, wood
from c2nav_engine.world.builtin.mesh import Solid, box, cushion, cylinder, lathe


def _upholstered(tones: Tones, seats: int, seat_m: float) -> list[Solid]:
    """A sofa or armchair: base, arms, back and as many cushions as seats."""
    cloth, pale = fabric(tones.colour), fabric(tones.colour, light=1.12)
    inner = seats * seat_m
    width, depth = inner + 0.4, 0.92
    solids = [cushion(cloth, (width - 0.04, 0.24, depth - 0.06), (0, 0.12, 0), radius=0.04)]
    solids += [
        cushion(cloth, (0.2, 0.5, depth), (side * (width / 2 - 0.1), 0.12, 0), radius=0.07)
        for side in (-1, 1)
    ]
    solids.append(
        cushion(cloth, (inner + 0.1, 0.66, 0.24), (0, 0.16, -depth / 2 + 0.12), radius=0.08)
    )
    for index in range(seats):
        x = (index - (seats - 1) / 2) * seat_m
        solids.append(cushion(pale, (seat_m - 0.01, 0.16, 0.66), (x, 0.34, 0.1), radius=0.05))
        back = cushion(pale, (seat_m - 0.02, 0.42, 0.17), radius=0.07).tilted(-0.2)
        solids.append(back.at(x, 0.46, -0.2))
    legs = mirrored(width / 2 - 0.1, depth / 2 - 0.1)
    return solids + [cylinder(wood(tones.wood), 0.025, 0.13, (x, 0, z), sides=8) for x, z in legs]


def sofa(tones: Tones) -> list[Solid]:
    """Two or three seats, with two throw pillows of another shade."""
    seats = 2 + tones.variant % 2
    solids = _upholstered(tones, seats, 0.7)
    pillow = fabric("cream" if tones.variant % 3 else "charcoal")
    for side in (-1, 1):
        soft = cushion(pillow, (0.38, 0.38, 0.13), radius=0.06).tilted(-0.35)
        solids.append(soft.at(side * (seats * 0.35 - 0.22), 0.5, 0.02))
    return solids


def armchair(tones: Tones) -> list[Solid]:
    """One deep seat."""
    return _upholstered(tones, 1, 0.58)


def _bed(tones: Tones, width: float, pillows: int) -> list[Solid]:
    timber, cover = wood(tones.wood), fabric(tones.colour)
    length = 2.05
    solids = [
        box(timber, (width + 0.08, 0.2, length), (0, 0.12, 0)),
        cushion(timber, (width + 0.12, 1.0, 0.08), (0, 0.05, -length / 2), radius=0.03),
        cushion(fabric("white"), (width, 0.2, length - 0.1), (0, 0.3, 0.02), radius=0.06),
        cushion(cover, (width + 0.07, 0.17, length * 0.66), (0, 0.36, 0.33), radius=0.06),
        cushion(fabric(tones.colour, light=0.82), (width + 0.09, 0.05, 0.5), (0, 0.5, 0.62)),
    ]
    for index in range(pillows):
        x = (index - (pillows - 1) / 2) * width / pillows
        soft = cushion(fabric("white"), (width / pillows - 0.12, 0.15, 0.42), radius=0.07)
        solids.append(soft.tilted(-0.12).at(x, 0.48, -length / 2 + 0.33))
    legs = mirrored(width / 2 - 0.05, length / 2 - 0.08)
    return solids + [box(timber, (0.08, 0.14, 0.08), (x, 0, z)) for x, z in legs]


def double_bed(tones: Tones) -> list[Solid]:
    """Two pillows, coloured cover, headboard."""
    return _bed(tones, 1.6, 2)


def single_bed(tones: Tones) -> list[Solid]:
    """One pillow, coloured cover, headboard."""
    return _bed(tones, 0.95, 1)


def dining_chair(tones: Tones) -> list[Solid]:
    """Four legs, padded seat, slatted back."""
    timber = wood(tones.wood)
    solids = [box(timber, (0.04, 0.44, 0.04), (x, 0, z)) for x, z in mirrored(0.19, 0.19)]
    solids += [box(timber, (0.04, 0.48, 0.035), (side * 0.19, 0.44, -0.19)) for side in (-1, 1)]
    solids += [
        box(timber, (0.36, 0.06, 0.025), (0, height, -0.19)) for height in (0.58, 0.72, 0.85)
    ]
    return [*solids, cushion(fabric(tones.colour), (0.44, 0.07, 0.43), (0, 0.42, 0), radius=0.03)]


def stool(tones: Tones) -> list[Solid]:
    """A bar stool with a round seat."""
    iron = metal(dark=True)
    solids = [cylinder(iron, 0.018, 0.66, (x, 0, z), sides=8) for x, z in mirrored(0.15, 0.15)]
    solids += [box(iron, (0.32, 0.02, 0.02), (0, 0.24, z)) for z in (-0.15, 0.15)]
    seat = ((0.0, 0.0), (0.18, 0.0), (0.2, 0.03), (0.2, 0.06), (0.17, 0.085), (0.0, 0.09))
    return [*solids, lathe(fabric(tones.colour), seat).at(0, 0.65, 0)]


def office_chair(tones: Tones) -> list[Solid]:
    """Five castors, column, seat, tall back, arms."""
    iron, cloth = metal(dark=True), fabric(tones.colour)
    solids = [cylinder(iron, 0.03, 0.34, (0, 0.08, 0), sides=10)]
    for spoke in range(5):
        yaw = spoke * math.tau / 5
        solids.append(box(iron, (0.04, 0.03, 0.28), (0, 0.06, 0.14)).turned(yaw))
        solids.append(cushion(iron, (0.05, 0.06, 0.05), (0, 0, 0.27), radius=0.025).turned(yaw))
    solids.append(cushion(cloth, (0.48, 0.09, 0.48), (0, 0.42, 0), radius=0.04))
    solids.append(cushion(cloth, (0.44, 0.6, 0.08), radius=0.04).tilted(-0.12).at(0, 0.52, -0.23))
    for side in (-1, 1):
        solids.append(box(iron, (0.03, 0.2, 0.03), (side * 0.26, 0.45, -0.05)))
        solids.append(cushion(iron, (0.06, 0.03, 0.26), (side * 0.26, 0.65, 0), radius=0.015))
    return solids


def bench(tones: Tones) -> list[Solid]:
    """A low wooden bench with a coloured pad."""
    timber = wood(tones.wood)
    solids = [box(timber, (1.1, 0.05, 0.38), (0, 0.38, 0))]
    solids += [box(timber, (0.06, 0.38, 0.34), (side * 0.48, 0, 0)) for side in (-1, 1)]
    solids.append(box(timber, (0.9, 0.07, 0.03), (0, 0.14, 0)))
    return [*solids, cushion(fabric(tones.colour), (1.06, 0.07, 0.36), (0, 0.42, 0), radius=0.03)]


def ottoman(tones: Tones) -> list[Solid]:
    """A round padded footstool with button seam."""
    profile = ((0.0, 0.0), (0.27, 0.0), (0.31, 0.06), (0.32, 0.3), (0.28, 0.39), (0.0, 0.42))
    band = lathe(fabric(tones.colour, light=0.75), ((0.323, 0.18), (0.326, 0.2), (0.323, 0.22)))
    return [lathe(fabric(tones.colour), profile, sides=20), band]


def beanbag(tones: Tones) -> list[Solid]:
    """A slumped, pear-shaped bag."""
    profile = (
        (0.0, 0.0),
        (0.36, 0.02),
        (0.43, 0.14),
        (0.4, 0.28),
        (0.29, 0.46),
        (0.18, 0.6),
        (0.09, 0.68),
        (0.0, 0.7),
    )
    return [lathe(fabric(tones.colour), profile, sides=14)]


def rocking_chair(tones: Tones) -> list[Solid]:
    """Curved runners, spindle back, coloured seat."""
    timber = wood(tones.wood)
    solids: list[Solid] = []
    for side in (-0.24, 0.24):
        for index in range(6):
            angle = (index - 2.5) * 0.16
            runner = box(timber, (0.04, 0.035, 0.16)).tilted(-angle)
            solids.append(runner.at(side, 0.95 * (1 - math.cos(angle)), 0.95 * math.sin(angle)))
        solids.append(box(timber, (0.035, 0.42, 0.035), (side, 0.02, 0.2)))
        solids.append(box(timber, (0.035, 1.0, 0.035), (side, 0.03, -0.2)).tilted(-0.06))
        solids.append(box(timber, (0.06, 0.03, 0.5), (side, 0.6, 0.0)))
    solids += [box(timber, (0.02, 0.5, 0.02), (x, 0.46, -0.24)) for x in (-0.14, -0.05, 0.05, 0.14)]
    solids.append(box(timber, (0.5, 0.08, 0.03), (0, 0.94, -0.25)))
    return [*solids, cushion(fabric(tones.colour), (0.5, 0.08, 0.46), (0, 0.38, 0), radius=0.03)]


def piano_stool(tones: Tones) -> list[Solid]:
    """A low rectangular stool."""
    solids = [box(lacquer("black"), (0.05, 0.4, 0.05), (x, 0, z)) for x, z in mirrored(0.26, 0.13)]
    return [*solids, cushion(fabric(tones.colour), (0.62, 0.09, 0.34), (0, 0.4, 0), radius=0.04)]
