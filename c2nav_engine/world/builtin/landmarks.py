"""What one passes on the way and can be told apart by its words."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from c2nav_engine.world.builtin.furniture.catalogue import FLAT
from c2nav_engine.world.builtin.house import House
from c2nav_engine.world.builtin.naming import SALIENCE, can_be_named
from c2nav_engine.world.builtin.placement import Item
from c2nav_engine.world.builtin.routes import Trail, Visit


@dataclass(frozen=True, slots=True)
class Landmark:
    """A thing beside the path.

    Attributes:
        item: Which.
        along_m: Where on the path it is nearest.
        side: "left", "right", or "" for a rug that the path crosses.
        score: How well it serves in an instruction.
    """

    item: Item
    along_m: float
    side: str
    score: float


def passed(house: House, trail: Trail, visit: Visit) -> list[Landmark]:
    """Things that the path passes in one room, best first."""
    found = [
        _landmark(trail, visit, item)
        for item in house.items
        if item.room == visit.room.letter and can_be_named(house, item)
    ]
    return sorted((each for each in found if each is not None), key=lambda each: -each.score)


def _landmark(trail: Trail, visit: Visit, item: Item) -> Landmark | None:
    inside = (trail.along_m >= visit.enter_m) & (trail.along_m <= visit.leave_m)
    points, along = trail.points_m[inside], trail.along_m[inside]
    if len(points) < 8:
        return None
    gaps = np.array([item.rect.distance(float(x), float(z)) for x, _, z in points])
    if item.kind in FLAT:
        crossed = along[gaps == 0.0]
        long_enough = len(crossed) > 16
        return Landmark(item, float(crossed.mean()), "", 2.0) if long_enough else None
    # The nearest approach to its middle must lie well inside the stretch: it is passed.
    distances = np.hypot(points[:, 0] - item.x, points[:, 2] - item.z)
    nearest = int(distances.argmin())
    if gaps[nearest] > 1.7 or min(nearest, len(points) - 1 - nearest) < 8:
        return None
    ahead = points[min(nearest + 6, len(points) - 1)] - points[max(nearest - 6, 0)]
    beside = np.array((item.x, 0.0, item.z)) - points[nearest]
    length = math.hypot(float(ahead[0]), float(ahead[2]))
    left_m = float(ahead[2] * beside[0] - ahead[0] * beside[2]) / max(length, 1e-9)
    if abs(left_m) < 0.35:
        return None
    score = SALIENCE[item.kind] - 0.7 * float(gaps[nearest])
    return Landmark(item, float(along[nearest]), "left" if left_m > 0 else "right", score)
