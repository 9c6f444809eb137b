"""Kitchen, bathroom and laundry."""

from __future__ import annotations

from c2nav_engine.world.builtin.furniture.model import Tones
from c2nav_engine.world.builtin.furniture.tables import fruit_bowl
from c2nav_engine.world.builtin.looks import (
    fabric,
    lacquer,
    lamp_glow,
    metal,
    mirror,
    screen,
    solid,
    stone,
    wood,
)
from c2nav_engine.world.builtin.mesh import Solid, box, cushion, cylinder, lathe, sheet


def _cabinets(tones: Tones, width: float, *, doors: int) -> list[Solid]:
    """A run of base units with worktop and plinth, 0.9 m high and 0.6 m deep."""
    front = lacquer(tones.colour)
    solids = [
        box(lacquer("charcoal"), (width, 0.1, 0.52), (0, 0, -0.04)),
        box(front, (width, 0.76, 0.58), (0, 0.1, -0.01)),
        cushion(stone(), (width + 0.02, 0.04, 0.63), (0, 0.86, 0.0), radius=0.01),
    ]
    for index in range(doors):
        x = (index + 0.5) * width / doors - width / 2
        solids.append(
            box(
                lacquer(tones.colour, light=1.1), (width / doors - 0.02, 0.7, 0.02), (x, 0.13, 0.29)
            )
        )
        solids.append(box(metal(), (0.14, 0.018, 0.025), (x, 0.76, 0.31)))
    return solids


def kitchen_counter(tones: Tones) -> list[Solid]:
    """Base units with a sink and tap; two lengths."""
    width = 1.8 + 0.6 * (tones.variant % 2)
    solids = _cabinets(tones, width, doors=3 + tones.variant % 2)
    solids.append(box(metal(), (0.62, 0.012, 0.44), (-0.4, 0.895, 0.02)))
    solids.append(box(solid((92, 96, 100)), (0.5, 0.006, 0.34), (-0.4, 0.906, 0.04)))
    solids.append(cylinder(metal(), 0.018, 0.28, (-0.4, 0.9, -0.2), sides=8))
    solids.append(box(metal(), (0.025, 0.02, 0.2), (-0.4, 1.16, -0.11)))
    solids.append(cylinder(lacquer("white"), 0.07, 0.2, (0.3, 0.9, -0.16), sides=12))
    solids += [s.at(0.66, 0.9, 0.08) for s in fruit_bowl("white")]
    return solids


def wall_cabinet(tones: Tones) -> list[Solid]:
    """Cupboards above a counter."""
    width = 1.8
    solids = [box(lacquer(tones.colour), (width, 0.6, 0.34), (0, 1.5, 0))]
    for index in range(3):
        x = (index + 0.5) * width / 3 - width / 2
        front = (width / 3 - 0.02, 0.56, 0.02)
        solids.append(box(lacquer(tones.colour, light=1.1), front, (x, 1.52, 0.175)))
        solids.append(box(metal(), (0.12, 0.018, 0.02), (x, 1.55, 0.19)))
    return solids


def stove(tones: Tones) -> list[Solid]:
    """A cooker with four rings, oven window and a pot."""
    solids = [
        box(metal(), (0.62, 0.88, 0.6)),
        box(solid((28, 28, 30)), (0.6, 0.02, 0.58), (0, 0.88, 0)),
        box(metal(), (0.46, 0.025, 0.04), (0, 0.72, 0.32)),
        sheet(screen(), (-0.22, 0.28, 0.303), ((0.44, 0, 0), (0, 0.34, 0)), whole=True),
    ]
    for x in (-0.15, 0.15):
        for z in (-0.13, 0.13):
            solids.append(cylinder(metal(dark=True), 0.09, 0.012, (x, 0.9, z), sides=14))
    solids += [cylinder(lacquer("black"), 0.02, 0.03, (x, 0.8, 0.31), sides=8) for x in (-0.2, 0.2)]
    pot = ((0.0, 0.0), (0.1, 0.0), (0.105, 0.13), (0.0, 0.135))
    solids.append(lathe(lacquer(tones.colour), pot).at(-0.15, 0.91, -0.13))
    return [*solids, box(metal(), (0.62, 0.16, 0.03), (0, 0.88, -0.285))]


def refrigerator(tones: Tones) -> list[Solid]:
    """Two doors, one above the other."""
    look = metal() if tones.variant % 2 == 0 else lacquer(tones.colour)
    solids = [cushion(look, (0.72, 1.82, 0.66), (0, 0.02, -0.03), radius=0.03)]
    for y, height in ((0.05, 1.08), (1.16, 0.65)):
        solids.append(cushion(look, (0.71, height, 0.06), (0, y, 0.32), radius=0.025))
        solids.append(
            box(metal(dark=True), (0.025, height * 0.4, 0.035), (-0.29, y + height * 0.3, 0.365))
        )
    return solids


def kitchen_island(tones: Tones) -> list[Solid]:
    """A free-standing block with worktop."""
    solids = [
        box(lacquer("charcoal"), (1.36, 0.1, 0.66)),
        box(lacquer(tones.colour), (1.4, 0.78, 0.7), (0, 0.1, 0)),
        cushion(stone(), (1.6, 0.045, 0.92), (0, 0.88, 0), radius=0.012),
    ]
    for side in (-1, 1):
        for x in (-0.46, 0.0, 0.46):
            panel = (x, 0.16, side * 0.352)
            solids.append(box(lacquer(tones.colour, light=1.12), (0.42, 0.66, 0.015), panel))
    return solids + [s.at(0.3, 0.925, 0.05) for s in fruit_bowl("white")]


