"""Cupboards, shelves and chests."""

from __future__ import annotations

from c2nav_engine.world.builtin.furniture.model import Tones, mirrored
from c2nav_engine.world.builtin.furniture.tables import vase_of_flowers
from c2nav_engine.world.builtin.looks import books, fabric, lacquer, metal, screen, wood
from c2nav_engine.world.builtin.mesh import Look, Solid, box, cushion, cylinder, lathe, sheet


def _fronts(look: Look, grid: tuple[int, int], size: tuple[float, float, float]) -> list[Solid]:
    """Drawer or door fronts with handles before a body of (width, height, depth), from y = 0.06."""
    columns, rows = grid
    width, height, depth = size
    solids: list[Solid] = []
    for column in range(columns):
        for row in range(rows):
            x = (column + 0.5) * width / columns - width / 2
            y = 0.06 + row * (height - 0.08) / rows
            each = (width / columns - 0.03, (height - 0.08) / rows - 0.025, 0.02)
            solids.append(box(look, each, (x, y, depth / 2 + 0.005)))
            knob = (x, y + each[1] / 2, depth / 2 + 0.025)
            solids.append(box(metal(), (min(0.12, each[0] / 3), 0.018, 0.02), knob))
    return solids


def wardrobe(tones: Tones) -> list[Solid]:
    """Two tall doors with upright handles."""
    timber = wood(tones.wood)
    front = lacquer(tones.colour) if tones.variant % 2 else wood("birch")
    solids = [box(timber, (1.3, 2.05, 0.6))]
    for side in (-1, 1):
        solids.append(box(front, (0.6, 1.9, 0.025), (side * 0.315, 0.08, 0.305)))
        solids.append(box(metal(), (0.02, 0.3, 0.03), (side * 0.06, 0.95, 0.33)))
    return [*solids, cushion(timber, (1.36, 0.06, 0.64), (0, 2.05, 0), radius=0.02)]


def dresser(tones: Tones) -> list[Solid]:
    """Six coloured drawers, flowers on top."""
    solids = [box(wood(tones.wood), (1.2, 0.86, 0.46))]
    solids.append(cushion(wood(tones.wood), (1.26, 0.035, 0.5), (0, 0.86, 0), radius=0.012))
    solids += _fronts(lacquer(tones.colour), (2, 3), (1.2, 0.86, 0.46))
    return solids + [solid.at(-0.35, 0.895, 0) for solid in vase_of_flowers(tones.colour)]


def sideboard(tones: Tones) -> list[Solid]:
    """Long and low on legs, with coloured doors."""
    timber = wood(tones.wood)
    solids = [box(timber, (1.5, 0.55, 0.42), (0, 0.18, 0))]
    solids += [
        solid.at(0, 0.14, 0) for solid in _fronts(lacquer(tones.colour), (3, 1), (1.5, 0.55, 0.42))
    ]
    solids += [box(timber, (0.05, 0.18, 0.05), (x, 0, z)) for x, z in mirrored(0.68, 0.16)]
    return solids + [solid.at(0.45, 0.73, 0) for solid in vase_of_flowers(tones.colour)]


def bookshelf(tones: Tones) -> list[Solid]:
    """Five shelves full of books, open to the front."""
    timber = wood(tones.wood)
    width, height, depth = 1.0, 1.95, 0.32
    solids = [box(timber, (0.03, height, depth), (side * (width / 2), 0, 0)) for side in (-1, 1)]
    solids.append(box(timber, (width, height, 0.02), (0, 0, -depth / 2 + 0.01)))
    levels = [0.06 + 0.375 * level for level in range(6)]
    solids += [box(timber, (width, 0.03, depth), (0, level - 0.03, 0)) for level in levels]
    for index, level in enumerate(levels[:-1]):
        row = books(10 * (tones.variant % 4) + index)
        spines = sheet(row, (-0.47, 0, 0), ((0.94, 0, 0), (0, 0.33, 0)), whole=True)
        solids.append(spines.at(0, level, depth / 2 - 0.06))
        solids.append(box(wood(tones.wood), (0.94, 0.26, 0.2), (0, level, -0.03)))
    ornament = ((0.0, 0.0), (0.06, 0.0), (0.09, 0.08), (0.04, 0.18), (0.05, 0.2), (0.0, 0.19))
    return [*solids, lathe(lacquer(tones.colour), ornament, sides=12).at(0.3, height, 0)]


