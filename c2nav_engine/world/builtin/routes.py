"""Shortest paths through a house, as the rooms that they lead through."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from c2nav_engine.geometry import Point, wrap_rad
from c2nav_engine.world.builtin.furniture.catalogue import FLAT
from c2nav_engine.world.builtin.house import House
from c2nav_engine.world.builtin.naming import can_be_named
from c2nav_engine.world.builtin.placement import Item
from c2nav_engine.world.builtin.plan import Layout, Room, Wall
from c2nav_engine.world.surface import Surface

SHORTEST_M, LONGEST_M = 4.0, 17.0
_FINE_M = 0.05
_STARTS = 5
_CLEARANCE_M = 0.3
"""Starts and goals keep this distance from everything, so that a first step can go anywhere."""


@dataclass(frozen=True, slots=True)
class Trail:
    """A path sampled finely.

    Attributes:
        points_m: Positions, both ends included.
        along_m: Distance from the start of each.
    """

    points_m: Float[np.ndarray, "n 3"]
    along_m: Float[np.ndarray, " n"]

    @staticmethod
    def of(corners: Sequence[Point]) -> Trail:
        """Sample straight lines between corners."""
        points = np.array(corners)
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        ends = np.concatenate([np.zeros(1), np.cumsum(steps)])
        length_m = float(ends[-1])
        along: np.ndarray = np.linspace(0.0, length_m, max(2, math.ceil(length_m / _FINE_M) + 1))
        fine = np.stack([np.interp(along, ends, points[:, k]) for k in range(3)], axis=1)
        return Trail(fine, along)

    @property
    def length_m(self) -> float:
        """Total length."""
        return float(self.along_m[-1])

    def at(self, along_m: float) -> Point:
        """The position that far along."""
        x, y, z = (float(np.interp(along_m, self.along_m, self.points_m[:, k])) for k in range(3))
        return (x, y, z)

    def bearing_rad(self, start_m: float, end_m: float) -> float:
        """Heading from one place on the path to another."""
        a, b = self.at(max(0.0, start_m)), self.at(min(self.length_m, end_m))
        return math.atan2(-(b[0] - a[0]), -(b[2] - a[2]))


@dataclass(frozen=True, slots=True)
class Visit:
    """One room on the way.

    Attributes:
        room: Which.
        enter_m: Where the path enters it (0 for the first).
        leave_m: Where the path leaves it (its length for the last).
        entry: The boundary it comes through; None for the first.
        turn_rad: Turn to the left just inside, against the way through the entry.
        exit_side_rad: How far left of the walking direction the way out opens; 0 for the last.
        bend_rad: How far the way bends to the left inside, all corners together.
    """

    room: Room
    enter_m: float
    leave_m: float
    entry: Wall | None
    turn_rad: float
    exit_side_rad: float
    bend_rad: float

    @property
    def length_m(self) -> float:
        """Length of the path inside."""
        return self.leave_m - self.enter_m


@dataclass(frozen=True, slots=True)
class Route:
    """A way to a thing.

    Attributes:
        trail: The shortest path.
        corners: Where it bends, both ends included.
        visits: Rooms in order.
        target: What stands at its end.
        geodesic_m: Length by the surface.
    """

    trail: Trail
    corners: tuple[Point, ...]
    visits: tuple[Visit, ...]
    target: Item
    geodesic_m: float


class RouteSampler:
    """Draws routes through one house from its generator."""

    def __init__(self, house: House, surface: Surface, random: np.random.Generator) -> None:
        self._house = house
        self._surface = surface
        self._random = random

    def draw(self, rounds: int = 40) -> Iterator[Route]:
        """Routes of the wanted length through two to five rooms.

        Several starts are tried for one goal in a row: distances to a goal are solved once.
        """
        rooms = [room for room in self._house.layout.rooms if room.kind != "stairs"]
        sizes = np.array([math.sqrt(room.area) for room in rooms])
        targets = [item for item in self._house.items if can_be_reached(self._house, item)]
        for _ in range(rounds):
            for index in self._random.permutation(len(targets)):
                target = targets[int(index)]
                goal = self._before(target)
                if goal is None:
                    continue
                for pick in self._random.choice(len(rooms), _STARTS, p=sizes / sizes.sum()):
                    route = self._from(rooms[int(pick)], goal, target)
                    if route is not None:
                        yield route

    def _from(self, room: Room, goal: Point, target: Item) -> Route | None:
        start = self._free_point(room) if room.letter != target.room else None
        if start is None or not SHORTEST_M / 2 < math.dist(start, goal) < LONGEST_M:
            return None
        return self._route(start, goal, target)

    def _route(self, start: Point, goal: Point, target: Item) -> Route | None:
        corners = self._surface.path(start, goal)
        if corners is None:
            return None
        geodesic_m = self._surface.geodesic_m(start, goal)
        if not SHORTEST_M < geodesic_m < LONGEST_M:
            return None
        trail = Trail.of(corners)
        visits = visits_of(self._house.layout, trail)
        letters = [(visit.room.letter, visit.room.storey) for visit in visits]
        if not 2 <= len(visits) <= 5 or len(set(letters)) < len(letters):
            return None
        if visits[-1].room.letter != target.room:
            return None
        return Route(trail, tuple(corners), visits, target, geodesic_m)

    def _free_point(self, room: Room) -> Point | None:
        rect = room.rects[int(self._random.integers(len(room.rects)))]
        x = float(self._random.uniform(rect.x0 + 0.4, rect.x1 - 0.4))
        z = float(self._random.uniform(rect.z0 + 0.4, rect.z1 - 0.4))
        return self.standing((round(x, 2), room.floor_m, round(z, 2)))

    def _before(self, item: Item) -> Point | None:
        """A place in front of a thing, where one can stand."""
        room = self._house.layout.room(item.room)
        ahead = (math.sin(item.yaw_rad), math.cos(item.yaw_rad))
        deep = item.rect.z1 - item.rect.z0
        if abs(ahead[0]) > 0.5:
            deep = item.rect.x1 - item.rect.x0
        reach = deep / 2 + float(self._random.uniform(0.45, 0.8))
        x, z = round(item.x + reach * ahead[0], 2), round(item.z + reach * ahead[1], 2)
        return self.standing((x, room.floor_m, z)) if room.holds(x, z) else None

    def standing(self, point: Point) -> Point | None:
        """The surface point right there, if there is room around it; None otherwise."""
        found = self._surface.snap(point)
        if found is None or not _same_place(found, point):
            return None
        for turn in range(8):
            angle = turn * math.pi / 4
            beside = (
                point[0] + _CLEARANCE_M * math.cos(angle),
                point[1],
                point[2] + _CLEARANCE_M * math.sin(angle),
            )
            near = self._surface.snap(beside)
            if near is None or not _same_place(near, beside):
                return None
        return found


def can_be_reached(house: House, item: Item) -> bool:
    """Whether a thing may stand at the end of a route: its words say which one is meant."""
    return item.kind not in FLAT and can_be_named(house, item)


def _same_place(found: Point, wanted: Point) -> bool:
    aside = math.hypot(found[0] - wanted[0], found[2] - wanted[2])
    return aside < 0.02 and abs(found[1] - wanted[1]) < 0.1


def visits_of(layout: Layout, trail: Trail) -> tuple[Visit, ...]:
    """The rooms along a path."""
    rooms: list[Room] = []
    enters: list[float] = []
    for point, along in zip(trail.points_m, trail.along_m, strict=True):
        room = layout.room_at(float(point[0]), float(point[1]), float(point[2]))
        # On the stairs the storey changes before the stairwell ends.
        if room is not None and (not rooms or room.letter != rooms[-1].letter):
            rooms.append(room)
            enters.append(float(along))
    leaves = [*enters[1:], trail.length_m]
    visits: list[Visit] = []
    for index, room in enumerate(rooms):
        entry = _between(layout, trail.at(enters[index]), rooms, index)
        out = _between(layout, trail.at(leaves[index]), rooms, index + 1)
        visits.append(
            Visit(
                room=room,
                enter_m=enters[index],
                leave_m=leaves[index],
                entry=entry,
                turn_rad=_turn(trail, (enters[index], leaves[index]), entry, room),
                exit_side_rad=_exit_side(trail, (enters[index], leaves[index]), out, room),
                bend_rad=_bend(trail, (enters[index], leaves[index])),
            )
        )
    return tuple(visits)


def _between(layout: Layout, point: Point, rooms: Sequence[Room], index: int) -> Wall | None:
    """The boundary between two successive rooms nearest to a point."""
    if not 0 < index < len(rooms):
        return None
    pair = {rooms[index - 1].letter, rooms[index].letter}
    shared = [wall for wall in layout.walls if {wall.before, wall.after} == pair]
    shared = [wall for wall in shared if wall.openings or wall.kind == "open"]
    return min(shared, key=lambda wall: _aside(wall, point), default=None)


def _aside(wall: Wall, point: Point) -> float:
    along, across = (point[0], point[2]) if wall.axis == "x" else (point[2], point[0])
    beyond = max(wall.low - along, 0.0, along - wall.high)
    storey = abs(point[1] / 2.9 - wall.storey)
    return abs(across - wall.line) + beyond + 5.0 * storey


def _through_rad(wall: Wall, room: Room) -> float:
    """Heading straight through a boundary into a room."""
    sign = 1.0 if wall.after == room.letter else -1.0
    dx, dz = (0.0, sign) if wall.axis == "x" else (sign, 0.0)
    return math.atan2(-dx, -dz)


def _turn(trail: Trail, run: tuple[float, float], entry: Wall | None, room: Room) -> float:
    if entry is None:
        return 0.0
    enter_m, leave_m = run
    length_m = leave_m - enter_m
    # Just behind a door the path still cuts its corner: the turn shows a step later.
    low, high = enter_m + min(0.6, 0.3 * length_m), enter_m + min(2.0, 0.9 * length_m)
    return wrap_rad(trail.bearing_rad(low, high) - _through_rad(entry, room))


def _bend(trail: Trail, run: tuple[float, float]) -> float:
    """Sum of turns between the first and the last metre of a stretch."""
    low, high = run[0] + 0.8, run[1] - 0.8
    if high - low < 2.0:
        return 0.0
    stops = np.arange(low, high, 0.5).tolist()
    bearings = [trail.bearing_rad(stop, stop + 0.5) for stop in stops]
    return sum(wrap_rad(b - a) for a, b in pairwise(bearings))


def _exit_side(trail: Trail, run: tuple[float, float], out: Wall | None, room: Room) -> float:
    if out is None:
        return 0.0
    enter_m, leave_m = run
    back = min(1.8, max(0.5, 0.7 * (leave_m - enter_m)))
    away = wrap_rad(_through_rad(out, room) + math.pi)
    return wrap_rad(away - trail.bearing_rad(leave_m - back, leave_m))
