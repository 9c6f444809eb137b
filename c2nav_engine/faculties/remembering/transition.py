"""Transition: is the evidence still of this leg, or already of the next? (paper, eq. 5)."""

from __future__ import annotations

from collections.abc import Sequence

from c2nav_engine.contract import slots
from c2nav_engine.contract.outcome import (
    ORDERS_DISAGREE,
    Abstention,
    Answered,
    Cardinal,
    Ordering,
)
from c2nav_engine.contract.question import Picture, Question
from c2nav_engine.contract.slots import Route

NEXT = "next"


def transition_question(
    route: Route, view: Picture, *, seed: int, earlier: Sequence[Picture], cardinal: bool = False
) -> Question:
    """Contrast H_stay with H_next on the sketch and the current view, in both orders.

    `cardinal` asks for progress on the same text and pictures instead (role inversion), once.
    """
    question = slots.transition(route, view, seed=seed, earlier=earlier)
    return slots.transition_cardinal(question) if cardinal else question


class TransitionRule:
    """Temporally repeated support: a single noisy frame never advances the route.

    Attributes:
        support: Supports for the next leg in a row.
    """

    def __init__(self, *, needed: int, progress_support: float) -> None:
        self._needed = needed
        self._progress_support = progress_support
        self.support = 0

    def read(self, answered: Answered) -> str:
        """Count one answer; returns the sketch's cue: "current", "next" or "ambiguous".

        A contrary or order-disagreeing answer resets the run; any other abstention or failure
        leaves it as it was.
        """
        cue = self._cue(answered)
        if cue == "next":
            self.support += 1
        elif cue == "current" or answered == Abstention(ORDERS_DISAGREE):
            self.support = 0
        return cue

    @property
    def accepted(self) -> bool:
        """Whether the support suffices to advance."""
        return self.support >= self._needed

    def restart(self) -> None:
        """A new leg began."""
        self.support = 0

    def _cue(self, answered: Answered) -> str:
        if isinstance(answered, Cardinal):
            return "next" if answered.value >= self._progress_support else "current"
        if isinstance(answered, Ordering):
            return "next" if answered.winner == NEXT else "current"
        return "ambiguous"
