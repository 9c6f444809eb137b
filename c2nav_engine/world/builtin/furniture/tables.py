"""Tables, desks and what stands on them."""

from __future__ import annotations

from c2nav_engine.world.builtin.furniture.model import Tones, mirrored
from c2nav_engine.world.builtin.looks import fabric, lacquer, lamp_glow, leaves, metal, screen, wood
from c2nav_engine.world.builtin.mesh import Solid, box, cushion, cylinder, lathe, sheet


def _table(tones: Tones, size: tuple[float, float, float], *, leg: float = 0.07) -> list[Solid]:
    width, height, depth = size
    timber = wood(tones.wood)
    corners = mirrored(width / 2 - leg, depth / 2 - leg)
    solids = [cushion(timber, (width, 0.045, depth), (0, height - 0.045, 0), radius=0.015)]
    solids += [box(timber, (leg, height - 0.04, leg), (x, 0, z)) for x, z in corners]
    for side in (-1, 1):
        solids.append(
            box(
                timber,
                (width - 2 * leg, 0.08, 0.025),
                (0, height - 0.125, side * (depth / 2 - leg)),
            )
        )
        solids.append(
            box(
                timber,
                (0.025, 0.08, depth - 2 * leg),
                (side * (width / 2 - leg), height - 0.125, 0),
            )
        )
    return solids


def fruit_bowl(colour: str) -> list[Solid]:
    """A bowl with three fruits, on the origin."""
    profile = ((0.0, 0.0), (0.06, 0.0), (0.12, 0.04), (0.15, 0.09), (0.14, 0.09), (0.0, 0.04))
    solids = [lathe(lacquer(colour), profile, sides=14)]
    for x, z, fruit in ((-0.05, 0.02, "red"), (0.05, 0.04, "orange"), (0.01, -0.05, "green")):
        ball = ((0.0, 0.0), (0.035, 0.015), (0.042, 0.04), (0.03, 0.07), (0.0, 0.08))
        solids.append(lathe(lacquer(fruit), ball, sides=8).at(x, 0.045, z))
    return solids


def dining_table(tones: Tones) -> list[Solid]:
    """Seats six; a runner and a bowl on top."""
    solids = _table(tones, (1.7, 0.75, 0.9), leg=0.08)
    solids.append(box(fabric(tones.colour), (1.1, 0.006, 0.34), (0, 0.75, 0)))
    return solids + [solid.at(0, 0.756, 0) for solid in fruit_bowl("white")]


def round_table(tones: Tones) -> list[Solid]:
    """Seats four; on a single turned foot."""
    timber = wood(tones.wood)
    foot = ((0.0, 0.0), (0.3, 0.0), (0.28, 0.04), (0.07, 0.1), (0.05, 0.4), (0.08, 0.7), (0.0, 0.7))
    top = ((0.0, 0.7), (0.54, 0.7), (0.56, 0.72), (0.54, 0.745), (0.0, 0.75))
    cloth = ((0.0, 0.751), (0.3, 0.751), (0.3, 0.756), (0.0, 0.757))
    solids = [lathe(timber, foot), lathe(timber, top, sides=24), lathe(fabric(tones.colour), cloth)]
    return solids + [solid.at(0, 0.757, 0) for solid in fruit_bowl("cream")]


def coffee_table(tones: Tones) -> list[Solid]:
    """Low, with a shelf; a magazine and a mug on top."""
    solids = _table(tones, (1.05, 0.42, 0.58), leg=0.05)
    solids.append(box(wood(tones.wood), (0.92, 0.025, 0.46), (0, 0.12, 0)))
    solids.append(box(lacquer(tones.colour), (0.22, 0.012, 0.28), (-0.2, 0.42, 0.03)).turned(0.1))
    return [*solids, cylinder(lacquer("white"), 0.04, 0.09, (0.22, 0.42, -0.05), sides=10)]


def side_table(tones: Tones) -> list[Solid]:
    """Round and small, with a stack of books."""
    timber = wood(tones.wood)
    solids = [
        cylinder(timber, 0.24, 0.03, (0, 0.52, 0), sides=18),
        cylinder(timber, 0.025, 0.52, sides=8),
        cylinder(timber, 0.16, 0.025, sides=14),
    ]
    for index, colour in enumerate((tones.colour, "cream", "navy")):
        solids.append(
            box(lacquer(colour), (0.2, 0.03, 0.14), (0, 0.55 + 0.03 * index, 0)).turned(index)
        )
    return solids


