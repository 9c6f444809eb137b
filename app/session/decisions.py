"""A branch's decisions, read off its exchanges: what was asked, answered and then done."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from c2nav_engine.contract.outcome import Answered, Key, Ordering
from c2nav_engine.contract.presentation import labelled, seeded_order
from c2nav_engine.contract.prompt import Ranked
from c2nav_engine.contract.question import Question, Slot
from c2nav_engine.navigator.requests import (
    Ask,
    Candidate,
    Facts,
    Move,
    Moved,
    Note,
    Request,
    Seen,
    Unasked,
)
from c2nav_engine.runner.exchange import Exchange, Override

LANES = ("Seeing", "Transition", "Arriving")
"""The paper's three decision slots, as the timeline's lanes."""

_LANE_OF = {
    Slot.SEEING: 0,
    Slot.GLANCE: 0,
    Slot.DIRECT: 0,
    Slot.TRANSITION: 1,
    Slot.GROUND: 2,
    Slot.JOURNEY: 2,
    Slot.LOOKBACK: 2,
}


@dataclass(frozen=True, slots=True)
class Decision:
    """One decision of a branch, pending or made.

    Attributes:
        number: From 0, as in the trace.
        exchange: Index of its exchange; of the next one while it is pending.
        step: Low-level actions executed before it.
        facts: What the controller knew.
        question: What was asked; None when one survivor or none made asking needless.
        outcome: What was committed; None while pending.
        elected: The key that was committed, if any.
        ranked: The ranker's full record, also where a person overrode it.
        override: The person's answer, if one was committed.
        pending: Whether it still waits for its answer.
        wall_s: Wall-clock facts by name.
    """

    number: int
    exchange: int
    step: int
    facts: Facts
    question: Question | None
    outcome: Answered | None = None
    elected: Key | None = None
    ranked: Ranked | None = None
    override: Override | None = None
    pending: bool = False

    @property
    def slot(self) -> Slot:
        """The decision slot."""
        return self.facts.slot

    @property
    def lane(self) -> int:
        """Index into `LANES`."""
        return _LANE_OF[self.slot]

    @property
    def offered(self) -> tuple[Candidate, ...]:
        """The candidates that were put to the ranker, in canonical order."""
        return tuple(candidate for candidate in self.facts.candidates if candidate.feasible)

    @property
    def letters(self) -> dict[Key, str]:
        """Key → letter of the recorded presentation; nothing that was not offered has one.

        These are the letters of the question's text, so card, frustum and prompt agree.
        """
        if self.question is None:
            return {candidate.key: "A" for candidate in self.offered}
        return {key: label for label, key in labelled(seeded_order(self.question))}


def decisions_of(exchanges: Sequence[Exchange], pending: Request | None) -> tuple[Decision, ...]:
    """All decisions in order, the pending one last."""
    made = [_made(exchange) for exchange in exchanges if exchange.decision is not None]
    if isinstance(pending, Ask):
        step = _steps_after(exchanges)
        made.append(_pending(pending, number=len(made), exchange=len(exchanges), step=step))
    return tuple(made)


def _made(exchange: Exchange) -> Decision:
    request = exchange.request
    number = exchange.decision if exchange.decision is not None else -1
    if isinstance(request, Note) and isinstance(request.record, Unasked):
        record = request.record
        return Decision(
            number, exchange.index, exchange.step, record.facts, None, elected=record.elected
        )
    if not isinstance(request, Ask):
        message = f"expected a question at decision {number}, came {type(request).__name__}"
        raise TypeError(message)
    outcome = exchange.override.outcome if exchange.override else _answer(exchange)
    return Decision(
        number,
        exchange.index,
        exchange.step,
        request.facts,
        request.question,
        outcome=outcome,
        elected=outcome.winner if isinstance(outcome, Ordering) else None,
        ranked=exchange.ranked,
        override=exchange.override,
    )


def _answer(exchange: Exchange) -> Answered | None:
    if exchange.ranked is not None:
        return exchange.ranked.outcome
    response = exchange.response
    return None if isinstance(response, Seen | Moved) else response


def _pending(ask: Ask, *, number: int, exchange: int, step: int) -> Decision:
    return Decision(number, exchange, step, ask.facts, ask.question, pending=True)


def _steps_after(exchanges: Sequence[Exchange]) -> int:
    if not exchanges:
        return 0
    last = exchanges[-1]
    moved = getattr(last.response, "steps", ()) if isinstance(last.request, Move) else ()
    return last.step + len(moved)
