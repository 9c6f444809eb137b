"""Handing out colours: no two things of a kind alike in a house while there are colours left."""

from __future__ import annotations

import numpy as np

from c2nav_engine.world.builtin.furniture.model import Tones
from c2nav_engine.world.builtin.palette import ACCENTS, WOODS

_QUIET = ("white", "cream", "sage", "navy", "grey", "charcoal", "beige", "teal", "olive", "maroon")
_QUIET_KINDS = frozenset(
    {"kitchen counter", "kitchen island", "wardrobe", "washbasin", "refrigerator", "fireplace"}
)


class Colours:
    """What one house has used so far.

    Colours repeat between kinds, so that a teal vase and a teal chair can mislead whoever looks
    for a colour alone.
    """

    def __init__(self, seed: int) -> None:
        random = np.random.default_rng((seed, 0))
        woods = list(WOODS)
        self._woods: list[str] = [woods[i] for i in random.permutation(len(woods)).tolist()[:2]]
        self._used: dict[str, list[str]] = {}

    def tones(self, kind: str, random: np.random.Generator) -> Tones:
        """Tones for one more thing of a kind."""
        choices = _QUIET if kind in _QUIET_KINDS else ACCENTS
        used = self._used.setdefault(kind, [])
        least = min(used.count(colour) for colour in choices)
        free = [colour for colour in choices if used.count(colour) == least]
        colour = free[int(random.integers(len(free)))]
        used.append(colour)
        wood = self._woods[int(random.random() < 0.3)]
        return Tones(colour, wood, int(random.integers(12)))