def console_table(tones: Tones) -> list[Solid]:
    """Shallow, for corridors; a bowl and a lamp stand on it."""
    solids = _table(tones, (1.0, 0.8, 0.32), leg=0.045)
    solids += [solid.at(-0.3, 0.8, 0) for solid in fruit_bowl(tones.colour)]
    return solids + [solid.at(0.3, 0.8, 0) for solid in small_lamp(tones.colour)]


def small_lamp(colour: str) -> list[Solid]:
    """A table lamp on the origin."""
    foot = ((0.0, 0.0), (0.07, 0.0), (0.08, 0.05), (0.03, 0.14), (0.015, 0.24), (0.0, 0.24))
    shade = ((0.13, 0.2), (0.085, 0.4), (0.08, 0.4), (0.125, 0.2))
    bulb = ((0.0, 0.24), (0.03, 0.27), (0.0, 0.32))
    return [
        lathe(lacquer("cream"), foot, sides=12),
        lathe(fabric(colour, light=1.15), shade),
        lathe(lamp_glow(), bulb, sides=8),
    ]


def desk(tones: Tones) -> list[Solid]:
    """A writing desk with drawers, laptop, lamp and a pot of pens."""
    timber = wood(tones.wood)
    solids = _table(tones, (1.35, 0.74, 0.65), leg=0.05)
    solids.append(box(timber, (0.4, 0.5, 0.52), (0.42, 0.2, 0)))
    for level in range(3):
        solids.append(box(wood("birch"), (0.36, 0.14, 0.02), (0.42, 0.22 + 0.16 * level, 0.265)))
    solids.append(box(metal(), (0.34, 0.015, 0.24), (-0.1, 0.74, 0.05)))
    lid = sheet(screen(), (-0.17, 0.0, 0.0), ((0.34, 0, 0), (0, 0.22, -0.05)), whole=True)
    solids += [lid.at(-0.1, 0.755, -0.07), box(metal(), (0.34, 0.22, 0.012), (-0.1, 0.755, -0.13))]
    solids.append(cylinder(lacquer(tones.colour), 0.04, 0.1, (0.28, 0.74, -0.15), sides=10))
    return solids + [solid.at(-0.52, 0.74, -0.15) for solid in small_lamp(tones.colour)]


def nightstand(tones: Tones) -> list[Solid]:
    """Two drawers under a lamp."""
    timber = wood(tones.wood)
    solids = [cushion(timber, (0.45, 0.5, 0.4), (0, 0.05, 0), radius=0.015)]
    solids += [box(wood("birch"), (0.39, 0.18, 0.02), (0, 0.1 + 0.21 * k, 0.2)) for k in (0, 1)]
    solids += [box(metal(), (0.1, 0.015, 0.02), (0, 0.18 + 0.21 * k, 0.22)) for k in (0, 1)]
    solids += [box(timber, (0.04, 0.06, 0.04), (x, 0, z)) for x, z in mirrored(0.18, 0.15)]
    return solids + [solid.at(0, 0.55, 0) for solid in small_lamp(tones.colour)]


def vase_of_flowers(colour: str) -> list[Solid]:
    """A small vase with a few blossoms, on the origin."""
    profile = ((0.0, 0.0), (0.05, 0.0), (0.07, 0.07), (0.03, 0.16), (0.04, 0.19), (0.0, 0.17))
    solids = [lathe(lacquer("white"), profile, sides=12)]
    bloom = ((0.0, 0.0), (0.035, 0.02), (0.03, 0.05), (0.0, 0.055))
    for x, z, height in ((-0.05, 0.0, 0.3), (0.05, 0.02, 0.33), (0.0, -0.04, 0.37)):
        solids.append(cylinder(leaves(0.8), 0.005, height - 0.15, (x / 2, 0.16, z / 2), sides=5))
        solids.append(lathe(lacquer(colour), bloom, sides=8).at(x, height, z))
    return solids
