"""A built house: its plan with coordinates, its things and its scene."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from c2nav_engine.world.builtin import style
from c2nav_engine.world.builtin.colours import Colours
from c2nav_engine.world.builtin.floors import (
    ceiling_solids,
    flight_of,
    floor_solids,
    stair_solids,
)
from c2nav_engine.world.builtin.furniture.catalogue import model
from c2nav_engine.world.builtin.light import baked
from c2nav_engine.world.builtin.looks import lacquer, trim, wood
from c2nav_engine.world.builtin.mesh import Look, Solid, projected_uvs, turn_about_y
from c2nav_engine.world.builtin.placement import Item, furnish
from c2nav_engine.world.builtin.plan import OUTSIDE, STAIRS, Layout, Plan, Room, Wall
from c2nav_engine.world.builtin.resolve import resolve
from c2nav_engine.world.builtin.walls import Finish, wall_solids
from c2nav_engine.world.builtin.windows import add_windows
from c2nav_engine.world.scene import Piece, Scene, scene_of

LICENCE = "Apache-2.0, generated with this package"


@dataclass(frozen=True, slots=True)
class House:
    """Everything known about a built-in house.

    Attributes:
        layout: Rooms, walls, openings.
        items: Things in their places.
    """

    layout: Layout
    items: tuple[Item, ...]


@dataclass(frozen=True, slots=True)
class _Named:
    """Solids of one look under one name, on their way into the scene."""

    name: str
    look: Look
    vertices_m: np.ndarray
    triangles: np.ndarray
    uvs: np.ndarray


def house_of(plan: Plan) -> House:
    """Furnish a plan; the same plan always gives the same house."""
    layout = resolve(plan)
    add_windows(layout)
    colours = Colours(plan.seed)
    items = [item for room in layout.rooms for item in furnish(layout, room, colours)]
    return House(layout, tuple(items))


def scene_of_house(house: House) -> Scene:
    """The textured, lit mesh of a house, parts named "room/thing"."""
    named = list(_all_named(house))
    starts = np.cumsum([0, *(len(each.vertices_m) for each in named[:-1])])
    vertices_m = np.concatenate([each.vertices_m for each in named])
    triangles = np.concatenate(
        [each.triangles + start for each, start in zip(named, starts, strict=True)]
    )
    sizes = [len(each.triangles) for each in named]
    glow = np.repeat([each.look.glow for each in named], sizes)
    casts = np.repeat([not each.look.thin for each in named], sizes)
    colours = baked(vertices_m, triangles, glow, casts)
    pieces = [
        Piece(
            name=each.name,
            material=each.look.material,
            vertices_m=each.vertices_m.astype(np.float32),
            triangles=each.triangles.astype(np.int32),
            uvs=each.uvs.astype(np.float32),
            colours=_unless_glowing(each.look, colours[start : start + len(each.vertices_m)]),
        )
        for each, start in zip(named, starts, strict=True)
    ]
    return scene_of(f"builtin/{house.layout.plan.name}", pieces, licence=LICENCE)


def _unless_glowing(look: Look, colours: np.ndarray) -> np.ndarray:
    return np.full_like(colours, 255) if look.glow or look.thin else colours


def _all_named(house: House) -> Iterator[_Named]:
    layout = house.layout
    random = np.random.default_rng((layout.plan.seed, 1))
    taken: set[str] = set()
    looks = {
        (room.letter, room.storey): style.finishes(room, random, taken) for room in layout.rooms
    }
    for room in layout.rooms:
        own = looks[room.letter, room.storey]
        hole = room.letter == STAIRS and room.storey == 0
        yield from _merged(f"floor/{room.name}", floor_solids(room, own.floor))
        ceiling = ceiling_solids(room, style.ceiling(), under_hole=hole)
        yield from _merged(f"ceiling/{room.name}", ceiling)
    flight = flight_of(layout)
    if flight is not None:
        yield from _merged("stairs", stair_solids(flight, wood("oak")))
    features = {room.letter: _feature_wall(layout, room) for room in layout.rooms}
    for wall in layout.walls:
        sides = [
            _side_look(layout, wall, room, (looks, features)) for room in (wall.before, wall.after)
        ]
        front = lacquer(("maroon", "teal", "navy", "green", "plum")[layout.plan.seed % 5])
        finish = Finish(sides[0], sides[1], trim(), front, layout.plan.seed)
        name = layout.room(wall.other(OUTSIDE), wall.storey).name
        kind = "banister" if wall.kind == "railing" else "wall"
        yield from _merged(f"{kind}/{name}", wall_solids(wall, finish))
    for item in house.items:
        yield from _item_named(layout, item)


def _feature_wall(layout: Layout, room: Room) -> Wall | None:
    """The longest closed wall of a room."""
    own = [
        wall
        for wall in layout.walls
        if room.letter in {wall.before, wall.after}
        and wall.storey == room.storey
        and not any(opening.bottom_m == 0.0 for opening in wall.openings)
        and wall.kind == "wall"
    ]
    return max(own, key=lambda wall: wall.high - wall.low, default=None)


def _side_look(
    layout: Layout,
    wall: Wall,
    room: str,
    choices: tuple[dict[tuple[str, int], style.Finishes], dict[str, Wall | None]],
) -> Look:
    looks, features = choices
    if room == OUTSIDE:
        return style.outside_look(layout.plan.outside)
    own = looks[room, wall.storey]
    return own.feature if features[room] is wall else own.wall


def _merged(name: str, solids: Iterable[Solid]) -> Iterator[_Named]:
    """One mesh per look, in the order in which looks first appear."""
    by_look: dict[int, list[Solid]] = {}
    for solid in solids:
        by_look.setdefault(id(solid.look), []).append(solid)
    for group in by_look.values():
        look = group[0].look
        starts = np.cumsum([0, *(len(solid.vertices_m) for solid in group[:-1])])
        uvs = [
            projected_uvs(solid.vertices_m, solid.triangles, look.tile_m)
            if solid.uvs is None
            else solid.uvs
            for solid in group
        ]
        yield _Named(
            name,
            look,
            np.concatenate([solid.vertices_m for solid in group]),
            np.concatenate(
                [solid.triangles + start for solid, start in zip(group, starts, strict=True)]
            ),
            np.concatenate(uvs),
        )


def _item_named(layout: Layout, item: Item) -> Iterator[_Named]:
    """A thing's meshes, moved to its place."""
    room = layout.room(item.room)
    rotation = turn_about_y(item.yaw_rad)
    offset = np.array((item.x, room.floor_m, item.z))
    for each in _merged(f"{room.name}/{item.phrase}", model(item.kind, item.tones).solids):
        moved = each.vertices_m @ rotation.T + offset
        yield _Named(each.name, each.look, moved, each.triangles, each.uvs)