def chest(tones: Tones) -> list[Solid]:
    """A trunk in a strong colour with iron bands and a domed lid."""
    body = lacquer(tones.colour)
    solids = [
        box(body, (0.95, 0.36, 0.5)),
        cushion(body, (0.97, 0.2, 0.52), (0, 0.36, 0), radius=0.09),
    ]
    for x in (-0.36, 0.36):
        solids.append(box(metal(dark=True), (0.06, 0.365, 0.515), (x, 0, 0)))
        solids.append(cushion(metal(dark=True), (0.06, 0.205, 0.53), (x, 0.36, 0), radius=0.09))
    return [*solids, box(metal(), (0.1, 0.12, 0.03), (0, 0.31, 0.255))]


def tv_stand(tones: Tones) -> list[Solid]:
    """A low board with a television."""
    timber = wood(tones.wood)
    solids = [box(timber, (1.6, 0.38, 0.42), (0, 0.1, 0))]
    solids += [
        solid.at(0, 0.06, 0) for solid in _fronts(lacquer(tones.colour), (3, 1), (1.6, 0.38, 0.42))
    ]
    solids += [box(timber, (0.06, 0.1, 0.06), (x, 0, z)) for x, z in mirrored(0.7, 0.15)]
    solids.append(box(metal(dark=True), (0.4, 0.02, 0.22), (0, 0.48, 0)))
    solids.append(box(metal(dark=True), (0.06, 0.1, 0.04), (0, 0.5, -0.02)))
    solids.append(box(metal(dark=True), (1.24, 0.72, 0.05), (0, 0.56, 0)))
    panel = sheet(screen(), (-0.6, 0.58, 0.027), ((1.2, 0, 0), (0, 0.68, 0)), whole=True)
    return [*solids, panel]


def coat_rack(tones: Tones) -> list[Solid]:
    """A stand with a coloured coat and a hat."""
    timber = wood(tones.wood)
    solids = [cylinder(timber, 0.022, 1.7, sides=8), cylinder(timber, 0.19, 0.03, sides=14)]
    for turn in range(4):
        solids.append(
            box(timber, (0.02, 0.02, 0.16), (0, 1.55, 0.08)).tilted(0.0).turned(turn * 1.571)
        )
    coat = ((0.06, 0.0), (0.17, 0.04), (0.15, 0.5), (0.12, 0.8), (0.04, 0.88), (0.0, 0.88))
    solids.append(lathe(fabric(tones.colour), coat, sides=10).at(0.1, 0.68, 0.03))
    hat = ((0.0, 0.0), (0.15, 0.0), (0.15, 0.015), (0.085, 0.02), (0.075, 0.1), (0.0, 0.11))
    return [*solids, lathe(fabric("charcoal"), hat, sides=14).at(0, 1.7, 0)]


def toy_shelf(tones: Tones) -> list[Solid]:
    """Open cubes with coloured boxes."""
    timber = wood("birch")
    solids = [box(timber, (1.1, 0.02, 0.34), (0, 0.37 * level, 0)) for level in range(3)]
    solids += [
        box(timber, (0.02, 0.76, 0.34), (-0.55 + 0.366 * column, 0, 0)) for column in range(4)
    ]
    solids.append(box(timber, (1.1, 0.76, 0.01), (0, 0, -0.165)))
    others = (tones.colour, "cream", "grey")
    for column in range(3):
        for row in range(2):
            each = lacquer(others[(column + row) % 3])
            solids.append(
                box(each, (0.3, 0.24, 0.28), (-0.367 + 0.366 * column, 0.02 + 0.37 * row, 0.01))
            )
    return solids
