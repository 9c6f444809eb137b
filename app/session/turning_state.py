"""What is known of the turning points of one failed branch: a part of the snapshot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from app.session.branches import Cost
from app.session.searching import Tried
from app.session.wording import key_words
from c2nav_engine.experiments.turning.flips import NO_SUCCESS, TURNING, UNSTABLE, Flip
from c2nav_engine.experiments.turning.recoverable import Recoverable
from c2nav_engine.experiments.turning.regrets import Regret


@dataclass(frozen=True, slots=True)
class Turning:
    """The three figures of one branch, as far as they are known.

    Attributes:
        stage: "measuring" (a) and (b), "ready", "trying" answers, or "stopping" to.
        ranker: Who goes on after a changed answer.
        regrets: (a), worst first.
        recoverable: (b); None until it is measured.
        repeats: (c): runs of each changed answer and of each control.
        to_try: (c): every answer that is to be tried.
        flips: (c): those that were, in that order.
        cost: (c): what the rest is expected to take.
        branches: Opened flips → their branch.
    """

    stage: Literal["measuring", "ready", "trying", "stopping"]
    ranker: str = ""
    regrets: tuple[Regret, ...] = ()
    recoverable: Recoverable | None = None
    repeats: int = 0
    to_try: tuple[Tried, ...] = ()
    flips: tuple[Flip, ...] = ()
    cost: Cost = field(default_factory=Cost)
    branches: Mapping[Tried, str] = field(default_factory=dict[Tried, str])

    @property
    def left(self) -> tuple[Tried, ...]:
        """Answers that are still to be tried."""
        tried = {(flip.decision, flip.answer) for flip in self.flips}
        return tuple(place for place in self.to_try if place not in tried)

    @property
    def verdict(self) -> str:
        """What (c) says so far; "" before anything was tried."""
        return verdict_of_flips(self.flips) if self.flips else ""


def flip_words(flip: Flip) -> str:
    """A flip in one line, with both counts."""
    return (
        f"decision {flip.decision} · {flip.verdict}: {key_words(flip.answer)} succeeded in "
        f"{flip.changed} of {flip.repeats} runs, unchanged in {flip.control} of {flip.repeats}"
    )


def verdict_of_flips(flips: Sequence[Flip]) -> str:
    """The strongest verdict among flips."""
    found = {flip.verdict for flip in flips}
    return next((name for name in (TURNING, UNSTABLE) if name in found), NO_SUCCESS)
