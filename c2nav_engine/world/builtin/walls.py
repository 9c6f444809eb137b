"""Walls with their doors, windows, frames and skirting, and banisters."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from c2nav_engine.world.builtin.looks import lacquer, metal, window_view, wood
from c2nav_engine.world.builtin.mesh import Look, Solid, box, sheet
from c2nav_engine.world.builtin.plan import (
    CEILING_M,
    OUTSIDE,
    STAIRS,
    STOREY_M,
    WALL_M,
    Opening,
    Wall,
)

_PATCH_M, _BAND_M = 0.6, 0.54
"""Walls are cut into patches of about this size so that light can vary over them."""
_HALF = WALL_M / 2
_END = _HALF - 0.003
"""Walls reach into those they meet, just short of the far surface, where they would show."""


@dataclass(frozen=True, slots=True)
class Finish:
    """How a wall looks from its two sides.

    Attributes:
        before: Look towards the room of smaller coordinates.
        after: Look towards the other room.
        trim: Look of skirting and frames.
        door: Look of a closed door's leaf.
        seed: Chooses the view from windows.
    """

    before: Look
    after: Look
    trim: Look
    door: Look
    seed: int


def wall_solids(wall: Wall, finish: Finish) -> list[Solid]:
    """Everything that stands on one boundary."""
    if wall.kind == "open":
        return list(_fascia(wall, finish))
    if wall.kind == "railing":
        return list(_railing(wall))
    solids = [*_faces(wall, finish), *_ends(wall, finish)]
    for opening in wall.openings:
        solids += _reveals(wall, opening, finish)
        solids += _casing(wall, opening, finish)
        if opening.kind == "window":
            solids += _window(wall, opening, finish)
        if opening.kind == "front door":
            solids += _leaf(wall, opening, finish)
    return [*solids, *_skirting(wall, finish)]


def _base(wall: Wall) -> float:
    return wall.storey * STOREY_M


def _face(wall: Wall, look: Look, span: tuple[float, float, float, float], *, side: int) -> Solid:
    """A patch of wall surface; side −1 looks towards `before`, +1 towards `after`."""
    low, high, bottom, top = span
    # Looking along +z onto a wall along x, left and right swap between the two sides.
    forward = (side > 0) == (wall.axis == "x")
    start, end = (low, high) if forward else (high, low)
    x, z = wall.point(start, side * _HALF)
    dx, dz = (end - start, 0.0) if wall.axis == "x" else (0.0, end - start)
    parts = (max(1, math.ceil((high - low) / _PATCH_M)), 1)
    corner = (x, _base(wall) + bottom, z)
    sides = ((dx, 0.0, dz), (0.0, top - bottom, 0.0))
    return sheet(look, corner, sides, parts=parts, levels=_levels(bottom, top))


def _faces(wall: Wall, finish: Finish) -> Iterator[Solid]:
    """Both surfaces, around the openings."""
    for side, look, room in ((-1, finish.before, wall.before), (1, finish.after, wall.after)):
        # Stairwells show the edge of the floor above.
        top = STOREY_M if room in {OUTSIDE, STAIRS} else CEILING_M
        for span in _spans(wall, top):
            yield _face(wall, look, span, side=side)


def _levels(bottom: float, top: float) -> list[float]:
    """Shares of a patch's height at heights that all patches share: light runs on between them."""
    cuts = [level * _BAND_M for level in range(math.ceil(STOREY_M / _BAND_M))]
    edges = [bottom, *(cut for cut in cuts if bottom + 0.02 < cut < top - 0.02), top]
    return [(edge - bottom) / (top - bottom) for edge in edges]


def _spans(wall: Wall, top: float) -> Iterator[tuple[float, float, float, float]]:
    """(low, high, bottom, top) of the wall without its openings."""
    at = wall.low - _END
    for opening in sorted(wall.openings, key=lambda each: each.low):
        yield (at, opening.low, 0.0, top)
        if opening.bottom_m > 0.0:
            yield (opening.low, opening.high, 0.0, opening.bottom_m)
        yield (opening.low, opening.high, opening.top_m, top)
        at = opening.high
    yield (at, wall.high + _END, 0.0, top)


def _ends(wall: Wall, finish: Finish) -> Iterator[Solid]:
    """Caps, for walls that end in an open space."""
    rows = math.ceil(CEILING_M / _PATCH_M)
    for at, outward in ((wall.low - _END, -1.0), (wall.high + _END, 1.0)):
        # Facing outward, the picture's right runs along `before` to `after` or back.
        sign = outward if wall.axis == "z" else -outward
        x, z = wall.point(at, -sign * _HALF)
        across = (0.0, 0.0, sign * WALL_M) if wall.axis == "x" else (sign * WALL_M, 0.0, 0.0)
        sides = (across, (0.0, CEILING_M, 0.0))
        yield sheet(finish.before, (x, _base(wall), z), sides, parts=(1, rows))


def _slab(
    wall: Wall, look: Look, span: tuple[float, float, float, float], *, proud_m: float = 0.0
) -> Solid:
    """A box through the wall's whole thickness, standing out by `proud_m` on both sides."""
    low, high, bottom, top = span
    x, z = wall.point((low + high) / 2)
    thick = WALL_M + 2 * proud_m
    along = max(high - low, 1e-4)
    size = (along, top - bottom, thick) if wall.axis == "x" else (thick, top - bottom, along)
    return box(look, size, (x, _base(wall) + bottom, z))


