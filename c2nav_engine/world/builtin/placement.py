"""Furnishing: every wish of a room finds a place, or is left out.

Nothing stands before a door or a window it would cover, and whatever is placed leaves wide ways
between all doors of the room.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from c2nav_engine.world.builtin.colours import Colours
from c2nav_engine.world.builtin.freedom import Freedom
from c2nav_engine.world.builtin.furniture.catalogue import FLAT, HUNG, PHRASES, model
from c2nav_engine.world.builtin.furniture.model import Model, Tones
from c2nav_engine.world.builtin.groups import GROUPS, Member
from c2nav_engine.world.builtin.plan import WALL_M, Layout, Rect, Room, Wall
from c2nav_engine.world.builtin.recipes import RECIPES, Spot, Wish

_AWAY_M = WALL_M / 2 + 0.02
"""From a wall's middle to what stands against it: half its thickness and the skirting."""
_BEFORE_DOORS_M = 0.95
_TRIES = 40


@dataclass(frozen=True, slots=True)
class Item:
    """A thing in its place.

    Attributes:
        kind: Noun of the catalogue.
        tones: Its colours.
        room: Letter of its room.
        x: Centre.
        z: Centre.
        yaw_rad: Turn of its front from +z to the left.
        rect: Footprint.
        bottom_m: Lowest point above the floor.
        top_m: Highest point above the floor.
    """

    kind: str
    tones: Tones
    room: str
    x: float
    z: float
    yaw_rad: float
    rect: Rect
    bottom_m: float
    top_m: float

    @property
    def phrase(self) -> str:
        """What an instruction calls it: with its colour where that is how one knows it."""
        return PHRASES.get(self.kind, self.kind).format(colour=self.tones.colour)

    @property
    def solid(self) -> bool:
        """Whether it takes up floor."""
        return self.kind not in FLAT and self.kind not in HUNG

    def clashes(self, other: Item) -> bool:
        """Whether both take up the same space."""
        flat = (self.kind in FLAT) + (other.kind in FLAT)
        if flat == 1:
            return False
        # What hangs needs free wall above whatever stands before it.
        margin = 0.06 if self.kind in HUNG or other.kind in HUNG else 0.015
        apart = self.bottom_m >= other.top_m or other.bottom_m >= self.top_m
        return not apart and self.rect.grown(margin).overlap(other.rect) > 0.0


@dataclass(frozen=True, slots=True)
class Place:
    """A candidate: centre and turn of a group's first thing; lower scores are better."""

    x: float
    z: float
    yaw_rad: float
    score: float


def furnish(layout: Layout, room: Room, colours: Colours) -> list[Item]:
    """The things of one room, from the house's seed alone."""
    random = np.random.default_rng((layout.plan.seed, ord(room.letter), room.storey))
    furnisher = _Furnisher(layout, room, colours, random)
    for wish in RECIPES[room.kind]:
        for _ in range(wish.count_in(room.area)):
            if random.random() < wish.chance:
                furnisher.grant(wish)
    return furnisher.items