def toilet(tones: Tones) -> list[Solid]:
    """Bowl, lid and cistern."""
    white = lacquer("white")
    bowl = ((0.0, 0.0), (0.13, 0.0), (0.11, 0.14), (0.18, 0.34), (0.2, 0.39), (0.0, 0.4))
    solids = [lathe(white, bowl, sides=16).at(0, 0, 0.1)]
    solids.append(cushion(white, (0.2, 0.38, 0.3), (0, 0, -0.1), radius=0.04))
    solids.append(cushion(fabric(tones.colour), (0.39, 0.045, 0.45), (0, 0.4, 0.08), radius=0.02))
    solids.append(cushion(white, (0.4, 0.4, 0.18), (0, 0.38, -0.24), radius=0.03))
    return [*solids, box(metal(), (0.07, 0.015, 0.04), (0, 0.78, -0.24))]


def washbasin(tones: Tones) -> list[Solid]:
    """A vanity unit with basin and tap under a lit mirror."""
    solids = [
        box(lacquer(tones.colour), (0.8, 0.5, 0.45), (0, 0.28, 0)),
        box(lacquer(tones.colour, light=1.12), (0.38, 0.44, 0.02), (-0.2, 0.31, 0.225)),
        box(lacquer(tones.colour, light=1.12), (0.38, 0.44, 0.02), (0.2, 0.31, 0.225)),
        cushion(lacquer("white"), (0.84, 0.1, 0.5), (0, 0.78, 0.01), radius=0.03),
    ]
    basin = ((0.16, 0.0), (0.18, 0.03), (0.17, 0.03), (0.13, 0.005), (0.0, 0.0))
    solids.append(lathe(solid((214, 218, 222)), basin).at(0, 0.88, 0.03))
    solids += [cylinder(metal(), 0.016, 0.16, (0, 0.88, -0.17), sides=8)]
    solids.append(box(metal(), (0.022, 0.02, 0.13), (0, 1.03, -0.11)))
    solids.append(box(metal(), (0.76, 0.82, 0.02), (0, 1.16, -0.22)))
    glass = sheet(mirror(), (-0.36, 1.18, -0.205), ((0.72, 0, 0), (0, 0.78, 0)), whole=True)
    return [*solids, glass, box(lamp_glow(), (0.5, 0.05, 0.06), (0, 2.02, -0.2))]


def bathtub(tones: Tones) -> list[Solid]:
    """A tub with rim, water and tap; a towel over the side."""
    white = lacquer("white")
    solids = [cushion(white, (1.65, 0.52, 0.08), (0, 0, z), radius=0.035) for z in (-0.34, 0.34)]
    solids += [cushion(white, (0.1, 0.52, 0.74), (x, 0, 0), radius=0.04) for x in (-0.78, 0.78)]
    solids.append(box(solid((170, 214, 222)), (1.5, 0.34, 0.62)))
    solids.append(cylinder(metal(), 0.02, 0.2, (-0.76, 0.52, 0), sides=8))
    solids.append(box(metal(), (0.14, 0.025, 0.03), (-0.7, 0.7, 0)))
    towel = fabric(tones.colour)
    solids.append(box(towel, (0.42, 0.02, 0.12), (0.25, 0.52, 0.34)))
    return [*solids, box(towel, (0.42, 0.34, 0.015), (0.25, 0.19, 0.39))]


def washing_machine(tones: Tones) -> list[Solid]:
    """A front loader with a laundry basket on top."""
    solids = [cushion(lacquer("white"), (0.6, 0.85, 0.58), radius=0.02)]
    ring = ((0.0, 0.0), (0.2, 0.0), (0.2, 0.03), (0.0, 0.05))
    solids.append(lathe(metal(), ring, sides=20).tilted(1.5708).at(0, 0.42, 0.28))
    glass = ((0.0, 0.0), (0.15, 0.0), (0.12, 0.03), (0.0, 0.035))
    solids.append(lathe(solid((48, 58, 72)), glass, sides=18).tilted(1.5708).at(0, 0.42, 0.315))
    solids.append(box(solid((206, 210, 214)), (0.56, 0.1, 0.01), (0, 0.73, 0.288)))
    basket = ((0.0, 0.0), (0.18, 0.0), (0.23, 0.22), (0.215, 0.22), (0.17, 0.02), (0.0, 0.02))
    solids.append(lathe(wood("pine"), basket).at(0, 0.85, 0))
    return [*solids, cushion(fabric(tones.colour), (0.3, 0.16, 0.26), (0, 0.92, 0), radius=0.07)]


def towel_rail(tones: Tones) -> list[Solid]:
    """A ladder rail on the wall with a coloured towel."""
    solids = [cylinder(metal(), 0.014, 1.1, (x, 0.6, 0), sides=6) for x in (-0.25, 0.25)]
    solids += [box(metal(), (0.5, 0.02, 0.02), (0, 0.7 + 0.16 * k, 0)) for k in range(6)]
    return [*solids, box(fabric(tones.colour), (0.42, 0.6, 0.035), (0, 0.86, 0.03))]
