"""How rooms are finished: floors, walls and trim by the kind of room."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial

import numpy as np

from c2nav_engine.world.builtin import textures
from c2nav_engine.world.builtin.looks import look_of
from c2nav_engine.world.builtin.mesh import Look
from c2nav_engine.world.builtin.palette import COLOURS, WALLS, WOODS, mix, shade
from c2nav_engine.world.builtin.plan import Room
from c2nav_engine.world.scene import Material


@dataclass(frozen=True, slots=True)
class Finishes:
    """Looks of one room.

    Attributes:
        floor: Of its floor.
        wall: Of its walls.
        feature: Of one wall that differs.
    """

    floor: Look
    wall: Look
    feature: Look


@cache
def _plain_wall(name: str) -> Look:
    return look_of(f"{name} wall", textures.plaster(WALLS[name]), tile_m=2.0)


@cache
def _boards(name: str) -> Look:
    return look_of(f"{name} boards", textures.planks(WOODS[name]), tile_m=1.6)


@cache
def _parquet(name: str) -> Look:
    return look_of(f"{name} parquet", textures.herringbone(WOODS[name]), tile_m=1.2)


@cache
def _carpet(name: str) -> Look:
    rgb = mix(COLOURS[name], (200, 192, 182), 0.45)
    return look_of(f"{name} carpet", textures.carpet(rgb), tile_m=0.7)


@cache
def _tiled(name: str, count: int) -> Look:
    return look_of(f"{name} tiles", textures.tiles(COLOURS[name], count=count), tile_m=1.4)


@cache
def _chequered(name: str) -> Look:
    picture = textures.tiles(COLOURS["cream"], count=4, second=COLOURS[name])
    return look_of(f"{name} chequered tiles", picture, tile_m=1.6)


@cache
def _striped(name: str) -> Look:
    base = WALLS[name]
    return look_of(f"{name} stripes", textures.stripes(base, shade(base, 0.87)), tile_m=1.0)


@cache
def _dotted(name: str) -> Look:
    base = WALLS[name]
    return look_of(f"{name} dots", textures.dots(shade(base, 0.9), shade(base, 1.08)), tile_m=0.8)


@cache
def _bricks() -> Look:
    return look_of("brick wall", textures.brick((172, 96, 76)), tile_m=1.1)


@cache
def outside_look(name: str) -> Look:
    """Look of the outer walls by the plan's word."""
    if name == "brick":
        return _bricks()
    if name == "boards":
        return look_of("painted boards", textures.planks((188, 204, 208)), tile_m=0.9)
    return look_of("render", textures.plaster((224, 216, 202)), tile_m=2.0)


@cache
def ceiling() -> Look:
    """White paint."""
    picture = textures.plain((238, 236, 230))
    # Light from above never reaches a ceiling: it shows its paint as it is.
    return Look(Material("ceiling", texture=picture, unlit=True), tile_m=2.0)


_Choice = Callable[[], Look]


def _of(maker: Callable[[str], Look], *names: str) -> tuple[_Choice, ...]:
    return tuple(partial(maker, name) for name in names)


def _tiles(count: int, *names: str) -> tuple[_Choice, ...]:
    return tuple(partial(_tiled, name, count) for name in names)


_WET_WALLS = _tiles(8, "mint", "white", "beige")
_FLOORS: dict[str, tuple[_Choice, ...]] = {
    "bedroom": _of(_carpet, "beige", "lavender", "sage", "blue", "plum"),
    "guest room": _of(_carpet, "ochre", "grey", "pink", "teal"),
    "children's room": _of(_carpet, "turquoise", "coral", "green"),
    "playroom": _of(_carpet, "mustard", "blue"),
    "kitchen": (*_of(_chequered, "charcoal", "teal", "maroon"), *_tiles(4, "beige")),
    "small kitchen": _of(_chequered, "navy", "olive"),
    "bathroom": _tiles(6, "grey", "cream", "sage"),
    "laundry room": _tiles(4, "grey"),
    "storage room": _tiles(3, "beige"),
    "library": _of(_parquet, "walnut", "cherry"),
    "music room": _of(_parquet, "oak", "cherry"),
    "dining room": (*_of(_parquet, "oak", "walnut"), *_of(_boards, "cherry")),
    "entrance hall": (*_tiles(3, "cream"), *_of(_chequered, "charcoal")),
}
_OTHER_FLOORS = _of(_boards, "oak", "pine", "walnut", "birch")
_PAPERS: dict[str, tuple[_Choice, ...]] = {
    "bedroom": _of(_dotted, "lilac", "duck egg", "blush", "moss"),
    "guest room": _of(_striped, "butter", "duck egg", "blush"),
    "children's room": _of(_striped, "butter", "denim", "lilac"),
    "living room": (_bricks, *_of(_striped, "moss", "slate"), *_of(_plain_wall, "terracotta")),
    "dining room": _of(_striped, "terracotta", "sage", "denim"),
    "library": _of(_plain_wall, "moss", "denim"),
    "study": _of(_plain_wall, "slate", "terracotta", "denim"),
}
"""Finishes of the one wall of a room that may differ from the others."""


def finishes(room: Room, random: np.random.Generator, taken: set[str]) -> Finishes:
    """Looks of one room.

    Args:
        room: The room.
        random: Its generator.
        taken: Wall paints that the house has used; the one chosen is added.
    """
    floors = _FLOORS.get(room.kind, _OTHER_FLOORS)
    floor = floors[int(random.integers(len(floors)))]()
    if room.kind == "bathroom":
        wall = _WET_WALLS[int(random.integers(len(_WET_WALLS)))]()
        return Finishes(floor, wall, wall)
    free = [name for name in WALLS if name not in taken] or list(WALLS)
    name = free[int(random.integers(len(free)))]
    taken.add(name)
    wall = _plain_wall(name)
    papers = _PAPERS.get(room.kind)
    feature = papers[int(random.integers(len(papers)))]() if papers else wall
    return Finishes(floor, wall, feature)