def _fascia(wall: Wall, finish: Finish) -> Iterator[Solid]:
    """The edge of the upper floor over the foot of the stairs."""
    if STAIRS in {wall.before, wall.after} and wall.storey == 0:
        yield _slab(wall, finish.before, (wall.low, wall.high, CEILING_M, STOREY_M))


def _reveals(wall: Wall, opening: Opening, finish: Finish) -> Iterator[Solid]:
    """Lining of an opening: two jambs, head, and a sill under windows."""
    look, thin = finish.trim, 0.02
    low, high, bottom, top = opening.low, opening.high, opening.bottom_m, opening.top_m
    yield _slab(wall, look, (low - thin, low + thin, bottom, top), proud_m=0.004)
    yield _slab(wall, look, (high - thin, high + thin, bottom, top), proud_m=0.004)
    yield _slab(wall, look, (low, high, top - thin, top + thin), proud_m=0.004)
    if bottom > 0.0:
        sill = (low - 0.06, high + 0.06, bottom - 0.04, bottom)
        yield _slab(wall, look, sill, proud_m=0.05)


def _casing(wall: Wall, opening: Opening, finish: Finish) -> Iterator[Solid]:
    """The frame around an opening, a little proud of the wall."""
    wide = 0.05 if opening.kind == "window" else 0.08
    low, high, bottom, top = opening.low, opening.high, opening.bottom_m, opening.top_m
    for outer, inner in ((low - wide, low), (high, high + wide)):
        yield _slab(wall, finish.trim, (outer, inner, bottom, top + wide), proud_m=0.015)
    yield _slab(wall, finish.trim, (low, high, top, top + wide), proud_m=0.015)


def _window(wall: Wall, opening: Opening, finish: Finish) -> Iterator[Solid]:
    """A pane with the view behind it, and glazing bars; the same seen from both sides."""
    look = window_view(finish.seed % 3)
    low, high, bottom, top = opening.low, opening.high, opening.bottom_m, opening.top_m
    for side in (-1, 1):
        forward = (side > 0) == (wall.axis == "x")
        start, end = (low, high) if forward else (high, low)
        x, z = wall.point(start, side * 0.005)
        dx, dz = (end - start, 0.0) if wall.axis == "x" else (0.0, end - start)
        corner = (x, _base(wall) + bottom, z)
        yield sheet(look, corner, ((dx, 0.0, dz), (0.0, top - bottom, 0.0)), whole=True)
    middle, bar = (low + high) / 2, 0.018
    thin = -_HALF + 0.022
    yield _slab(wall, finish.trim, (middle - bar, middle + bar, bottom, top), proud_m=thin)
    if top - bottom > 1.0:
        level = bottom + 0.68 * (top - bottom)
        yield _slab(wall, finish.trim, (low, high, level - bar, level + bar), proud_m=thin)


def _leaf(wall: Wall, opening: Opening, finish: Finish) -> Iterator[Solid]:
    """A closed door with panels and a handle."""
    low, high, top = opening.low, opening.high, opening.top_m
    thin = -_HALF + 0.025
    yield _slab(wall, finish.door, (low, high, 0.0, top), proud_m=thin)
    middle = (low + high) / 2
    for left, right in ((low + 0.1, middle - 0.05), (middle + 0.05, high - 0.1)):
        for bottom, upper in ((0.2, 0.9), (1.1, 1.9)):
            yield _slab(wall, finish.door, (left, right, bottom, upper), proud_m=thin + 0.012)
    yield _slab(wall, metal(), (high - 0.12, high - 0.06, 0.98, 1.04), proud_m=thin + 0.05)


def _skirting(wall: Wall, finish: Finish) -> Iterator[Solid]:
    """Boards along the floor, left out at doors and outside."""
    at = wall.low + _HALF
    passages = [each for each in wall.openings if each.bottom_m == 0.0]
    edges = [(each.low - 0.08, each.high + 0.08) for each in sorted(passages, key=lambda o: o.low)]
    for stop, start in [*edges, (wall.high - _HALF, 0.0)]:
        if stop > at + 0.01:
            for side, room in ((-1, wall.before), (1, wall.after)):
                if room != OUTSIDE:
                    yield _board(wall, finish.trim, (at, stop), side=side)
        at = start


def _board(wall: Wall, look: Look, run: tuple[float, float], *, side: int) -> Solid:
    low, high = run
    x, z = wall.point((low + high) / 2, side * (_HALF + 0.006))
    size = (high - low, 0.09, 0.012) if wall.axis == "x" else (0.012, 0.09, high - low)
    return box(look, size, (x, _base(wall), z))


def _railing(wall: Wall) -> Iterator[Solid]:
    """A level banister with spindles."""
    timber, white = wood("walnut"), lacquer("white")
    low, high = wall.low, wall.high
    count = max(2, round((high - low) / 0.16))
    for index in range(count + 1):
        x, z = wall.point(low + (high - low) * index / count)
        post = index in {0, count}
        wide = 0.09 if post else 0.032
        yield box(
            timber if post else white, (wide, 1.0 if post else 0.92, wide), (x, _base(wall), z)
        )
    x, z = wall.point((low + high) / 2)
    size = (high - low, 0.06, 0.07) if wall.axis == "x" else (0.07, 0.06, high - low)
    yield box(timber, size, (x, _base(wall) + 0.92, z))
