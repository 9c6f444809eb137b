"""What the words of a leg ask to look for: coloured things, turns, and what to leave behind.

The vocabulary is common English colour names and a few things that have a colour of their own.
Of nouns it knows only where such a thing stands: on a wall, low on the floor, tall, on furniture.
It does not know what a sofa looks like, but that it is red, and no taller than the camera.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

COLOUR_WORDS = {
    "red": "red",
    "scarlet": "red",
    "crimson": "crimson",
    "coral": "coral",
    "salmon": "coral",
    "mint": "mint",
    "plum": "plum",
    "maroon": "maroon",
    "burgundy": "maroon",
    "orange": "orange",
    "brown": "brown",
    "wooden": "brown",
    "yellow": "yellow",
    "gold": "mustard",
    "mustard": "mustard",
    "olive": "olive",
    "green": "green",
    "teal": "teal",
    "turquoise": "turquoise",
    "cyan": "turquoise",
    "aqua": "turquoise",
    "blue": "blue",
    "navy": "navy",
    "indigo": "navy",
    "lavender": "lavender",
    "lilac": "lavender",
    "purple": "purple",
    "violet": "purple",
    "magenta": "magenta",
    "pink": "pink",
    "black": "black",
    "white": "white",
    "grey": "grey",
    "gray": "grey",
}
_WHITE_WARE = ("sink", "bathtub", "tub", "toilet", "basin")
_TALL_WOODEN = ("wardrobe", "bookshelf", "bookcase")
_WOODEN = (*_TALL_WOODEN, "cabinet", "dresser", "piano")
COLOURED_THINGS = {
    **dict.fromkeys(("plant", "plants", "tree", "bush"), "green"),
    **dict.fromkeys(("television", "tv"), "black"),
    **dict.fromkeys(_WHITE_WARE, "white"),
    **dict.fromkeys(_WOODEN, "wood"),
}
"""Things whose usual colour stands in for one that is not said."""

FAINT = frozenset({"white", "grey", "black", "brown", "wood"})
"""Colours that walls, floors and shadows have too: weak evidence for a thing."""

HANGING = frozenset(
    ["painting", "paintings", "picture", "pictures", "poster", "photo", "clock", "mirror", "frame"]
)
"""Things on walls: they end above the eye's height, and their lower edge tells no distance."""
_SEATS = ("sofa", "couch", "bench", "ottoman", "beanbag", "armchair", "chair", "stool", "pouf")
LOW = frozenset(
    [
        *_SEATS,
        *_WHITE_WARE,
        "bed",
        "chest",
        "dresser",
        "sideboard",
        "rug",
        "mat",
        "runner",
        "table",
        "suitcase",
        "ball",
        "basket",
    ]
)
"""Things lower than the camera: they end below the horizon."""
RAISED = frozenset(["television", "tv", "ball", "globe", "vase", "lamp", "aquarium"])
"""Things that stand on furniture: their lower edge tells no distance, but their size does."""
TALL = frozenset(_TALL_WOODEN)
"""Things that reach from the floor past the camera's height."""

_COLOUR = re.compile(rf"\b(?:{'|'.join([*COLOUR_WORDS, *COLOURED_THINGS])})\b")
_LEAVING = re.compile(
    r"\b(?:leave|leaving|exit|exiting|out of|away from|from|behind you|back to)\b[^,.;]{0,30}$"
)
_PASSING = re.compile(r"\b(?:past|passing|over|between)\b[^,.;]{0,40}$")
_BEHIND_AFTER = re.compile(r"^[^,.;]{0,20}\bbehind you\b")
_TURN = re.compile(
    r"\b(?:turn|turning|veer|bear|take|make|hang|pivot|swing|curve)\b"
    r"(?P<between>[^,.;]{0,18}?)\b(?P<side>left|right|around|back)\b"
)
_SLIGHT = re.compile(r"\b(?:slight|slightly|little|bit)\b")
_ON_SIDE = re.compile(
    r"\b(?:into|in|through|enter|to)\b[^,.;]{0,40}\bon (?:the|your) (left|right)\b"
)
_LEAVES_ROOM = re.compile(r"\b(?:into|exit|leave|enter|through|out of|doorway|archway|door)\b")
_OPENING_WORDS = 4
"""A turn that begins within so many words opens its leg ("Then turn left and …")."""


