"""Where windows go: in the middle of outer walls, by the kind of room."""

from __future__ import annotations

from c2nav_engine.world.builtin.plan import OUTSIDE, Layout, Opening, Wall

_WINDOWS: dict[str, tuple[float, float, float]] = {
    "living room": (2.0, 0.55, 2.25),
    "dining room": (1.6, 0.75, 2.2),
    "kitchen": (1.3, 1.3, 2.2),
    "bedroom": (1.4, 0.9, 2.2),
    "children's room": (1.4, 0.9, 2.2),
    "guest room": (1.4, 0.9, 2.2),
    "study": (1.4, 0.9, 2.2),
    "library": (1.2, 0.9, 2.2),
    "music room": (1.6, 0.8, 2.2),
    "playroom": (1.6, 0.8, 2.2),
    "studio": (1.8, 0.7, 2.3),
    "bathroom": (0.8, 1.45, 2.15),
    "hallway": (0.9, 0.9, 2.2),
    "entrance hall": (0.9, 0.9, 2.2),
    "landing": (1.2, 0.9, 2.2),
}
"""Width, sill and head by room kind, metres; other rooms have none."""


def add_windows(layout: Layout) -> None:
    """Cut one window into each outer wall that is long enough; two into very long ones."""
    for wall in layout.walls:
        if OUTSIDE in {wall.before, wall.after} and not wall.openings and wall.kind == "wall":
            _add(layout, wall)


def _add(layout: Layout, wall: Wall) -> None:
    room = layout.room(wall.other(OUTSIDE), wall.storey)
    if room.kind not in _WINDOWS:
        return
    width, bottom, top = _WINDOWS[room.kind]
    length = wall.high - wall.low
    if length < width + 0.7:
        return
    count = 2 if length > 2 * width + 2.4 else 1
    for index in range(count):
        middle = wall.low + length * (index + 0.5) / count
        wall.openings.append(Opening("window", middle - width / 2, middle + width / 2, bottom, top))
