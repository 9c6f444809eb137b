"""Things that belong together: a sofa with its table, a bed with its nightstands."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from c2nav_engine.world.builtin.furniture.model import Model

Side = Literal["front", "left", "right", "at"]


@dataclass(frozen=True, slots=True)
class Member:
    """One thing of a group, placed beside the group's first thing.

    Attributes:
        kind: Noun of the catalogue.
        side: "front", "left" or "right" of the first thing, or "at" an offset from its centre.
        gap_m: Distance between both; for "at", the offset towards the front.
        along_m: Shift to the right (front, at) or forward (left, right).
        quarter: Quarter turns to the left against the first thing.
        optional: Left out where it does not fit.
    """

    kind: str
    side: Side = "at"
    gap_m: float = 0.0
    along_m: float = 0.0
    quarter: int = 0
    optional: bool = False

    def offset(self, anchor: Model, own: Model) -> tuple[float, float]:
        """(x, z) of its centre in the first thing's frame."""
        wide, deep = own.width_m, own.depth_m
        if self.quarter % 2:
            wide, deep = deep, wide
        if self.side == "front":
            return (self.along_m, anchor.depth_m / 2 + self.gap_m + deep / 2)
        if self.side == "at":
            return (self.along_m, self.gap_m)
        sign = -1.0 if self.side == "left" else 1.0
        aside = anchor.width_m / 2 + self.gap_m + wide / 2
        return (sign * aside, -anchor.depth_m / 2 + deep / 2 + self.along_m)

    @property
    def yaw_rad(self) -> float:
        """Its turn against the first thing."""
        return self.quarter * math.pi / 2


def _chairs(*places: tuple[float, float, int]) -> tuple[Member, ...]:
    return tuple(
        Member("chair", "at", forward, right, quarter, optional=True)
        for right, forward, quarter in places
    )


GROUPS: dict[str, tuple[Member, ...]] = {
    "seating": (
        Member("sofa"),
        Member("coffee table", "front", 0.42),
        Member("rug", "front", 0.0),
        Member("floor lamp", "left", 0.06, 0.05, optional=True),
        Member("armchair", "right", 0.5, 0.75, -1, optional=True),
    ),
    "corner seating": (
        Member("sofa"),
        Member("coffee table", "front", 0.42),
        Member("floor lamp", "right", 0.06, 0.05, optional=True),
    ),
    "reading corner": (
        Member("armchair"),
        Member("side table", "right", 0.06, 0.1, optional=True),
        Member("floor lamp", "left", 0.05, optional=True),
        Member("ottoman", "front", 0.3, optional=True),
    ),
    "dining": (
        Member("dining table"),
        Member("rug"),
        *_chairs((-0.45, 0.72, 2), (0.45, 0.72, 2), (-0.45, -0.72, 0), (0.45, -0.72, 0)),
        *_chairs((1.12, 0.0, -1), (-1.12, 0.0, 1)),
    ),
    "breakfast": (
        Member("round table"),
        *_chairs((0.0, 0.82, 2), (0.0, -0.82, 0), (0.82, 0.0, -1), (-0.82, 0.0, 1)),
    ),
    "bed": (
        Member("bed"),
        Member("nightstand", "left", 0.05, optional=True),
        Member("nightstand", "right", 0.05, optional=True),
        Member("rug", "at", 0.75, optional=True),
    ),
    "bed by the wall": (
        Member("single bed"),
        Member("nightstand", "right", 0.05, optional=True),
    ),
    "desk": (Member("desk"), Member("office chair", "front", 0.02, 0.0, 2)),
    "piano": (Member("piano"), Member("piano stool", "front", 0.15)),
    "kitchen run": (
        Member("kitchen counter"),
        Member("stove", "right", 0.02),
        Member("refrigerator", "left", 0.03, 0.0, optional=True),
        Member("wall cabinet", "at", -0.15, optional=True),
    ),
    "short kitchen run": (
        Member("stove"),
        Member("kitchen counter", "right", 0.02),
        Member("refrigerator", "left", 0.03, optional=True),
    ),
    "island": (
        Member("kitchen island"),
        Member("bar stool", "front", 0.06, -0.5, 2, optional=True),
        Member("bar stool", "front", 0.06, 0.0, 2, optional=True),
        Member("bar stool", "front", 0.06, 0.5, 2, optional=True),
    ),
}
"""Group name → members; the first is what the others are placed by."""
