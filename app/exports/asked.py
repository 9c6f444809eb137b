"""A decision in full: the question as it was sent, every answer in every order, what followed."""

from __future__ import annotations

from typing import Any

from app.exports.family import Member
from app.session.branches import cost_of
from app.session.decisions import Decision
from app.session.differing import winner
from app.session.wording import (
    degrees,
    is_fault,
    key_words,
    motion_words,
    outcome_words,
    plural,
    seconds,
)
from c2nav_engine.contract.prompt import Part, Query
from c2nav_engine.contract.render import render
from c2nav_engine.errors import C2NavError
from c2nav_engine.navigator.requests import Move, Moved

Json = dict[str, Any]


def asked_json(member: Member, decision: Decision) -> Json:
    """Everything below the cards."""
    queries = decision.ranked.queries if decision.ranked else ()
    override = decision.override
    return {
        "question": _question(decision),
        "ranker": decision.ranked.ranker if decision.ranked else "",
        "privileged": bool(decision.ranked and decision.ranked.privileged),
        "answers": [_answer(query, decision) for query in queries],
        "outcome": outcome_words(decision.ranked.outcome, decision.letters)
        if decision.ranked
        else "",
        "override": ""
        if override is None
        else f"{override.who}: {outcome_words(override.outcome, decision.letters)} {override.why}",
        "committed": _rows(
            ("outcome", _committed(decision)),
            ("motion", _motion(member, decision)),
            ("cost", _cost(decision)),
        ),
        "controller": _controller(decision),
    }


def _rows(*rows: tuple[str, str]) -> list[tuple[str, str]]:
    return [row for row in rows if row[1]]


def _question(decision: Decision) -> list[str | Json]:
    """The parts of the recorded presentation, pictures by digest."""
    if decision.question is None:
        return []
    queries = decision.ranked.queries if decision.ranked else ()
    try:
        parts = queries[0].prompt.parts if queries else render(decision.question).parts
    except C2NavError as error:
        return [str(error)]
    return [_part(part) for part in parts]


def _part(part: Part) -> str | Json:
    return part if isinstance(part, str) else {"sha": part.sha256}


def _answer(query: Query, decision: Decision) -> Json:
    """One query: what was shown first, what came back, what it meant in the card's letters."""
    first = decision.ranked.queries[0].outcome if decision.ranked else None
    reply = query.reply
    tokens = (reply.tokens_in or 0) + (reply.tokens_out or 0)
    return {
        "order": query.prompt.order,
        "attempt": query.prompt.repair,
        "shown": [
            {"label": label, "letter": decision.letters.get(key, "?"), "name": key_words(key)}
            for label, key in query.prompt.labels
        ],
        "raw": reply.text,
        "outcome": outcome_words(query.outcome, decision.letters),
        "differs": winner(query.outcome) not in (winner(first), None),
        "fault": is_fault(query.outcome),
        "cost": " · ".join([*([plural(tokens, "token")] if tokens else []), reply.model]).strip(
            " ·"
        ),
    }


def _committed(decision: Decision) -> str:
    if decision.question is not None:
        return outcome_words(decision.outcome, decision.letters)
    only = decision.elected
    return f"not asked: {key_words(only)} was the only view left" if only else "no view was left"


def _motion(member: Member, decision: Decision) -> str:
    end = member.story.end_of(decision.number)
    turn_rad = member.story.header.profile.turn_rad
    for exchange in member.branch.exchanges[decision.exchange : end]:
        if isinstance(exchange.request, Move) and isinstance(exchange.response, Moved):
            return motion_words(exchange.response.steps, turn_rad)
    return ""


def _cost(decision: Decision) -> str:
    cost = cost_of((decision,))
    words = [plural(cost.queries, "query")] if cost.queries else []
    words += [plural(cost.tokens, "token")] if cost.tokens else []
    words += [seconds(cost.seconds)] if cost.queries else []
    return " · ".join(words)


def _controller(decision: Decision) -> list[tuple[str, str]]:
    facts = decision.facts
    return _rows(
        ("cycle", f"{facts.cycle}, leg {facts.leg + 1}"),
        ("travelled", f"{facts.travelled_m:.1f} m, {facts.leg_travelled_m:.1f} m in this leg"),
        (
            "views",
            ", ".join(
                f"{key_words(each.key)} {degrees(each.offset_rad)}"
                for each in facts.candidates
                if each.offset_rad
            ),
        ),
        *facts.notes.items(),
    )
