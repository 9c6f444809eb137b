"""From a plan's letters to rooms, walls and openings with coordinates."""

from __future__ import annotations

import itertools

from c2nav_engine.errors import InternalError
from c2nav_engine.world.builtin.plan import (
    OUTSIDE,
    WALL_M,
    Axis,
    Door,
    Layout,
    Opening,
    Plan,
    Rect,
    Room,
    Side,
    Wall,
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
