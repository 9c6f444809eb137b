"""Judging a decision in view: what a word of the person becomes in the book of reviews.

The book keeps events and never edits a trace; what holds now is read back from it, so the page
shows the same whether something was said a moment ago, last week, or by somebody else.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from app.session.book import Book, Opinion
from app.session.snapshot import Judgement
from app.session.track import Track
from c2nav_engine.contract.outcome import Key, Ordering, Said

VERDICTS = ("agree", "acceptable", "wrong", "cannot-tell")

_FLAG = "flag"
"""The tag that marks a decision for later."""

_NOTHING: Mapping[str, str] = {}


@dataclass(frozen=True, slots=True)
class Seat:
    """Somebody who judges one decision.

    Attributes:
        book: Where it is kept.
        decision: Which one; `WHOLE` for the episode as a whole.
        who: Who judges.
        seen: Whether the model's answer was shown before.
        now: What they say so far.
        track: The way that leg ends are measured on.
    """

    book: Book
    decision: int
    who: str
    seen: bool
    now: Judgement
    track: Track

    def say(
        self,
        kind: str,
        *,
        said: Said | None = None,
        words: str = "",
        extra: Mapping[str, str] = _NOTHING,
    ) -> None:
        """Add it to the book."""
        self.book.add(
            kind,
            self.decision,
            who=self.who,
            seen=self.seen,
            said=said,
            words=words,
            extra=extra,
        )

    def take_back(self, *kinds: str) -> None:
        """Take it back, as events."""
        self.book.take_back(self.decision, kinds, who=self.who)


Change = Callable[[Seat], None]


def verdict(value: str) -> Change:
    """Give a verdict; the same again takes it back."""
    kind = value.replace(" ", "-")

    def change(seat: Seat) -> None:
        if seat.now.verdict == value:
            seat.take_back(*VERDICTS)
        else:
            seat.say(kind)

    return change


def better(key: Key) -> Change:
    """Name the alternative that would have been better; the same again takes it back."""

    def change(seat: Seat) -> None:
        if seat.now.better == key:
            seat.take_back("better")
        else:
            seat.say("better", said=Ordering.of(key))

    return change


def tag(value: str) -> Change:
    """Add a tag, or take it off."""
    return lambda seat: seat.say("tag", extra={"tag": value})


def flag() -> Change:
    """Mark for later, or take the mark off."""
    return tag(_FLAG)


def remark(text: str) -> Change:
    """Write a note; empty takes it away."""

    def change(seat: Seat) -> None:
        if text != seat.now.note:
            seat.say("note", words=text)

    return change


def leg_end(leg: int, step: int) -> Change:
    """Say at which low-level step a leg ends."""

    def change(seat: Seat) -> None:
        last = max(0, min(step, seat.track.last_step))
        at_m = f"{seat.track.path_length_m(last):.3f}"
        seat.say("leg-end", extra={"leg": str(leg), "at_m": at_m, "step": str(last)})

    return change


def reveal(seat: Seat) -> None:
    """The model's answer is shown now: from here on it has been seen."""
    seat.book.add("reveal", seat.decision, who=seat.who, seen=True)


def ranking(said: Said) -> Change:
    """Answer the question oneself."""
    return lambda seat: seat.say("ranking", said=said)


def judgements_of(book: Book | None, track: Track) -> dict[tuple[str, int], Judgement]:
    """(Author, decision) → what they say, without what says nothing."""
    if book is None:
        return {}
    found = {place: judgement_of(held, track) for place, held in book.opinions().items()}
    return {place: judgement for place, judgement in found.items() if judgement.says_something}


def judgement_of(opinion: Opinion, track: Track) -> Judgement:
    """An opinion as the page draws it."""
    best = opinion.better
    return Judgement(
        verdict=opinion.verdict.replace("-", " "),
        tags=tuple(tag for tag in opinion.tags if tag != _FLAG),
        flagged=_FLAG in opinion.tags,
        note=opinion.note,
        better=best.winner if isinstance(best, Ordering) else "",
        ranking=opinion.ranking,
        leg_ends={leg: step_at(track, at_m) for leg, at_m in opinion.leg_ends_m.items()},
        blind=opinion.blind,
    )


def step_at(track: Track, at_m: float) -> int:
    """The first step at which the path is at least this long; the last one if it never is."""
    # Stored to the millimetre.
    long_enough = (
        step for step in range(track.last_step + 1) if track.path_length_m(step) >= at_m - 1e-3
    )
    return next(long_enough, track.last_step)
