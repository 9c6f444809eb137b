"""What holds after all events: a pure replay of the list."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

from app.reviews.events import VERDICTS, Event, Kind
from c2nav_engine.contract.outcome import Said

Place = tuple[str, str, int]
"""Author, trace digest, decision."""


@dataclass(frozen=True, slots=True)
class Opinion:
    """What one person now says about one decision.

    Attributes:
        ranking: Their own answer, or None.
        verdict: "agree", "acceptable", "wrong", "cannot-tell" or "".
        better: The better alternative, or None.
        tags: In the order they were put on.
        leg_ends_m: Leg → metres along the path.
        note: Free words.
        blind: Whether everything here was said with the model's answer hidden.
    """

    ranking: Said | None = None
    verdict: str = ""
    better: Said | None = None
    tags: tuple[str, ...] = ()
    leg_ends_m: dict[int, float] = field(default_factory=dict[int, float])
    note: str = ""
    blind: bool = True


def standing(events: Iterable[Event]) -> list[Event]:
    """The events that hold, in order: everything said, but for what was taken back.

    An undo or redo without its target, of somebody else's event, or of another undo or redo, does
    nothing.
    """
    said: dict[str, Event] = {}
    gone: set[str] = set()
    for event in events:
        if event.kind not in (Kind.UNDO, Kind.REDO):
            said.setdefault(event.id, event)
        elif event.target in said and said[event.target].author == event.author:
            (gone.add if event.kind is Kind.UNDO else gone.discard)(event.target)
    return [event for name, event in said.items() if name not in gone]


def opinions(events: Iterable[Event]) -> dict[Place, Opinion]:
    """What everybody now says, by person and decision."""
    held: dict[Place, Opinion] = {}
    for event in standing(events):
        place = (event.author, event.trace_sha256, event.decision)
        held[place] = _after(held.get(place, Opinion()), event)
    return held


def last_to_undo(events: Sequence[Event], author: str) -> Event | None:
    """The newest standing event of a person: what their undo takes back."""
    mine = [event for event in standing(events) if event.author == author]
    return mine[-1] if mine else None


def last_to_redo(events: Sequence[Event], author: str) -> Event | None:
    """What a person took back last, if nothing new was said since."""
    undone: list[str] = []
    for event in (event for event in events if event.author == author):
        if event.kind is Kind.UNDO:
            undone.append(event.target)
        elif event.kind is Kind.REDO:
            undone = [target for target in undone if target != event.target]
        else:
            undone.clear()
    by_id = {event.id: event for event in events}
    return by_id.get(undone[-1]) if undone else None


def _after(opinion: Opinion, event: Event) -> Opinion:
    if event.kind is Kind.REVEAL:
        return opinion
    opinion = replace(opinion, blind=opinion.blind and event.blind)
    if event.kind in VERDICTS:
        return replace(opinion, verdict=event.kind.value)
    match event.kind:
        case Kind.RANKING:
            return replace(opinion, ranking=event.said)
        case Kind.BETTER:
            return replace(opinion, better=event.said)
        case Kind.TAG:
            return replace(opinion, tags=_toggled(opinion.tags, event.extra.get("tag", "")))
        case Kind.LEG_END:
            end = {int(event.extra["leg"]): float(event.extra["at_m"])}
            return replace(opinion, leg_ends_m=opinion.leg_ends_m | end)
        case _:
            return replace(opinion, note=event.reason)


def _toggled(tags: tuple[str, ...], tag: str) -> tuple[str, ...]:
    return tuple(each for each in tags if each != tag) if tag in tags else (*tags, tag)
