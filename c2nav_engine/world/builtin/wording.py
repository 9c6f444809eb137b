"""Instructions from measured routes: one clause per leg, in varied words, without any number.

Every statement is read off the path: turns against the doors gone through, things passed with
their side, rooms by name. A text is kept only when the route parser finds exactly its legs.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from c2nav_engine.contract.route import parse_english
from c2nav_engine.world.builtin.house import House
from c2nav_engine.world.builtin.routes import Route
from c2nav_engine.world.builtin.telling import Leg, Teller

_FEWEST_WORDS, _MOST_WORDS = 14, 34
_FAR_END_SHARE = 0.6
"""Share of routes whose last leg holds the way to the goal.

Chosen so that about as many last legs as in validation-unseen begin farther from the goal than
the 3 m within which a stop is a success: 41 % there, sharing each path evenly among its legs.
"""


@dataclass(frozen=True, slots=True)
class Told:
    """A whole instruction.

    Attributes:
        text: What the robot is told.
        ends_m: Where on the path each leg ends.
    """

    text: str
    ends_m: tuple[float, ...]


def tell(
    house: House, route: Route, heading_rad: float, random: np.random.Generator
) -> Told | None:
    """Words for a route that starts with a heading; None when no try reads well.

    Of several versions the one that names most of what is passed is kept.
    """
    far_end = bool(random.random() < _FAR_END_SHARE)
    tellers = (Teller(house, route, random) for _ in range(10))
    versions = [_version(teller.legs(heading_rad, far_end=far_end), random) for teller in tellers]
    told = [version for version in versions if version is not None]
    return max(told, key=_named, default=None)


def _version(legs: Sequence[Leg], random: np.random.Generator) -> Told | None:
    text = _sentences([leg.text for leg in legs], random)
    ends_m = tuple(leg.end_m for leg in legs)
    fits = 2 <= len(legs) <= 5 and _FEWEST_WORDS <= len(text.split()) <= _MOST_WORDS
    if fits and _rising(ends_m) and len(parse_english(text).legs) == len(legs):
        return Told(text, ends_m)
    return None


def _named(told: Told) -> int:
    """How many things beside the path the text names."""
    return sum(told.text.count(word) for word in (" past ", " over ", " on your "))


def _rising(ends_m: tuple[float, ...]) -> bool:
    return all(b - a > 0.5 for a, b in itertools.pairwise((0.0, *ends_m)))


def _sentences(legs: Sequence[str], random: np.random.Generator) -> str:
    """Join clauses into one to four sentences."""
    text = legs[0][0].upper() + legs[0][1:]
    for index, leg in enumerate(legs[1:], 1):
        last = index == len(legs) - 1
        choice = float(random.random())
        # "… and turn left and …" reads badly: what begins with a turn begins a sentence.
        turning = leg.startswith("turn")
        if last and not turning and choice < 0.5:
            text += f" and {leg}"
        elif choice < 0.3 and ", then" not in text:
            text += f", then {leg}"
        elif choice < 0.45 and ". Then" not in text:
            text += f". Then {leg}"
        else:
            text += f". {leg[0].upper()}{leg[1:]}"
    return f"{text}."
