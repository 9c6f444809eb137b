"""Disagreements: between orders, model and person or re-evaluation, committed and best."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Literal

from app.session.decisions import Decision
from app.session.reasked import Reasked
from app.session.snapshot import SUSPECT_M, Assessment, Snapshot
from app.session.wording import is_fault
from c2nav_engine.contract.outcome import ORDERS_DISAGREE, Abstention, Answered, Key, Ordering

Kind = Literal["any", "orders", "person", "reasked", "best"]

KINDS: Mapping[Kind, str] = {
    "any": "any disagreement",
    "orders": "two presentation orders",
    "person": "model and person",
    "reasked": "model and re-evaluation",
    "best": "committed and best offered",
}


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


def best_differs(assessment: Assessment | None) -> bool:
    """Whether something better was offered than what was committed."""
    return assessment is not None and (assessment.regret_m or 0.0) >= SUSPECT_M


def reasked_differ(decision: Decision, reasked: Iterable[Reasked]) -> tuple[Reasked, ...]:
    """Answers of a re-evaluation that elect something else than the recorded ranker did.

    An answer that cannot be used says nothing against the recorded one.
    """
    if decision.ranked is None:
        return ()
    recorded = winner(decision.ranked.outcome)
    return tuple(
        answer
        for answer in reasked
        if winner(answer.outcome) != recorded and not is_fault(answer.outcome)
    )


def disagrees(snapshot: Snapshot, decision: Decision, kind: Kind) -> bool:
    """Whether a decision of the branch in view shows a disagreement of a kind."""
    number = decision.number
    found = {
        "orders": orders_differ(decision),
        "person": person_differs(decision),
        "reasked": bool(reasked_differ(decision, snapshot.reasked_at(number))),
        "best": best_differs(snapshot.assessments.get(number)),
    }
    return any(found.values()) if kind == "any" else found[kind]