@dataclass(frozen=True, slots=True)
class Landmark:
    """A coloured thing that a leg names.

    Attributes:
        colour: One of the colours that `pixels` knows.
        weight: 1 for what the leg leads to, less for what it goes past or mentions before,
            negative for what it leaves behind.
        noun: The word after the colour.
    """

    colour: str
    weight: float
    noun: str = ""

    @property
    def hanging(self) -> bool:
        """Whether it hangs on a wall rather than stands on the floor."""
        return self.noun in HANGING

    @property
    def raised(self) -> bool:
        """Whether it stands on furniture."""
        return self.noun in RAISED

    @property
    def low(self) -> bool:
        """Whether it is lower than the camera."""
        return self.noun in LOW

    @property
    def tall(self) -> bool:
        """Whether it reaches from the floor past the camera's height."""
        return self.noun in TALL


@dataclass(frozen=True, slots=True)
class Turn:
    """A turn that a leg asks for.

    Attributes:
        side: "left", "right" or "around".
        cycles: How many elections of a side view it takes: 1 slight, 2 plain, 4 around.
        opening: Whether the leg begins with it.
    """

    side: str
    cycles: int
    opening: bool


@dataclass(frozen=True, slots=True)
class LegWords:
    """What one leg says.

    Attributes:
        landmarks: Coloured things, in order of mention.
        turn: The first turn, if there is one.
        exit_side: On which side the leg leaves ("into the bedroom on your left"), or "".
        leaves_room: Whether the leg leads into another room.
        spoken_colour: Whether a colour word itself is there, so that only colour can decide.
    """

    landmarks: tuple[Landmark, ...]
    turn: Turn | None
    exit_side: str
    leaves_room: bool
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
        Landmark(
            _colour(match.group()),
            _weight(folded, match, last=match is chosen[-1]),
            _noun(folded, match),
        )
        for match in chosen
    )
    side = _ON_SIDE.search(folded)
    return LegWords(
        landmarks=landmarks,
        turn=_turn(folded),
        exit_side=side.group(1) if side else "",
        leaves_room=_LEAVES_ROOM.search(folded) is not None,
        spoken_colour=bool(spoken),
    )


def turns_made(sketch: str, side: str) -> int:
    """How often the latest moves of this leg turned that way, less the other way.

    "around" counts either side. A sharp turn counts twice, a turn back four times.
    """
    moves = re.search(r"latest moves[^:]*: ([^\n]*)", sketch.casefold())
    said = moves.group(1) if moves else ""
    left, right = (_count(said, word) for word in ("left", "right"))
    back = 4 * said.count("turned back")
    if side == "around":
        return abs(left - right) + back
    return (left - right if side == "left" else right - left) + back


def on_first_leg(sketch: str) -> bool:
    """Whether the sketch tells of a leg and of none that is done; without a sketch nobody knows."""
    return bool(sketch) and "leg done" not in sketch.casefold()


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


def _noun(text: str, match: re.Match[str]) -> str:
    if match.group() in COLOURED_THINGS:
        return match.group()
    found = re.match(r"\W*(\w+)", text[match.end() :])
    return found.group(1) if found else ""


def _colour(word: str) -> str:
    return COLOUR_WORDS.get(word) or COLOURED_THINGS[word]


def _weight(text: str, match: re.Match[str], *, last: bool) -> float:
    if _LEAVING.search(text[: match.start()]) or _BEHIND_AFTER.search(text[match.end() :]):
        return -0.4
    if _PASSING.search(text[: match.start()]):
        return 0.3
    return 1.0 if last else 0.5


def _turn(text: str) -> Turn | None:
    found = _TURN.search(text)
    if found is None:
        return None
    opening = len(text[: found.start()].split()) < _OPENING_WORDS
    if found["side"] in {"around", "back"}:
        return Turn("around", 4, opening)
    return Turn(found["side"], 1 if _SLIGHT.search(found["between"]) else 2, opening)


def _count(moves: str, side: str) -> int:
    return moves.count(f"turned {side}") + 2 * moves.count(f"turned sharply {side}")
