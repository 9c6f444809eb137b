"""A small map of an episode: its way, the reference path and the goal, from above."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from c2nav_engine.experiments.tags.account import Account
from c2nav_engine.geometry import Point

MOST_POINTS = 80
"""Corners that a way keeps [C]: a map of a few centimetres shows no more."""
_MARGIN = 6.0

Spot = tuple[float, float]


def drawing_of(account: Account, *, most: int = MOST_POINTS) -> str:
    """The map of an episode as JSON; (x, z) in metres, centimetres kept.

    Args:
        account: The episode.
        most: Corners that its way keeps.
    """
    episode = account.header.episode
    way = [point.pose.position_m for point in account.way]
    return json.dumps(
        {
            "way": _spots(_thinned(way, most)),
            "reference": _spots(episode.reference_path_m),
            "goal": _spots([episode.goal_m])[0] if episode.goal_m else None,
            "radius_m": episode.goal_radius_m,
        },
        separators=(",", ":"),
    )


def _thinned(points: Sequence[Point], most: int) -> list[Point]:
    """At most that many places, both ends among them; standing still counts once."""
    moved = [b for a, b in zip([None, *points], points, strict=False) if a != b]
    if len(moved) <= most:
        return moved
    last = len(moved) - 1
    return [moved[round(place * last / (most - 1))] for place in range(most)]


def _spots(points: Sequence[Point]) -> list[Spot]:
    return [(round(point[0], 2), round(point[2], 2)) for point in points]


@dataclass(frozen=True, slots=True)
class Map:
    """A drawing in pixels, ready for SVG.

    Attributes:
        way: Points attribute of the way's polyline.
        reference: The same for the reference path; "" without one.
        start: Where it began.
        end: Where it ended.
        goal: Centre of the goal; None without one.
        radius: Success radius.
        at: Where a place (x, z) in metres lies.
    """

    way: str
    reference: str
    start: Spot
    end: Spot
    goal: Spot | None
    radius: float
    at: Callable[[Sequence[float]], Spot]


def map_of(drawing: str, *, width: float, height: float, within: Sequence[Spot] = ()) -> Map | None:
    """Fit a drawing, and whatever else must lie `within`, into a box of pixels; None for none."""
    if not drawing:
        return None
    facts = json.loads(drawing)
    way, reference, goal = facts["way"], facts["reference"], facts["goal"]
    radius_m = facts["radius_m"]
    disc = [[side + sign * radius_m for side in goal] for sign in (-1, 1)] if goal else []
    everything = [*way, *reference, *disc, *within]
    low = [min(spot[axis] for spot in everything) for axis in (0, 1)]
    extent = [max(spot[axis] for spot in everything) - low[axis] for axis in (0, 1)]
    scale = min(
        (size - 2 * _MARGIN) / max(span, 1.0)
        for size, span in zip((width, height), extent, strict=True)
    )

    def at(spot: Sequence[float]) -> Spot:
        x, y = (
            size / 2 + scale * (spot[axis] - low[axis] - extent[axis] / 2)
            for axis, size in enumerate((width, height))
        )
        return round(x, 1), round(y, 1)

    def points(spots: Sequence[Sequence[float]]) -> str:
        return " ".join(f"{x:g},{y:g}" for x, y in map(at, spots))

    return Map(
        way=points(way),
        reference=points(reference),
        start=at(way[0]),
        end=at(way[-1]),
        goal=at(goal) if goal else None,
        radius=round(scale * radius_m, 1),
        at=at,
    )
