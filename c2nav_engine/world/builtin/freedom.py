"""Whether a room's furniture leaves ways between its doors."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import cast

import numpy as np
from scipy import ndimage

from c2nav_engine.world.builtin.plan import STAIRS, WALL_M, Rect, Room, Wall

_CELL_M = 0.1
_CLEAR_M = 0.3
"""Half the width of the ways that stay free: three times the body's radius."""
_KEPT_SHARE = 0.75
"""Share of the free floor that must stay connected to the doors."""


class Freedom:
    """The free floor of one room, on a coarse grid."""

    def __init__(self, room: Room, walls: Sequence[Wall]) -> None:
        self.wall_rects = [_slab(wall) for wall in walls if wall.kind != "open"]
        x0, z0 = min(r.x0 for r in room.rects), min(r.z0 for r in room.rects)
        x1, z1 = max(r.x1 for r in room.rects), max(r.z1 for r in room.rects)
        self._x = np.arange(x0 + _CELL_M / 2, x1, _CELL_M)
        self._z = np.arange(z0 + _CELL_M / 2, z1, _CELL_M)
        self._free = np.zeros((len(self._x), len(self._z)), bool)
        for rect in room.rects:
            self._mark(rect, self._free, value=True)
        for rect in self.wall_rects:
            self._mark(rect.grown(_CLEAR_M - WALL_M / 2), self._free, value=False)
        self._doors = [self._cell(*point) for point in _thresholds(room, walls)]
        for i, j in self._doors:
            self._free[i, j] = True

    def keeps_ways(self, rects: Sequence[Rect]) -> bool:
        """Whether all doors still reach each other and most of the floor around those rects."""
        free = self._free.copy()
        for rect in rects:
            self._mark(rect.grown(_CLEAR_M - 0.06), free, value=False)
        labels = _islands(free)
        at_doors = {int(labels[i, j]) for i, j in self._doors}
        if len(at_doors) != 1 or 0 in at_doors:
            return not self._doors
        reached = int((labels == at_doors.pop()).sum())
        return reached >= _KEPT_SHARE * int(free.sum())

    def _mark(self, rect: Rect, grid: np.ndarray, *, value: bool) -> None:
        i0, i1 = np.searchsorted(self._x, (rect.x0, rect.x1))
        j0, j1 = np.searchsorted(self._z, (rect.z0, rect.z1))
        grid[i0:i1, j0:j1] = value

    def _cell(self, x: float, z: float) -> tuple[int, int]:
        return int(np.abs(self._x - x).argmin()), int(np.abs(self._z - z).argmin())


def _islands(free: np.ndarray) -> np.ndarray:
    """Cells numbered by the connected piece they belong to, 0 where not free."""
    label = cast("Callable[[np.ndarray], tuple[np.ndarray, int]]", ndimage.label)  # pyright: ignore[reportUnknownMemberType]
    return label(free)[0]


def _slab(wall: Wall) -> Rect:
    (x0, z0), (x1, z1) = wall.point(wall.low, -WALL_M / 2), wall.point(wall.high, WALL_M / 2)
    return Rect(min(x0, x1), min(z0, z1), max(x0, x1), max(z0, z1))


def _thresholds(room: Room, walls: Sequence[Wall]) -> list[tuple[float, float]]:
    """A point inside the room before each way out."""
    points: list[tuple[float, float]] = []
    for wall in walls:
        side = 0.45 if wall.after == room.letter else -0.45
        middles = [(o.low + o.high) / 2 for o in wall.openings if o.bottom_m == 0.0]
        if wall.kind == "open" and room.letter != STAIRS:
            middles.append((wall.low + wall.high) / 2)
        points += [wall.point(middle, side) for middle in middles]
    return points