class _Furnisher:
    """Places things in one room, one after the other."""

    def __init__(
        self, layout: Layout, room: Room, colours: Colours, random: np.random.Generator
    ) -> None:
        self.items: list[Item] = []
        self._room = room
        self._colours = colours
        self._random = random
        self._walls = [
            wall
            for wall in layout.walls
            if wall.storey == room.storey and room.letter in {wall.before, wall.after}
        ]
        self._doorways = list(_doorways(self._walls, room))
        self._windows = list(_window_strips(self._walls))
        self._freedom = Freedom(room, self._walls)

    def grant(self, wish: Wish) -> None:
        """Place one of the wished kinds at its best place that works, if there is one."""
        for index in self._random.permutation(len(wish.kinds)):
            if self._placed(wish.kinds[int(index)], wish.spot):
                return

    def _placed(self, kind: str, spot: Spot) -> bool:
        """Whether a kind found a place; it stands there then."""
        members = GROUPS.get(kind, (Member(kind),))
        tones = self._tones(members)
        anchor = model(members[0].kind, tones[members[0].kind])
        places = sorted(self._places(anchor, spot, members[0].kind), key=lambda p: p.score)
        for place in places[:_TRIES]:
            items = self._group(members, tones, place)
            if items and self._freedom.keeps_ways(
                [item.rect for item in [*self.items, *items] if item.solid]
            ):
                self.items += items
                return True
        return False

    def _tones(self, members: Sequence[Member]) -> dict[str, Tones]:
        """One choice of tones per kind, so that chairs of a set are alike."""
        return {
            kind: self._colours.tones(kind, self._random)
            for kind in dict.fromkeys(member.kind for member in members)
        }

    def _group(
        self, members: Sequence[Member], tones: dict[str, Tones], place: Place
    ) -> list[Item]:
        """All members at a place; none when one that is not optional does not fit."""
        anchor = model(members[0].kind, tones[members[0].kind])
        sin, cos = math.sin(place.yaw_rad), math.cos(place.yaw_rad)
        items: list[Item] = []
        for index, member in enumerate(members):
            own = model(member.kind, tones[member.kind])
            right, front = member.offset(anchor, own) if index else (0.0, 0.0)
            item = self._item(
                member.kind,
                tones[member.kind],
                Place(
                    place.x + cos * right + sin * front,
                    place.z - sin * right + cos * front,
                    place.yaw_rad + member.yaw_rad,
                    0.0,
                ),
            )
            if self._fits(item, items):
                items.append(item)
            elif not member.optional:
                return []
        return items

    def _item(self, kind: str, tones: Tones, place: Place) -> Item:
        own = model(kind, tones)
        wide, deep = own.width_m, own.depth_m
        if abs(math.sin(place.yaw_rad)) > 0.5:
            wide, deep = deep, wide
        rect = Rect(place.x - wide / 2, place.z - deep / 2, place.x + wide / 2, place.z + deep / 2)
        return Item(
            kind=kind,
            tones=tones,
            room=self._room.letter,
            x=place.x,
            z=place.z,
            yaw_rad=place.yaw_rad,
            rect=rect,
            bottom_m=HUNG.get(kind, 0.0),
            top_m=own.height_m,
        )

    def _fits(self, item: Item, others: Sequence[Item]) -> bool:
        if not self._room.covers(item.rect):
            return False
        if any(item.rect.overlap(wall) > 0.0 for wall in self._freedom.wall_rects):
            return False
        if item.kind not in FLAT:
            if any(item.rect.overlap(strip) > 0.0 for strip in self._doorways):
                return False
            for strip, sill_m in self._windows:
                if item.top_m > sill_m + 0.35 and item.rect.overlap(strip) > 0.0:
                    return False
        return not any(item.clashes(other) for other in [*self.items, *others])

    def _places(self, anchor: Model, spot: Spot, kind: str) -> Iterator[Place]:
        if spot == "middle of the room":
            yield from self._inner_places()
            return
        for wall in self._walls:
            if wall.kind == "wall":
                yield from self._places_along(wall, anchor, (spot, kind))

    def _inner_places(self) -> Iterator[Place]:
        """Around the middle of the room, lengthwise first."""
        rect = max(self._room.rects, key=lambda each: each.area)
        x, z = rect.centre
        wide = (rect.x1 - rect.x0) >= (rect.z1 - rect.z0)
        for reach in (0.0, 0.25, 0.5, 0.75, 1.0):
            for turn in range(8 if reach else 1):
                angle = turn * math.pi / 4
                for quarter in (0, 1):
                    score = reach + (0.3 if (quarter == 1) == wide else 0.0)
                    yield Place(
                        x + reach * math.cos(angle),
                        z + reach * math.sin(angle),
                        quarter * math.pi / 2,
                        score,
                    )

    def _places_along(self, wall: Wall, anchor: Model, wanted: tuple[Spot, str]) -> Iterator[Place]:
        spot, kind = wanted
        side = 1.0 if wall.after == self._room.letter else -1.0
        turned = 0.0 if wall.axis == "x" else math.pi / 2
        yaw_rad = turned if side > 0 else turned + math.pi
        away = WALL_M / 2 + 0.004 if kind in HUNG else _AWAY_M
        reach = away + anchor.depth_m / 2
        low = wall.low + _AWAY_M + anchor.width_m / 2
        high = wall.high - _AWAY_M - anchor.width_m / 2
        count = max(1, math.ceil((high - low) / 0.15) + 1) if high >= low else 0
        for along in np.linspace(low, high, count):
            x, z = wall.point(float(along), side * reach)
            yield Place(x, z, yaw_rad, self._score(wall, float(along), (x, z), spot))

    def _score(self, wall: Wall, along: float, point: tuple[float, float], spot: Spot) -> float:
        chance = float(self._random.random())
        middle, half = (wall.low + wall.high) / 2, (wall.high - wall.low) / 2
        if spot == "middle of a wall":
            return abs(along - middle) / half - 0.25 * half + 0.6 * chance
        if spot == "corner":
            return (half - abs(along - middle)) + 0.8 * chance
        if spot == "facing" and self.items:
            first = self.items[0]
            ahead = (math.sin(first.yaw_rad), math.cos(first.yaw_rad))
            dx, dz = point[0] - first.x, point[1] - first.z
            forward, aside = dx * ahead[0] + dz * ahead[1], abs(dx * ahead[1] - dz * ahead[0])
            return aside - 0.5 * min(forward, 4.0) if forward > 1.0 else 9.0
        return chance


def _doorways(walls: Sequence[Wall], room: Room) -> Iterator[Rect]:
    """Floor that stays free before each door."""
    for wall in walls:
        side = 1.0 if wall.after == room.letter else -1.0
        for opening in wall.openings:
            if opening.bottom_m == 0.0:
                low, high = opening.low - 0.12, opening.high + 0.12
                yield _strip(wall, (low, high), side * _BEFORE_DOORS_M)


def _window_strips(walls: Sequence[Wall]) -> Iterator[tuple[Rect, float]]:
    """Floor under each window, with the height of its sill."""
    for wall in walls:
        for opening in wall.openings:
            if opening.bottom_m > 0.0:
                for side in (-0.4, 0.4):
                    yield _strip(wall, (opening.low, opening.high), side), opening.bottom_m


def _strip(wall: Wall, run: tuple[float, float], reach: float) -> Rect:
    (x0, z0), (x1, z1) = wall.point(run[0], 0.0), wall.point(run[1], reach)
    return Rect(min(x0, x1), min(z0, z1), max(x0, x1), max(z0, z1))
