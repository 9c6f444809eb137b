"""What the words of a leg ask to look for: coloured things, turns, and what to leave behind.

The vocabulary is the eleven basic colour terms of English and a few things that have a colour of
their own. Every other word is ignored: this ranker does not know what a sofa looks like.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

COLOUR_WORDS = {
    "red": "red",
    "orange": "orange",
    "yellow": "yellow",
    "green": "green",
    "blue": "blue",
    "purple": "purple",
    "violet": "purple",
    "pink": "pink",
    "brown": "brown",
    "wooden": "brown",
    "black": "black",
    "white": "white",
    "grey": "grey",
    "gray": "grey",
}
COLOURED_THINGS = {
    "plant": "green",
    "plants": "green",
    "tree": "green",
    "grass": "green",
    "bush": "green",
    "window": "white",
    "windows": "white",
    "refrigerator": "white",
    "fridge": "white",
    "bathtub": "white",
    "toilet": "white",
    "sink": "white",
}
"""Things whose usual colour stands in for one that is not said."""

FAINT = frozenset({"white", "grey", "black", "brown"})
"""Colours that walls, floors and shadows have too: weak evidence for a thing."""

_COLOUR = re.compile(rf"\b(?:{'|'.join([*COLOUR_WORDS, *COLOURED_THINGS])})\b")
_LEAVING = re.compile(
    r"\b(?:leave|leaving|exit|exiting|out of|away from|from|behind you|back to)\b[^,.;]{0,30}$"
)
_BEHIND_AFTER = re.compile(r"^[^,.;]{0,20}\bbehind you\b")
_TURN = re.compile(
    r"\b(?:turn|turning|veer|bear|go|head|take|make|hang|pivot|swing|curve)\b"
    r"[^,.;]{0,18}?\b(left|right|around|back)\b"
)


@dataclass(frozen=True, slots=True)
class Landmark:
    """A coloured thing that a leg names.

    Attributes:
        colour: Basic colour term.
        weight: 1 for what the leg leads to, less for what it mentions before, negative for what
            it leaves behind.
    """

    colour: str
    weight: float


@dataclass(frozen=True, slots=True)
class LegWords:
    """What one leg says.

    Attributes:
        landmarks: Coloured things, in order of mention.
        turn: "left", "right", "around" or "".
        spoken_colour: Whether a colour word itself is there, so that only colour can decide.
    """

    landmarks: tuple[Landmark, ...]
    turn: str
    spoken_colour: bool

    @property
    def target(self) -> Landmark | None:
        """The last thing the leg leads to."""
        wanted = [landmark for landmark in self.landmarks if landmark.weight > 0.0]
        return wanted[-1] if wanted else None


def read_leg(leg: str) -> LegWords:
    """The words of one leg that pixels can be compared with."""
    folded = leg.casefold()
    found = list(_COLOUR.finditer(folded))
    # "red plant" names one thing: a spoken colour outranks the thing's usual one.
    spoken = [match for match in found if match.group() in COLOUR_WORDS]
    chosen = spoken or found
    landmarks = tuple(
        Landmark(_colour(match.group()), _weight(folded, match, last=match is chosen[-1]))
        for match in chosen
    )
    turn = _TURN.search(folded)
    return LegWords(landmarks, _side(turn.group(1)) if turn else "", bool(spoken))


def turned_in_leg(sketch: str, side: str) -> bool:
    """Whether the sketch says that this leg already turned that way."""
    so_far = _this_leg(sketch)
    if side == "around":
        return "back" in so_far
    return re.search(rf"\b{side}\b", so_far) is not None


def amount_in_leg(sketch: str) -> int:
    """How far this leg went by the sketch's words: 0 none or unknown, 1 a few, 2 several, 3 many.

    The words are the ordinal ones of the sketch; anything else counts as unknown.
    """
    so_far = _this_leg(sketch)
    for amount, word in ((3, "many steps"), (2, "several steps"), (1, "few steps")):
        if word in so_far:
            return amount
    return 0


def _this_leg(sketch: str) -> str:
    found = re.search(r"this leg so far: ([^\n]*)", sketch.casefold())
    return found.group(1) if found else sketch.casefold()


def _colour(word: str) -> str:
    return COLOUR_WORDS.get(word) or COLOURED_THINGS[word]


def _weight(text: str, match: re.Match[str], *, last: bool) -> float:
    if _LEAVING.search(text[: match.start()]) or _BEHIND_AFTER.search(text[match.end() :]):
        return -0.4
    return 1.0 if last else 0.5


def _side(word: str) -> str:
    return "around" if word in {"around", "back"} else word
