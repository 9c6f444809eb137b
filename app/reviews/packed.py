"""Answers from a packed page: its own lines become the events that the judging page would store.

The page knows neither keys nor digests of traces, so that its file tells no more than a question
does. What it returns names the study and, place by place, what was really shown.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from app.reviews.events import Event
from app.reviews.questions import prompt_at, shown_sha256
from app.reviews.study import Person, Study
from app.reviews.submissions import Submission, answer_event, checked, undo_event
from c2nav_engine.contract.prompt import Prompt
from c2nav_engine.errors import UsageError

SCHEMA = 1


def packed_study(
    study: Study,
    person: Person,
    questions: Iterable[tuple[Prompt, Mapping[str, Any]]],
    *,
    answered: Iterable[int],
) -> dict[str, Any]:
    """What the packed page's script reads.

    Args:
        study: The study.
        person: Who judges.
        questions: For each place of their queue, its prompt and what the page shows of it.
        answered: Places that are answered already; the page passes over them.
    """
    return {
        "packed": SCHEMA,
        "study": study.name,
        "study_sha256": study.sha256,
        "person": person.pseudonym,
        "answered": sorted(answered),
        "questions": [
            {"sha256": shown_sha256(prompt), "question": dict(shown)} for prompt, shown in questions
        ],
    }


class _Line(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)

    packed: int
    study_sha256: str
    person: str
    id: str = Field(pattern="^[0-9a-f]{16,64}$")
    when_s: float = Field(ge=0.0)
    place: int = Field(ge=0)


class _Answer(_Line):
    question_sha256: str
    tiers: list[list[str]] = Field(max_length=26)
    response_ms: int = Field(ge=0, le=10**9)
    hidden_ms: int = Field(ge=0, le=10**9)


class _Undo(_Line):
    undo: bool


def is_packed(lines: Sequence[str]) -> bool:
    """Whether lines come from a packed page rather than from an export."""
    first = next((line for line in lines if line.strip()), "")
    try:
        read = json.loads(first or "null")
    except ValueError:
        return False
    return isinstance(read, dict) and "packed" in read


def packed_events(study: Study, lines: Sequence[str], *, where: str) -> list[Event]:
    """The events of a packed page's answers, authors under their pseudonyms.

    Raises:
        UsageError: A line is no answer, or is of another study, person or question than it says.
    """
    people = {person.pseudonym: person for person in study.people()}
    events: list[Event] = []
    answers: dict[str, Event] = {}
    about: Counter[str] = Counter()
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        at = f"{where}, line {number}"
        read = _read(line, at)
        person = _person(study, people, read, at)
        if isinstance(read, _Undo):
            event = _undone(read, answers, about, at)
        else:
            event = _answered(study, person, read, at)
            if read.id in answers:
                raise UsageError(f"{at}: expected every answer once, came {read.id} again")
            answers[read.id] = event
        events.append(event)
    return events


def _read(line: str, at: str) -> _Answer | _Undo:
    try:
        kind = _Undo if '"undo"' in line else _Answer
        return kind.model_validate_json(line)
    except ValidationError as error:
        first = str(error).splitlines()[0]
        message = f"expected an answer of a packed page in {at}, came {line[:80]!r} ({first})"
        raise UsageError(message) from None


def _person(study: Study, people: Mapping[str, Person], read: _Line, at: str) -> Person:
    if (read.packed, read.study_sha256) != (SCHEMA, study.sha256):
        message = (
            f"{at}: expected study {study.sha256[:12]} ({study.name}), came "
            f"{read.study_sha256[:12]}; import it where its page was packed"
        )
        raise UsageError(message)
    if read.person not in people:
        raise UsageError(f"{at}: expected a person of study {study.name}, came {read.person!r}")
    person = people[read.person]
    # Exports and packed pages name people by pseudonym; the import puts names back.
    return Person(person.pseudonym, person.pseudonym, person.queue, person.token_sha256)


def _answered(study: Study, person: Person, read: _Answer, at: str) -> Event:
    tiers = tuple(tuple(tier) for tier in read.tiers)
    answer = Submission(read.id, read.place, tiers, read.response_ms, read.hidden_ms)
    place = checked(answer, study.queue(person.queue))
    prompt = prompt_at(study, place)
    shown = shown_sha256(prompt)
    if shown != read.question_sha256:
        message = (
            f"{at}: expected question {shown[:12]} at place {read.place}, came "
            f"{read.question_sha256[:12]}: this person was shown something else"
        )
        raise UsageError(message)
    return answer_event(study, person, answer, place=place, prompt=prompt, when_s=read.when_s)


def _undone(read: _Undo, answers: Mapping[str, Event], about: Counter[str], at: str) -> Event:
    answer = answers.get(read.id)
    if answer is None:
        raise UsageError(f"{at}: expected an earlier answer to take back, came {read.id}")
    event = undo_event(answer, before=about[read.id], when_s=read.when_s)
    about[read.id] += 1
    return event
