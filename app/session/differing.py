"""Disagreements: between presentation orders, between model and person."""

from __future__ import annotations

from app.session.decisions import Decision
from c2nav_engine.contract.outcome import ORDERS_DISAGREE, Abstention, Answered, Key, Ordering


def winner(outcome: Answered | None) -> Key | None:
    """What an outcome elects, if anything."""
    return outcome.winner if isinstance(outcome, Ordering) else None


def orders_differ(decision: Decision) -> bool:
    """Whether two presentation orders gave two winners."""
    if decision.ranked is None:
        return False
    if decision.ranked.outcome == Abstention(ORDERS_DISAGREE):
        return True
    winners = {winner(query.outcome) for query in decision.ranked.queries} - {None}
    return len(winners) > 1


def person_differs(decision: Decision) -> bool:
    """Whether a person elected something else than the ranker."""
    if decision.override is None or decision.ranked is None:
        return False
    return winner(decision.override.outcome) != winner(decision.ranked.outcome)


def disagrees(decision: Decision) -> bool:
    """Any of the kinds."""
    return orders_differ(decision) or person_differs(decision)
