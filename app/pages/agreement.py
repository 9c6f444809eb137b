"""The agreement page: who agrees with whom, how far an order shown decides, and where they differ.

What stands here is plain: the gateway fills it from people's and models' answers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from app.pages.index.refresh import Progress
from app.pages.page import framed

WIDTH_PX = 132
"""Of the drawing of an interval."""

SHADES = 5
"""Steps of grey of a confusion's cells."""


@dataclass(frozen=True, slots=True)
class Bar:
    """An estimate with its interval on a scale.

    Attributes:
        words: Estimate and interval in words.
        low: Left end, as a fraction of the scale.
        middle: The estimate.
        high: Right end.
        mark: The line that it is held against; None for none.
        beside: That line in words.
    """

    words: str
    low: float
    middle: float
    high: float
    mark: float | None = None
    beside: str = ""

    def x(self, value: float) -> float:
        """Pixels from the left; a little room is left at both ends."""
        return round(4.0 + (WIDTH_PX - 8.0) * min(1.0, max(0.0, value)), 1)


@dataclass(frozen=True, slots=True)
class PairRow:
    """A pair of raters, or all pairs of a kind.

    Attributes:
        group: The kind in words, in the order in which groups stand.
        kind: Of the pair.
        a: First rater; "" for all pairs of the kind.
        b: Second one.
        questions: Questions that both answered.
        episodes: Episodes that they are of.
        top1: Share of equal winners; the mark is chance.
        tau: Mean Kendall's τ-b.
        alpha: Krippendorff's α.
        chosen: Whether its confusion is shown.
    """

    group: str
    kind: str
    a: str
    b: str
    questions: int
    episodes: int
    top1: Bar | None
    tau: Bar | None
    alpha: Bar | None
    chosen: bool


@dataclass(frozen=True, slots=True)
class RaterRow:
    """A rater and what the order shown does to them.

    Attributes:
        name: Who.
        what: What they are, where that has to be said.
        consistency: One winner in every order.
        stability: The same again.
        first: Excess of the alternative shown first.
        last: Excess of the one shown last.
        best: Share that elected the geodesically best alternative (privileged); None where it is
            covered or unknown.
    """

    name: str
    what: str
    consistency: Bar | None
    stability: Bar | None
    first: Bar | None
    last: Bar | None
    best: Bar | None


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell of a confusion: roles as they are called in the data, count, shade from 0."""

    a: str
    b: str
    count: int
    shade: int


@dataclass(frozen=True, slots=True)
class Confusion:
    """Who elected what, on one slot.

    Attributes:
        slot: Decision slot, as in the data.
        words: What it is called.
        columns: Roles of the second rater, in words.
        rows: The first rater's role in words, and its cells.
    """

    slot: str
    words: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, tuple[Cell, ...]], ...]


@dataclass(frozen=True, slots=True)
class Privileged:
    """The state of the privileged column.

    Attributes:
        shown: Whether it is there.
        answered: Places of all studies that are answered.
        places: All of them.
        problem: Why it cannot be worked out; "" where it can.
    """

    shown: bool
    answered: int
    places: int
    problem: str = ""

    @property
    def complete(self) -> bool:
        """Whether nobody is judging any more."""
        return self.answered == self.places


@dataclass(frozen=True, slots=True)
class Shown:
    """Everything on the page.

    Attributes:
        runs: Names of the runs.
        people: How many people answered without having seen a model's answer.
        beside_map: How many of their answers were given in the inspector.
        rankers: How many models.
        questions: How many questions were answered.
        slots: Slots to choose from: name and words, the first for all of them.
        slot: The one that is chosen.
        group: Kind of the chosen pair in words.
        kind: The same as in the data.
        pair: Its raters; two empty names for all pairs of the kind.
        pairs: Rows of agreement.
        raters: Rows of order effects.
        confusions: Of the chosen pair.
        privileged: Of the privileged column.
    """

    runs: tuple[str, ...]
    people: int
    beside_map: int
    rankers: int
    questions: int
    slots: tuple[tuple[str, str], ...]
    slot: str
    group: str
    kind: str
    pair: tuple[str, str]
    pairs: tuple[PairRow, ...]
    raters: tuple[RaterRow, ...]
    confusions: tuple[Confusion, ...]
    privileged: Privileged


@dataclass(frozen=True, slots=True)
class Difference:
    """One decision behind a cell.

    Attributes:
        episode: Its episode.
        slot: Its slot, in words.
        a: Who answered first.
        said_a: What they said.
        b: Who else.
        said_b: What they said.
        entry: What to open in the inspector; "" where no trace is at hand.
        decision: Decision number in that trace.
    """

    episode: str
    slot: str
    a: str
    said_a: str
    b: str
    said_b: str
    entry: str
    decision: int


def agreement_page(shown: Shown, *, menu: Sequence[str]) -> str:
    """The page; `menu` as in `framed`."""
    return framed("agreement.html.j2", here="agreement", menu=menu, shown=shown, width=WIDTH_PX)


def nobody_page(runs: Sequence[str], *, menu: Sequence[str]) -> str:
    """The page of runs about which nobody has answered anything."""
    return framed("agreement_empty.html.j2", here="agreement", menu=menu, runs=runs)


def reading_page(reading: Progress, *, runs: Sequence[str], menu: Sequence[str]) -> str:
    """The page while traces are still read; it asks again by itself."""
    return framed(
        "agreement_reading.html.j2", here="agreement", menu=menu, runs=runs, reading=reading
    )


def differences_page(
    title: str, found: Sequence[Difference], *, runs: Sequence[str], back: str, menu: Sequence[str]
) -> str:
    """The decisions behind one cell; `back` is the address of the page with that cell."""
    return framed(
        "agreement_cell.html.j2",
        here="agreement",
        menu=menu,
        title=title,
        found=found,
        runs=runs,
        back=back,
    )
