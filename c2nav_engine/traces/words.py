"""Outcomes and decisions in words, for log lines and exports."""

from __future__ import annotations

from c2nav_engine.contract.outcome import (
    Abstention,
    Answered,
    Cardinal,
    Invalid,
    Ordering,
    Tie,
    TransportFailure,
)
from c2nav_engine.traces.contract_messages import outcome_of
from c2nav_engine.traces.pb.decision_pb2 import Decision


def outcome_words(outcome: Answered) -> str:
    """An outcome on one line: "left > front = right", "abstention: orders disagree"."""
    if isinstance(outcome, Ordering | Tie):
        return " > ".join(" = ".join(tier) for tier in outcome.tiers)
    if isinstance(outcome, Cardinal):
        return f"{outcome.value:g}"
    name = type(outcome).__name__.lower()
    if isinstance(outcome, Abstention | Invalid | TransportFailure):
        return f"{name}: {outcome.reason}"
    return name


def committed_words(decision: Decision) -> str:
    """What the loop was sent, and by whom."""
    if not decision.HasField("question"):
        elected = decision.elected if decision.HasField("elected") else "nothing to elect"
        return f"{elected} (no question)"
    words = outcome_words(outcome_of(decision.committed))
    if decision.by == "override":
        return f"{words} (by {decision.override.who})"
    return f"{words} ({decision.ranked.ranker})" if decision.HasField("ranked") else words


def winner_of(decision: Decision) -> str:
    """The key that the decision came to, "" when it selected nothing."""
    if not decision.HasField("question"):
        return decision.elected
    outcome = outcome_of(decision.committed)
    return outcome.winner if isinstance(outcome, Ordering) else ""


def prompt_words(decision: Decision) -> str:
    """The first query as sent, each picture named by the start of its digest."""
    for query in decision.ranked.queries[:1]:
        return "".join(
            part.text if part.HasField("text") else f"[picture {part.picture[:12]}]"
            for part in query.parts
        )
    return ""
