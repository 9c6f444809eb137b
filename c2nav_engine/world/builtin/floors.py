"""Floors, ceilings and stairs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from c2nav_engine.errors import InternalError
from c2nav_engine.world.builtin.looks import lacquer, lamp_glow, trim, wood
from c2nav_engine.world.builtin.mesh import Look, Solid, box, cylinder, sheet
from c2nav_engine.world.builtin.plan import (
    CEILING_M,
    STAIRS,
    STOREY_M,
    WALL_M,
    Layout,
    Rect,
    Room,
    Wall,
)

_PATCH_M = 0.4
RISERS = 17
"""Steps of a flight: 17 × 0.171 m."""


def _level(
    look: Look, rect: Rect, y: float, *, patch_m: float = _PATCH_M, up: bool = True
) -> Solid:
    """A horizontal rectangle that faces up or down."""
    width, depth = rect.x1 - rect.x0, rect.z1 - rect.z0
    parts = (max(1, math.ceil(width / patch_m)), max(1, math.ceil(depth / patch_m)))
    if up:
        return sheet(look, (rect.x0, y, rect.z1), ((width, 0, 0), (0, 0, -depth)), parts=parts)
    return sheet(look, (rect.x0, y, rect.z0), ((width, 0, 0), (0, 0, depth)), parts=parts)


def floor_solids(room: Room, look: Look) -> list[Solid]:
    """The floor of a room; the upper stairwell has none."""
    if room.letter == STAIRS and room.storey > 0:
        return []
    return [_level(look, rect, room.floor_m) for rect in room.rects]


def ceiling_solids(room: Room, look: Look, *, under_hole: bool) -> list[Solid]:
    """The ceiling of a room, left out where the stairs go through it."""
    if under_hole:
        return []
    y = room.floor_m + CEILING_M
    solids = [_level(look, rect, y, patch_m=1.2, up=False) for rect in room.rects]
    for rect in room.rects:
        if min(rect.x1 - rect.x0, rect.z1 - rect.z0) > 1.1:
            x, z = rect.centre
            solids.append(cylinder(lacquer("white"), 0.2, 0.05, (x, y - 0.05, z), sides=18))
            solids.append(cylinder(lamp_glow(), 0.16, 0.03, (x, y - 0.075, z), sides=18))
    return solids


@dataclass(frozen=True, slots=True)
class Flight:
    """A straight flight of stairs through the stairwell.

    Attributes:
        rect: The stairwell.
        foot: Boundary at its lower end.
        top: Boundary at its upper end.
    """

    rect: Rect
    foot: Wall
    top: Wall


def flight_of(layout: Layout) -> Flight | None:
    """The stairs of a house with two storeys, from its open ends; None for one storey."""
    if len(layout.plan.storeys) == 1:
        return None
    ends = [
        next(
            (
                w
                for w in layout.walls
                if w.storey == k and w.kind == "open" and STAIRS in {w.before, w.after}
            ),
            None,
        )
        for k in (0, 1)
    ]
    foot, top = ends
    if foot is None or top is None or foot.axis != top.axis:
        message = f"house {layout.plan.name}: expected stairs open at opposite ends"
        raise InternalError(message)
    return Flight(layout.room(STAIRS, 0).rects[0], foot, top)


def stair_solids(flight: Flight, look: Look) -> Iterator[Solid]:
    """Treads with risers, solid down to the floor."""
    rect, along_x = flight.rect, flight.foot.axis == "z"
    treads = RISERS - 1
    start, end = flight.foot.line, flight.top.line
    run, rise = (end - start) / treads, STOREY_M / RISERS
    across = (rect.z1 - rect.z0 if along_x else rect.x1 - rect.x0) - WALL_M + 0.004
    x, z = rect.centre
    for index in range(treads):
        middle = start + run * (index + 0.5)
        height = rise * (index + 1)
        centre = (middle, 0.0, z) if along_x else (x, 0.0, middle)
        size = (abs(run), height - 0.035, across) if along_x else (across, height - 0.035, abs(run))
        yield box(trim(), size, centre)
        deep = abs(run) + 0.025
        tread = (deep, 0.035, across) if along_x else (across, 0.035, deep)
        # The nosing stands out towards the foot, as real treads do.
        nose = -0.0125 * math.copysign(1.0, run)
        shifted = (
            (middle + nose, height - 0.035, z) if along_x else (x, height - 0.035, middle + nose)
        )
        yield box(look, tread, shifted)
    yield from _handrail(flight, rise / abs(run))


def _handrail(flight: Flight, slope: float) -> Iterator[Solid]:
    """A rail along one side of the flight."""
    rect, along_x = flight.rect, flight.foot.axis == "z"
    start, end = flight.foot.line, flight.top.line
    length = 0.96 * math.hypot(end - start, slope * (end - start))
    pitch = math.atan(slope)
    x, z = rect.centre
    rail = box(wood("walnut"), (length, 0.05, 0.05)).leaned(pitch if end > start else -pitch)
    if not along_x:
        rail = rail.turned(-math.pi / 2)
    aside = (rect.z1 - rect.z0 if along_x else rect.x1 - rect.x0) / 2 - WALL_M / 2 - 0.05
    y = STOREY_M / 2 + 0.92
    yield rail.at(x, y, z + aside) if along_x else rail.at(x + aside, y, z)
