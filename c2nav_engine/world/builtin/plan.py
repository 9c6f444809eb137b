"""Floor plans as text: a small matrix of letters over columns and rows of given sizes.

Plan frame: x to the right along columns, z down along rows, metres; the origin is the plan's
middle. A letter is one room, however many cells it covers; `.` is outside. Both storeys of a
house share columns and rows, and the letter `S` is the stairwell of both.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

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
        """The room that a foot point stands in; on the stairs, the stairwell of either storey."""
        # Paths cut the corner of the top step: a little below the upper floor is still upstairs.
        storey = 1 if y > STOREY_M - 0.45 else 0
        return next(
            (room for room in self.rooms if room.storey == storey and room.holds(x, z)), None
        )
