"""Floor plans as text: a small matrix of letters over columns and rows of given sizes.

Plan frame: x to the right along columns, z down along rows, metres; the origin is the plan's
middle. A letter is one room, however many cells it covers; `.` is outside. Both storeys of a
house share columns and rows, and the letter `S` is the stairwell of both.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from c2nav_engine.errors import InternalError

OUTSIDE = "."
STAIRS = "S"
STOREY_M = 2.9
"""Floor to floor."""
CEILING_M = 2.7
"""Floor to ceiling."""
WALL_M = 0.12
"""Thickness of every wall, half on each side of its grid line."""

Passage = Literal["door", "arch", "open", "railing", "front door", "window"]
Axis = Literal["x", "z"]
Side = Literal["", "north", "south", "east", "west"]


@dataclass(frozen=True, slots=True)
class Rect:
    """An axis-aligned rectangle on the floor."""

    x0: float
    z0: float
    x1: float
    z1: float

    @property
    def area(self) -> float:
        """In square metres."""
        return max(0.0, self.x1 - self.x0) * max(0.0, self.z1 - self.z0)

    @property
    def centre(self) -> tuple[float, float]:
        """(x, z)."""
        return ((self.x0 + self.x1) / 2, (self.z0 + self.z1) / 2)

    def grown(self, by_m: float) -> Rect:
        """Larger on every side."""
        return Rect(self.x0 - by_m, self.z0 - by_m, self.x1 + by_m, self.z1 + by_m)

    def overlap(self, other: Rect) -> float:
        """Shared area."""
        return Rect(
            max(self.x0, other.x0),
            max(self.z0, other.z0),
            min(self.x1, other.x1),
            min(self.z1, other.z1),
        ).area

    def holds(self, x: float, z: float) -> bool:
        """Whether a point lies inside."""
        return self.x0 <= x <= self.x1 and self.z0 <= z <= self.z1

    def distance(self, x: float, z: float) -> float:
        """From a point to the nearest edge; 0 inside."""
        dx = max(self.x0 - x, 0.0, x - self.x1)
        dz = max(self.z0 - z, 0.0, z - self.z1)
        return (dx * dx + dz * dz) ** 0.5


@dataclass(frozen=True, slots=True)
class Door:
    """A way through the wall between two rooms.

    Attributes:
        first: One room's letter.
        second: The other's, or `.` for a front door.
        kind: "door" (1 m wide), "arch" (wide, no leaf), "open" (no wall at all), "railing" (a
            banister instead of a wall), "front door" (closed).
        at: Where along the shared wall, 0–1 of the room there is.
        side: On which side of the second room ("north" is up in the plan); "" for any.
    """

    first: str
    second: str
    kind: Passage = "door"
    at: float = 0.5
    side: Side = ""


@dataclass(frozen=True, slots=True)
class Plan:
    """A house before it is built.

    Attributes:
        name: House name.
        seed: Of everything that is chosen at random in it.
        columns: Widths of the columns, metres.
        rows: Depths of the rows, metres.
        storeys: Cells of each storey, one text line a row, letters separated by blanks.
        rooms: Letter → room kind ("bedroom"), or "kind: name" where two rooms share a kind.
        doors: Passages; letters are unique over both storeys, but for `S`.
        outside: Look of the outer walls: "brick", "plaster" or "boards".
    """

    name: str
    seed: int
    columns: tuple[float, ...]
    rows: tuple[float, ...]
    storeys: tuple[str, ...]
    rooms: Mapping[str, str]
    doors: tuple[Door, ...]
    outside: str = "plaster"


@dataclass(frozen=True, slots=True)
class Opening:
    """A hole in a wall.

    Attributes:
        kind: What it is.
        low: Where it begins along the wall's axis.
        high: Where it ends.
        bottom_m: Above the floor.
        top_m: Above the floor.
    """

    kind: Passage
    low: float
    high: float
    bottom_m: float = 0.0
    top_m: float = 2.1


@dataclass(slots=True)
class Wall:
    """A straight piece of boundary between two rooms.

    Attributes:
        storey: 0 or 1.
        axis: Along which axis it runs.
        line: Coordinate on the other axis.
        low: Start along its axis.
        high: End along its axis.
        before: Room on the side of smaller coordinates.
        after: Room on the other side.
        openings: Holes in it, filled in while the plan is resolved.
        kind: "wall", "open" or "railing".
    """

    storey: int
    axis: Axis
    line: float
    low: float
    high: float
    before: str
    after: str
    openings: list[Opening] = field(default_factory=list[Opening])
    kind: str = "wall"

    def point(self, along: float, aside: float = 0.0) -> tuple[float, float]:
        """(x, z) of a place along the wall, `aside` towards `after`."""
        if self.axis == "x":
            return (along, self.line + aside)
        return (self.line + aside, along)

    def other(self, room: str) -> str:
        """The room on the far side."""
        return self.after if room == self.before else self.before


@dataclass(frozen=True, slots=True)
class Room:
    """A resolved room.

    Attributes:
        letter: Its letter in the plan.
        kind: What it is furnished as.
        name: What instructions call it.
        storey: 0 or 1.
        rects: Its cells.
    """

    letter: str
    kind: str
    name: str
    storey: int
    rects: tuple[Rect, ...]

    @property
    def floor_m(self) -> float:
        """Height of its floor."""
        return self.storey * STOREY_M

    @property
    def area(self) -> float:
        """In square metres."""
        return sum(rect.area for rect in self.rects)

    def covers(self, rect: Rect) -> bool:
        """Whether a rectangle lies inside the room, walls left out."""
        return sum(own.overlap(rect) for own in self.rects) > rect.area - 1e-6

    def holds(self, x: float, z: float) -> bool:
        """Whether a point lies inside."""
        return any(rect.holds(x, z) for rect in self.rects)


@dataclass(frozen=True, slots=True)
class Layout:
    """A plan with coordinates.

    Attributes:
        plan: Where it came from.
        rooms: All rooms of all storeys; the stairwell appears once per storey.
        walls: All boundaries.
    """

    plan: Plan
    rooms: tuple[Room, ...]
    walls: tuple[Wall, ...]

    def room(self, letter: str, storey: int | None = None) -> Room:
        """The room of that letter."""
        return next(
            room for room in self.rooms if room.letter == letter and storey in {None, room.storey}
        )

    def room_at(self, x: float, y: float, z: float) -> Room | None:
        """The room that a foot point stands in; on the stairs, the lower stairwell."""
        storey = 1 if y > STOREY_M - 0.1 else 0
        return next(
            (room for room in self.rooms if room.storey == storey and room.holds(x, z)), None
        )


def resolve(plan: Plan) -> Layout:
    """Give a plan coordinates; raises `InternalError` for a plan that contradicts itself."""
    xs, zs = _grid(plan.columns), _grid(plan.rows)
    rooms: list[Room] = []
    walls: list[Wall] = []
    for storey, text in enumerate(plan.storeys):
        cells = [line.split() for line in text.strip().splitlines()]
        if len(cells) != len(plan.rows) or any(len(row) != len(plan.columns) for row in cells):
            message = f"house {plan.name}: expected {len(plan.rows)} × {len(plan.columns)} cells"
            raise InternalError(message)
        rooms += _rooms(plan, storey, cells, (xs, zs))
        walls += _walls(storey, cells, (xs, zs))
    layout = Layout(plan, tuple(rooms), tuple(walls))
    for door in plan.doors:
        _cut(layout, door)
    return layout


def _grid(sizes: tuple[float, ...]) -> list[float]:
    edges = [0.0, *itertools.accumulate(sizes)]
    return [edge - edges[-1] / 2 for edge in edges]


def _rooms(
    plan: Plan, storey: int, cells: list[list[str]], grid: tuple[list[float], list[float]]
) -> list[Room]:
    xs, zs = grid
    rects: dict[str, list[Rect]] = {}
    for j, row in enumerate(cells):
        for letter, group in itertools.groupby(range(len(row)), key=row.__getitem__):
            columns = list(group)
            rect = Rect(xs[columns[0]], zs[j], xs[columns[-1] + 1], zs[j + 1])
            rects.setdefault(letter, []).append(rect)
    rooms: list[Room] = []
    for letter, own in rects.items():
        if letter == OUTSIDE:
            continue
        kind, _, name = plan.rooms[letter].partition(": ")
        rooms.append(Room(letter, kind, name or kind, storey, tuple(_stacked(own))))
    return rooms


def _stacked(rects: list[Rect]) -> list[Rect]:
    """Join rectangles of equal width that lie above each other."""
    joined: list[Rect] = []
    for rect in rects:
        above = next((r for r in joined if (r.x0, r.x1, r.z1) == (rect.x0, rect.x1, rect.z0)), None)
        if above is None:
            joined.append(rect)
        else:
            joined[joined.index(above)] = Rect(above.x0, above.z0, above.x1, rect.z1)
    return joined


def _walls(
    storey: int, cells: list[list[str]], grid: tuple[list[float], list[float]]
) -> list[Wall]:
    xs, zs = grid
    padded = [[OUTSIDE, *row, OUTSIDE] for row in cells]
    blank = [OUTSIDE] * len(padded[0])
    padded = [blank, *padded, blank]
    walls: list[Wall] = []
    for i, x in enumerate(xs):
        pairs = [(padded[j + 1][i], padded[j + 1][i + 1]) for j in range(len(zs) - 1)]
        walls += _runs(storey, "z", x, (pairs, zs))
    for j, z in enumerate(zs):
        pairs = [(padded[j][i + 1], padded[j + 1][i + 1]) for i in range(len(xs) - 1)]
        walls += _runs(storey, "x", z, (pairs, xs))
    return walls


def _runs(
    storey: int, axis: Axis, line: float, run: tuple[list[tuple[str, str]], list[float]]
) -> list[Wall]:
    pairs, edges = run
    walls: list[Wall] = []
    for pair, group in itertools.groupby(range(len(pairs)), key=pairs.__getitem__):
        indices = list(group)
        if pair[0] != pair[1]:
            low, high = edges[indices[0]], edges[indices[-1] + 1]
            walls.append(Wall(storey, axis, line, low, high, pair[0], pair[1]))
    return walls


def _side_of(wall: Wall, room: str) -> Side:
    """On which side of a room a wall lies."""
    if wall.axis == "x":
        return "north" if wall.after == room else "south"
    return "west" if wall.after == room else "east"


_SIZES: dict[str, tuple[float, float]] = {
    "door": (1.0, 2.1),
    "arch": (1.7, 2.3),
    "front door": (1.0, 2.1),
}
"""Width and height of each kind of passage."""


def _cut(layout: Layout, door: Door) -> None:
    """Put one passage into the longest wall between its rooms."""
    shared = [
        wall
        for wall in layout.walls
        if {wall.before, wall.after} == {door.first, door.second}
        and door.side in {"", _side_of(wall, door.second)}
    ]
    if not shared:
        message = f"house {layout.plan.name}: no wall between {door.first} and {door.second}"
        raise InternalError(message)
    if door.kind in {"open", "railing"}:
        for wall in shared:
            wall.kind = door.kind
        return
    wall = max(shared, key=lambda w: w.high - w.low)
    width, height = _SIZES[door.kind]
    margin = WALL_M / 2 + 0.1
    room = wall.high - wall.low - width - 2 * margin
    if room < -1e-9:
        message = (
            f"house {layout.plan.name}: {door.kind} {door.first}–{door.second}: expected a wall "
            f"of {width + 2 * margin:.2f} m, came {wall.high - wall.low:.2f} m"
        )
        raise InternalError(message)
    low = wall.low + margin + room * door.at
    wall.openings.append(Opening(door.kind, low, low + width, 0.0, height))
