"""A question: alternatives that the controller built, put before something that can compare.

Nothing here holds a coordinate, a distance or an angle. The controller's facts about the same
alternatives travel beside the question, never in it (`navigator.requests.Facts`).
"""

from __future__ import annotations

import enum
import hashlib
from dataclasses import dataclass

from c2nav_engine.contract.outcome import Key


class Slot(enum.StrEnum):
    """The decision slots of the paper, and the inversions' own."""

    SEEING = "seeing"
    GLANCE = "glance"
    TRANSITION = "transition"
    GROUND = "ground"
    JOURNEY = "journey"
    LOOKBACK = "lookback"
    DIRECT = "direct"
    """Direct action of the variants without Seeing."""


class Form(enum.StrEnum):
    """What kind of answer is asked for; every form but the first two is a role inversion."""

    ORDINAL = "ordinal"
    """A ranking of the labelled alternatives."""
    ACTION = "action"
    """One label of forward, left, right (direct action); parsed like a winner-only ordering."""
    DEGREES = "degrees"
    """Spatial inversion: a heading in degrees, left positive."""
    PROGRESS = "progress"
    """Transition inversion: 0–100."""
    YES_NO = "yes-no"
    """Terminal inversion: have you arrived."""


class Orders(enum.StrEnum):
    """How often, and in which presentation orders, a question is put."""

    ONCE = "once"
    BOTH = "both"
    """Seeded order and its reverse; disagreement is an abstention."""
    CYCLIC = "cyclic"
    """All m rotations of the seeded order, with a Borda count (contested elections)."""


@dataclass(frozen=True, slots=True)
class Picture:
    """One encoded image, made once; the same bytes go to rankers, trace and page.

    Attributes:
        jpeg: JPEG bytes.
        sha256: Hex digest of the bytes.
        width_px: Columns.
        height_px: Rows.
    """

    jpeg: bytes
    sha256: str
    width_px: int
    height_px: int

    @staticmethod
    def of(jpeg: bytes, *, width_px: int, height_px: int) -> Picture:
        """Wrap encoded bytes with their digest."""
        return Picture(jpeg, hashlib.sha256(jpeg).hexdigest(), width_px, height_px)


@dataclass(frozen=True, slots=True)
class Alternative:
    """One thing to compare.

    Attributes:
        key: What the controller calls it: "left", "front", "right", "sector0"…"sector5",
            "stay", "next", "here", "ahead", "covered", "missing", "now", "back", "forward".
        text: Words shown with its label ("" when the picture is everything).
        picture: Its image, if the alternatives differ by image.
        caption: An inversion's caption of the picture (the heading of `spatial-cardinal`).
    """

    key: Key
    text: str = ""
    picture: Picture | None = None
    caption: str = ""


@dataclass(frozen=True, slots=True)
class Question:
    """Everything a ranker may know.

    Attributes:
        slot: Which decision this is.
        form: What kind of answer is wanted.
        orders: How it is presented.
        instruction: The whole instruction, verbatim.
        legs: The legs of the route ladder, verbatim.
        leg: Index of the active leg.
        sketch: Nonmetric rendering of the route sketch ("" in variants without it).
        context: Pictures shared by all alternatives (the current view, sketch thumbnails), with
            the words that introduce each.
        alternatives: Two or more, in the controller's canonical order.
        shuffle_seed: Seeds the presentation; the record keeps it.
        template: Id of the prompt template.
    """

    slot: Slot
    form: Form
    orders: Orders
    instruction: str
    legs: tuple[str, ...]
    leg: int
    alternatives: tuple[Alternative, ...]
    shuffle_seed: int
    template: str
    sketch: str = ""
    context: tuple[tuple[str, Picture], ...] = ()

    @property
    def keys(self) -> tuple[Key, ...]:
        """The offered keys in canonical order."""
        return tuple(alternative.key for alternative in self.alternatives)
