"""The decision in view as cards: what was offered, what was vetoed, who stands first."""

from __future__ import annotations

import re
from typing import Any

from app.session.decisions import LANES, Decision
from app.session.draft import outcome_of
from app.session.snapshot import Snapshot
from app.session.wording import SIGNS, key_words, ordinal, outcome_words, slot_words
from c2nav_engine.contract.outcome import Answered, Key, Ordering, Tie
from c2nav_engine.contract.prompt import Query
from c2nav_engine.contract.question import Slot
from c2nav_engine.navigator.requests import Candidate

Json = dict[str, Any]

_QUOTED = re.compile(r"<leg>(.*?)</leg>", re.DOTALL)


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
        "cards": [
            _card(c, decision, ranks) | _mark(snapshot, c) for c in decision.facts.candidates
        ],
        "context": _context(decision),
    }


def _mark(snapshot: Snapshot, candidate: Candidate) -> Json:
    """Where an asked place is in a candidate's picture."""
    place = snapshot.place
    if place is None or candidate.picture is None:
        return {"mark": None}
    return {"mark": place.marks.get(candidate.picture.sha256)}


def _context(decision: Decision) -> list[Json]:
    """Pictures that all alternatives share, the newest first."""
    context = decision.question.context if decision.question else ()
    return [{"words": words, "sha": picture.sha256} for words, picture in reversed(context)]


def lookback_json(snapshot: Snapshot) -> Json | None:
    """Everything that `<image-pair>` draws: the newest look-back question so far."""
    number = snapshot.here.decision
    for decision in reversed(snapshot.story.decisions[: number + 1]):
        if decision.slot is Slot.LOOKBACK:
            return _pair(snapshot, decision)
    return None


def _pair(snapshot: Snapshot, decision: Decision) -> Json:
    in_view = snapshot.here.decision == decision.number
    ranked = decision.ranked or (snapshot.proposal if in_view else None)
    said = said_of(snapshot, decision) if in_view else decision.outcome
    winner = said.winner if isinstance(said, Ordering) else None
    letters = decision.letters
    queries: list[Query] = list(ranked.queries) if ranked else []
    first = queries[0].outcome if queries else None
    return {
        "decision": decision.number,
        "cards": [
            {
                "key": alternative.key,
                "name": key_words(alternative.key),
                "letter": letters.get(alternative.key, ""),
                "sha": alternative.picture.sha256 if alternative.picture else "",
                "won": alternative.key == winner,
            }
            for alternative in (decision.question.alternatives if decision.question else ())
        ],
        "orders": [
            {
                "shown": " ".join(letters.get(key, "?") for _, key in query.prompt.labels),
                "said": outcome_words(query.outcome, letters),
                "differs": query.outcome != first,
            }
            for query in queries
        ],
    }


def said_of(snapshot: Snapshot, decision: Decision) -> Answered | None:
    """The outcome on show: the person's draft, else what was committed, else the proposal."""
    if not snapshot.draft.empty:
        return outcome_of(snapshot.draft, tuple(c.key for c in decision.offered))
    return answered(snapshot, decision)


def answered(snapshot: Snapshot, decision: Decision) -> Answered | None:
    """What was committed, else the proposal."""
    if decision.outcome is not None:
        return decision.outcome
    if decision.elected is not None:
        return Ordering(((decision.elected,),))
    return snapshot.proposal.outcome if snapshot.proposal else None


def winner_of(snapshot: Snapshot, decision: Decision) -> Key:
    """The alternative that was elected, or would be; "" where none is."""
    outcome = answered(snapshot, decision)
    return outcome.winner if isinstance(outcome, Ordering) else ""


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
        "text": _plain(alternative.text) if alternative else "",
        "free_m": None if candidate.free_m is None else round(candidate.free_m, 2),
        "feasible": candidate.feasible,
        "veto": candidate.veto,
        "rank": rank,
        "ordinal": ordinal(rank) if rank else "",
    }


def _plain(text: str) -> str:
    """An alternative's words without the marks around quoted legs."""
    return _QUOTED.sub("“\\1”", text)
