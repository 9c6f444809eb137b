"""Several answers to one question become one outcome.

Nothing here knows in which order the presentations came: swapping them leaves the verdict.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from c2nav_engine.contract.outcome import (
    ORDERS_DISAGREE,
    Abstention,
    Answered,
    Cardinal,
    Empty,
    Invalid,
    Key,
    Ordering,
    Refused,
    Tie,
    TransportFailure,
    Truncated,
    ranking_of,
)
from c2nav_engine.contract.question import Orders, Question
from c2nav_engine.errors import InternalError

TOO_FEW_ANSWERS = "fewer than two valid answers"
"""Reason of the abstention of a contested election that cannot be counted."""

_PRECEDENCE = (
    TransportFailure,
    Refused,
    Invalid,
    Truncated,
    Empty,
    Abstention,
    Tie,
    Ordering,
    Cardinal,
)
"""Which non-answer speaks for a pair: a fixed rank, so that the order of asking does not."""


def aggregate(question: Question, outcomes: Sequence[Answered]) -> Answered:
    """The outcome of the question over its presentations' outcomes."""
    if not outcomes:
        message = f"expected at least one outcome for the slot {question.slot.value}, came none"
        raise InternalError(message)
    if len(outcomes) == 1:
        return outcomes[0]
    if question.orders is Orders.CYCLIC:
        return borda(question.keys, outcomes)
    return agreement(question.keys, outcomes)


def agreement(keys: Sequence[Key], outcomes: Sequence[Answered]) -> Answered:
    """One winner in every order, else `Abstention(ORDERS_DISAGREE)`, else the worst non-answer."""
    orderings = [outcome for outcome in outcomes if isinstance(outcome, Ordering)]
    if len(orderings) < len(outcomes):
        return min(outcomes, key=_rank)
    winners = {ordering.winner for ordering in orderings}
    if len(winners) > 1:
        return Abstention(ORDERS_DISAGREE)
    (winner,) = winners
    rest = tuple(tier for tier in _tiers(keys, orderings) if winner not in tier)
    return Ordering(((winner,), *rest))


def borda(keys: Sequence[Key], outcomes: Sequence[Answered]) -> Answered:
    """The Borda count over the valid answers; equal top scores are a `Tie`."""
    orderings = [outcome for outcome in outcomes if isinstance(outcome, Ordering)]
    if len(orderings) < 2:
        return Abstention(TOO_FEW_ANSWERS)
    return ranking_of(_tiers(keys, orderings))


def points(ordering: Ordering) -> dict[Key, Fraction]:
    """Borda points of one answer: m − 1 for the first … 0 for the last; a tier shares its own.

    The winner of a winner-only answer has m − 1, and the rest share what is left.
    """
    scores: dict[Key, Fraction] = {}
    below = len(ordering.keys)
    for tier in ordering.tiers:
        below -= len(tier)
        share = below + Fraction(len(tier) - 1, 2)
        scores.update(dict.fromkeys(tier, share))
    return scores


def _tiers(keys: Sequence[Key], orderings: Sequence[Ordering]) -> tuple[tuple[Key, ...], ...]:
    """Keys by total points, equal scores tied, in the controller's order within a tier."""
    counts = [points(ordering) for ordering in orderings]
    totals = {key: sum((count[key] for count in counts), Fraction(0)) for key in keys}
    return tuple(
        tuple(key for key in keys if totals[key] == score)
        for score in sorted(set(totals.values()), reverse=True)
    )


def _rank(outcome: Answered) -> tuple[int, str]:
    return (_PRECEDENCE.index(type(outcome)), repr(outcome))
