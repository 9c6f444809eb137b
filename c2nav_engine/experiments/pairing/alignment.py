"""Walking two episodes together: by decision until they part, then by step, leg or distance."""

from __future__ import annotations

import enum
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from c2nav_engine.experiments.tags.account import Account
from c2nav_engine.metrics.off_path import along_path_m

SPACING_M = 0.5
"""Between two stands by distance [C]: two forward steps."""


class Axis(enum.StrEnum):
    """What is held equal after the parting."""

    STEP = "step"
    LEG = "leg"
    DISTANCE = "distance"


@dataclass(frozen=True, slots=True)
class Line:
    """One episode along what it can be aligned by; entries by low-level step, from the start.

    Attributes:
        legs: Active leg, from 0.
        along_m: Farthest length along the reference path so far; () without one.
    """

    legs: tuple[int, ...]
    along_m: tuple[float, ...] = ()

    @property
    def last(self) -> int:
        """The last step."""
        return len(self.legs) - 1


@dataclass(frozen=True, slots=True)
class Stand:
    """Where the two stand together: a step of each, and what they share there."""

    words: str
    first: int
    second: int


def line_of(account: Account) -> Line:
    """Read an episode."""
    legs = np.zeros(len(account.way), dtype=int)
    for step, facts in account.facts():
        legs[min(step, len(legs) - 1) :] = facts.leg
    path_m = account.header.episode.reference_path_m
    along_m: tuple[float, ...] = ()
    if path_m:
        places = [point.pose.position_m for point in account.way]
        along_m = tuple(np.maximum.accumulate(along_path_m(places, path_m)).tolist())
    return Line(tuple(legs.tolist()), along_m)


def stands(
    first: Line, second: Line, axis: Axis, *, shared: Sequence[int], parted: int
) -> list[Stand]:
    """Every place to stand, in order.

    Args:
        first: One episode.
        second: The other.
        axis: What is held equal after the parting.
        shared: Steps of the decisions before the parting: the same in both.
        parted: Step at which they part.

    Raises:
        ValueError: The axis is the distance, and one of them has no reference path.
    """
    before = [
        Stand(f"decision {number}", step, step)
        for number, step in enumerate(shared)
        if step < parted or number == 0
    ]
    after = {Axis.STEP: _by_step, Axis.LEG: _by_leg, Axis.DISTANCE: _by_distance}[axis]
    return [*before, *after(first, second, parted)]


def _by_step(first: Line, second: Line, parted: int) -> Iterator[Stand]:
    for step in range(parted, max(first.last, second.last) + 1):
        yield Stand(f"step {step}", min(step, first.last), min(step, second.last))


def _by_leg(first: Line, second: Line, parted: int) -> Iterator[Stand]:
    """Step by step within each leg; who has walked a leg to its end waits there."""
    standing = [min(parted, first.last), min(parted, second.last)]
    for leg in range(min(first.legs[standing[0]], second.legs[standing[1]]), _legs(first, second)):
        own = [
            [step for step in range(parted, line.last + 1) if line.legs[step] == leg]
            for line in (first, second)
        ]
        for since in range(max(len(own[0]), len(own[1]))):
            for place, steps in enumerate(own):
                if steps:
                    standing[place] = steps[min(since, len(steps) - 1)]
            yield Stand(f"leg {leg + 1}, step {since}", standing[0], standing[1])


def _legs(first: Line, second: Line) -> int:
    return max(*first.legs, *second.legs) + 1


def _by_distance(first: Line, second: Line, parted: int) -> Iterator[Stand]:
    if not first.along_m or not second.along_m:
        message = "expected a reference path to align by distance, came an episode without one"
        raise ValueError(message)
    begin_m = min(line.along_m[min(parted, line.last)] for line in (first, second))
    end_m = max(first.along_m[-1], second.along_m[-1])
    for count in range(int((end_m - begin_m) / SPACING_M) + 1):
        wanted_m = begin_m + count * SPACING_M
        steps = [_first_at(line, wanted_m, parted) for line in (first, second)]
        yield Stand(f"{wanted_m:.1f} m along the reference", steps[0], steps[1])


def _first_at(line: Line, wanted_m: float, parted: int) -> int:
    """The first step from the parting on that is so far along; the last where none is."""
    return min(max(bisect_left(line.along_m, wanted_m), min(parted, line.last)), line.last)
