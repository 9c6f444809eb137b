"""A person's answer to a place of a study, from a page to an event."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from app.reviews.events import Event, Kind
from app.reviews.questions import question_id
from app.reviews.queues import Place
from app.reviews.study import Person, Study
from c2nav_engine.contract.outcome import Abstention, Said, ranking_of
from c2nav_engine.contract.prompt import Prompt
from c2nav_engine.errors import UsageError

NONE = "none"
"""Reason of the abstention of a person who finds no alternative better."""

_EVENT_ID = re.compile(r"[0-9a-f]{16,64}")


@dataclass(frozen=True, slots=True)
class Submission:
    """An answer as it comes from a page.

    Attributes:
        id: Random hex that names this answer; sending it twice stores it once.
        number: The place that is answered.
        tiers: Labels from best to worst; () for none. Labels left out are tied behind.
        response_ms: From the question being drawn to the answer, tab in front or not.
        hidden_ms: Of these, with the tab hidden.
    """

    id: str
    number: int
    tiers: tuple[tuple[str, ...], ...]
    response_ms: int = 0
    hidden_ms: int = 0


def checked(answer: Submission, queue: Sequence[Place]) -> Place:
    """The place that is answered; raises `UsageError` where there is none, or for an odd id."""
    if not _EVENT_ID.fullmatch(answer.id):
        message = f"expected an id of 16 to 64 hexadecimal digits, came {answer.id!r}"
        raise UsageError(message)
    if not 0 <= answer.number < len(queue):
        message = f"expected a place from 0 to {len(queue) - 1}, came {answer.number}"
        raise UsageError(message)
    return queue[answer.number]


def answer_event(
    study: Study, person: Person, answer: Submission, *, place: Place, prompt: Prompt, when_s: float
) -> Event:
    """The event that an answer is stored as; raises `UsageError` when it answers nothing."""
    item = study.items[place.item]
    return Event(
        id=f"{study.name}.{person.pseudonym}.{answer.id}",
        kind=Kind.RANKING,
        author=person.name,
        trace_sha256=item.trace_sha256,
        decision=item.decision,
        said=said_by(answer.tiers, prompt),
        when_s=when_s,
        extra={
            "study": study.name,
            "study_sha256": study.sha256,
            "queue": person.queue,
            "place": str(answer.number),
            "again": "yes" if place.again else "no",
            "episode": item.episode,
            "slot": item.slot,
            "question": question_id(prompt.question),
            "shown": " ".join(key for _, key in prompt.labels),
            "response_ms": str(answer.response_ms),
            "hidden_ms": str(answer.hidden_ms),
        },
    )


def undo_event(answer: Event, *, before: int, when_s: float) -> Event:
    """An answer is taken back.

    Args:
        answer: Its event.
        before: How many events were about it already.
        when_s: Wall clock.
    """
    return Event(
        id=f"{answer.id}.undo{before}",
        kind=Kind.UNDO,
        author=answer.author,
        trace_sha256=answer.trace_sha256,
        decision=answer.decision,
        target=answer.id,
        when_s=when_s,
        extra={name: answer.extra[name] for name in ("study", "queue")},
    )


def said_by(tiers: Sequence[Sequence[str]], prompt: Prompt) -> Said:
    """Labels from best to worst as an answer over keys; raises `UsageError`.

    Labels that are left out are tied behind; no label at all means none of them.
    """
    if not tiers:
        return Abstention(NONE)
    keys = dict(prompt.labels)
    named = [label for tier in tiers for label in tier]
    if not all(tiers) or len(set(named)) < len(named) or not set(named) <= keys.keys():
        message = f"expected tiers of distinct labels among {', '.join(keys)}; came {named}"
        raise UsageError(message)
    ranked = tuple(tuple(keys[label] for label in tier) for tier in tiers)
    return ranking_of(ranked, keys.values())
