"""Answers that were given elsewhere come back: all of a file, or nothing of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from app.reviews.events import Event, Kind
from app.reviews.state import standing
from app.reviews.store import Store
from app.reviews.study import Study
from c2nav_engine.errors import UsageError


def import_answers(study: Study, store: Store, events: Sequence[Event], *, where: str) -> int:
    """Add a person's answers to the store; returns how many events were in the file.

    Authors are expected under their pseudonyms, as exports write them. What was said outside any
    study, in the inspector, comes along as it is; there authors may be strangers.

    Raises:
        UsageError: An event is of another study, trace or decision than its place says, comes from
            nobody of the study, or answers a place that is answered already. Nothing is added.
    """
    names = {person.pseudonym: person for person in study.people()}
    with store.writing() as writing:
        held = [event for _, event in writing.events() if event.extra.get("study") == study.name]
        answered = {place for event in standing(held) if (place := _place(event))}
        for event in events:
            if "study" not in event.extra:
                known = names.get(event.author)
                writing.append(replace(event, author=known.name if known else event.author))
                continue
            problem = _problem(study, event, names.get(event.author) is not None)
            person = names.get(event.author)
            if problem or person is None:
                raise UsageError(f"{where}: event {event.id}: {problem}")
            if event.extra["queue"] != person.queue:
                raise UsageError(f"{where}: event {event.id}: expected queue {person.queue}")
            writing.append(replace(event, author=person.name))
        for event in standing(events):
            if "study" not in event.extra:
                continue
            place = _place(event)
            if place in answered:
                message = f"{where}: place {event.extra['place']} of {event.author} is answered"
                raise UsageError(f"{message} already; expected every item once")
            if place is not None:
                answered.add(place)
    return len(events)


def _place(event: Event) -> tuple[str, str] | None:
    if event.kind is not Kind.RANKING:
        return None
    return event.extra.get("queue", ""), event.extra.get("place", "")


def _problem(study: Study, event: Event, known: bool) -> str:
    if not known:
        return f"expected a person of study {study.name}, came {event.author!r}"
    if event.kind in (Kind.UNDO, Kind.REDO):
        return "" if event.extra.get("queue") else "expected the queue it belongs to"
    if event.kind is not Kind.RANKING or event.said is None:
        return f"expected an answer, came {event.kind.value}"
    if event.extra.get("study_sha256") != study.sha256:
        return (
            f"expected study {study.sha256[:12]}, came {event.extra.get('study_sha256', '')[:12]}"
        )
    queue = study.queue(event.extra.get("queue", ""))
    place = event.extra.get("place", "")
    if not place.isdecimal() or int(place) >= len(queue):
        return f"expected a place from 0 to {len(queue) - 1}, came {place!r}"
    item = study.items[queue[int(place)].item]
    if (event.trace_sha256, event.decision) != (item.trace_sha256, item.decision):
        return (
            f"expected decision {item.decision} of trace {item.trace_sha256[:12]}, "
            f"came {event.decision} of {event.trace_sha256[:12]}"
        )
    return ""
