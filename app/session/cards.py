"""The decision in view as cards: what was offered, what was vetoed, who stands first."""

from __future__ import annotations

from typing import Any

from app.session.decisions import LANES, Decision
from app.session.draft import outcome_of
from app.session.snapshot import Snapshot
from app.session.wording import SIGNS, key_words, ordinal, outcome_words, slot_words
from c2nav_engine.contract.outcome import Answered, Key, Ordering, Tie
from c2nav_engine.navigator.requests import Candidate

Json = dict[str, Any]


def decision_json(snapshot: Snapshot) -> Json | None:
    """Everything that `<rank-strip>` and `<image-pair>` draw; None before the first decision."""
    decision = snapshot.decision
    if decision is None:
        return None
    said = said_of(snapshot, decision)
    ranks = ranks_of(said)
    return {
        "number": decision.number,
        "total": len(snapshot.story.decisions),
        "slot": decision.slot.value,
        "words": slot_words(decision.slot),
        "lane": LANES[decision.lane],
        "sign": SIGNS[decision.lane],
        "leg": decision.facts.leg,
        "pending": decision.pending,
        "here": snapshot.here.at_decision,
        "asked": decision.question is not None,
        "contested": decision.facts.contested,
        "orders": decision.question.orders.value if decision.question else "",
        "source": _source(snapshot, decision),
        "outcome": outcome_words(said, decision.letters),
        "cards": [_card(c, decision, ranks) for c in decision.facts.candidates],
        "context": [
            {"words": words, "sha": picture.sha256}
            for words, picture in (decision.question.context if decision.question else ())
        ],
    }


def said_of(snapshot: Snapshot, decision: Decision) -> Answered | None:
    """The outcome on show: the person's draft, else what was committed, else the proposal."""
    if not snapshot.draft.empty:
        return outcome_of(snapshot.draft, tuple(c.key for c in decision.offered))
    if decision.outcome is not None:
        return decision.outcome
    if decision.elected is not None:
        return Ordering(((decision.elected,),))
    return snapshot.proposal.outcome if snapshot.proposal else None


def ranks_of(outcome: Answered | None) -> dict[Key, int]:
    """Key → rank from 1; keys of one tier share it."""
    if not isinstance(outcome, Ordering | Tie):
        return {}
    ranks: dict[Key, int] = {}
    for tier in outcome.tiers:
        rank = len(ranks) + 1
        ranks.update(dict.fromkeys(tier, rank))
    return ranks


def _source(snapshot: Snapshot, decision: Decision) -> str:
    """Whose ranking is on show."""
    if not snapshot.draft.empty:
        return "draft"
    if decision.override is not None:
        return "override"
    if decision.pending:
        return "proposal" if snapshot.proposal else "waiting"
    return "committed" if decision.question else "unasked"


def _card(candidate: Candidate, decision: Decision, ranks: dict[Key, int]) -> Json:
    rank = ranks.get(candidate.key)
    picture = candidate.picture
    alternative = None
    if decision.question is not None:
        found = [a for a in decision.question.alternatives if a.key == candidate.key]
        alternative = found[0] if found else None
        picture = picture or (alternative.picture if alternative else None)
    return {
        "key": candidate.key,
        "name": key_words(candidate.key),
        "letter": decision.letters.get(candidate.key, ""),
        "sha": picture.sha256 if picture else "",
        "width": picture.width_px if picture else 0,
        "height": picture.height_px if picture else 0,
        "text": alternative.text if alternative else "",
        "free_m": None if candidate.free_m is None else round(candidate.free_m, 2),
        "feasible": candidate.feasible,
        "veto": candidate.veto,
        "rank": rank,
        "ordinal": ordinal(rank) if rank else "",
    }
