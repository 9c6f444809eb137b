"""Where two recorded episodes part: the first difference in a question, an answer or a motion."""

from __future__ import annotations

import enum
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest

from c2nav_engine.contract.outcome import Answered, Cardinal, Ordering
from c2nav_engine.navigator.requests import Ask, Move, Moved, Note, Seen, Stop, Unasked
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.replaying import difference


class Part(enum.StrEnum):
    """What differs first."""

    QUESTION = "question"
    """What was asked: words, pictures, alternatives, or whether anything was asked at all."""
    ANSWER = "answer"
    """What was committed to the same question."""
    MOTION = "motion"
    """What was walked, or how the episode ended, after the same answer."""


@dataclass(frozen=True, slots=True)
class Parting:
    """The first difference of two episodes.

    Attributes:
        part: What differs.
        decision: Number of the newest decision in each up to there; −1 before the first.
        step: Low-level actions executed before it, in each.
        field: Where inside it, as a path.
        first: Its value in the first episode, in short.
        second: Its value in the second.
    """

    part: Part
    decision: tuple[int, int]
    step: tuple[int, int]
    field: str
    first: str
    second: str


def parting(first: Sequence[Exchange], second: Sequence[Exchange]) -> Parting | None:
    """Compare two episodes act by act; None when they never part.

    The order in which alternatives were shown is no difference: two seeds ask the same question.
    What the controller only noted, and what it looked at without asking, is none either.
    """
    decision, step = (-1, -1), (0, 0)
    for a, b in zip_longest(_acts(first), _acts(second)):
        decision = (_number(a, decision[0]), _number(b, decision[1]))
        step = (step[0] if a is None else a.step, step[1] if b is None else b.step)
        found = _difference(a, b)
        if found is not None:
            part, (field, one, other) = found
            return Parting(part, decision, step, field, one, other)
    return None


def said_words(outcome: Answered | None) -> str:
    """An outcome in a few words, by keys."""
    if isinstance(outcome, Ordering):
        return f"elects {outcome.winner}"
    if isinstance(outcome, Cardinal):
        return f"says {outcome.value:g}"
    name = type(outcome).__name__.lower()
    reason = getattr(outcome, "reason", "")
    return f"{name}: {reason}" if reason else name


_Found = tuple[Part, tuple[str, str, str]]


def _acts(exchanges: Sequence[Exchange]) -> list[Exchange]:
    """Decisions and motions, which alone decide how an episode goes on."""
    return [
        exchange
        for exchange in exchanges
        if isinstance(exchange.request, Ask | Move | Stop) or exchange.decision is not None
    ]


def _number(exchange: Exchange | None, before: int) -> int:
    return before if exchange is None or exchange.decision is None else exchange.decision


def _difference(a: Exchange | None, b: Exchange | None) -> _Found | None:
    if a is None or b is None:
        return Part.MOTION, ("", _act_words(a), _act_words(b))
    if a.decision is not None or b.decision is not None:
        return _decided_differently(a, b)
    return _moved_differently(a, b)


def _decided_differently(a: Exchange, b: Exchange) -> _Found | None:
    one, other = a.request, b.request
    if not (isinstance(one, Ask) and isinstance(other, Ask)):
        same = difference(_unasked(a), _unasked(b)) is None and type(one) is type(other)
        return None if same else (Part.QUESTION, ("", _act_words(a), _act_words(b)))
    if one.question.slot is not other.question.slot:
        return Part.QUESTION, ("", _act_words(a), _act_words(b))
    asked = difference(
        replace(one.question, shuffle_seed=0), replace(other.question, shuffle_seed=0)
    )
    if asked is not None:
        return Part.QUESTION, asked
    said = [said_words(answer_of(exchange)) for exchange in (a, b)]
    return None if said[0] == said[1] else (Part.ANSWER, ("", said[0], said[1]))


def _unasked(exchange: Exchange) -> tuple[str, str | None] | None:
    record = exchange.request.record if isinstance(exchange.request, Note) else None
    return (record.facts.slot.value, record.elected) if isinstance(record, Unasked) else None


def _moved_differently(a: Exchange, b: Exchange) -> _Found | None:
    words = [_act_words(exchange) for exchange in (a, b)]
    if words[0] != words[1]:
        return Part.MOTION, ("actions", words[0], words[1])
    walked = difference(a.response, b.response, "achieved")
    return None if walked is None else (Part.MOTION, walked)


def answer_of(exchange: Exchange) -> Answered | None:
    """What a question's exchange committed."""
    response = exchange.response
    return None if isinstance(response, Seen | Moved) else response


def _act_words(exchange: Exchange | None) -> str:
    if exchange is None:
        return "is over"
    request = exchange.request
    if isinstance(request, Ask):
        return f"asks {request.question.slot.value}"
    if isinstance(request, Move):
        return " ".join(action.value for action in request.actions)
    if isinstance(request, Stop):
        return "stops"
    found = _unasked(exchange)
    return "" if found is None else f"takes {found[1] or 'nothing'} without asking ({found[0]})"
