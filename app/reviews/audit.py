"""What people say in the inspector about one trace: events in the store beside it.

A trace that is still being made has no digest yet. What is said about it waits in memory and is
stored when the digest is known; nothing is ever tied to a trace that does not exist.
"""

from __future__ import annotations

import time
import uuid
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from app.reviews.events import Event, Kind
from app.reviews.state import Opinion, last_to_redo, last_to_undo, opinions, standing
from app.reviews.store import FILE, Store
from app.reviews.tags import read_tags, write_tags
from c2nav_engine.contract.outcome import Said

_NOTHING: Mapping[str, str] = {}

WHOLE = -1
"""Stands for the episode as a whole: leg ends belong to no decision. They are stored at decision 0,
because an event always names one."""


class AuditBook:
    """The reviews of one trace; answers of studies in the same store are left alone.

    Args:
        file: The store; made with the first word that is said.
        trace_sha256: Digest of the trace; "" while it is being made.
        clock: Seconds since the epoch.
    """

    def __init__(
        self, file: Path, trace_sha256: str = "", *, clock: Callable[[], float] = time.time
    ) -> None:
        self._file = file
        self._trace_sha256 = trace_sha256
        self._clock = clock
        self._events: list[Event] = []
        self._read = 0
        if trace_sha256 and file.is_file():
            self._add()

    def opinions(self) -> dict[tuple[str, int], Opinion]:
        """(Author, decision) → what they now say about it; leg ends stand under `WHOLE`."""
        found: dict[tuple[str, int], Opinion] = {}
        for (who, _, number), held in opinions(self._events).items():
            found[who, number] = replace(held, leg_ends_m={})
            if held.leg_ends_m:
                found[who, WHOLE] = Opinion(leg_ends_m=held.leg_ends_m, blind=held.blind)
        return found

    def seen_before(self, who: str) -> int:
        """Decisions, from 0, whose answers this person is known to have seen."""
        seen = [e.decision + 1 for e in self._events if e.author == who and e.model_seen]
        return max(seen, default=0)

    def add(
        self,
        kind: str,
        decision: int,
        *,
        who: str,
        seen: bool,
        said: Said | None = None,
        words: str = "",
        extra: Mapping[str, str] = _NOTHING,
    ) -> None:
        """Say something.

        Args:
            kind: A `Kind`.
            decision: Decision of the trace, from 0; or `WHOLE`.
            who: Who says it.
            seen: Whether they had seen the model's answer.
            said: The answer of a ranking, or of what would have been better.
            words: Free words.
            extra: Further facts.

        Raises:
            UsageError: The store cannot be written.
        """
        self._add(
            Event(
                id=uuid.uuid4().hex,
                kind=Kind(kind),
                author=who,
                trace_sha256=self._trace_sha256,
                decision=max(0, decision),
                said=said,
                reason=words,
                blind=not seen,
                model_seen=seen,
                when_s=self._clock(),
                extra=dict(extra),
            )
        )

    def take_back(self, decision: int, kinds: Sequence[str], *, who: str) -> None:
        """Take back whatever of these kinds the person now says about a decision."""
        for event in standing(self._events):
            if event.decision == decision and event.author == who and event.kind in kinds:
                self._about(event, Kind.UNDO)

    def undo(self, who: str) -> int | None:
        """Take the person's last word back; returns its decision."""
        return self._about(last_to_undo(self._undoable(), who), Kind.UNDO)

    def redo(self, who: str) -> int | None:
        """Say again what was taken back last; returns its decision."""
        return self._about(last_to_redo(self._undoable(), who), Kind.REDO)

    def bind(self, trace_sha256: str) -> None:
        """The trace is finished: store what was said about it."""
        if not self._trace_sha256 and trace_sha256:
            waiting, self._events = self._events, []
            self._trace_sha256 = trace_sha256
            if waiting:
                self._add(*(replace(event, trace_sha256=trace_sha256) for event in waiting))

    def tags(self) -> tuple[str, ...]:
        """The list of tags to choose from."""
        return read_tags(self._file.parent)

    def keep_tags(self, tags: Sequence[str]) -> None:
        """Replace the list of tags; those that were given stay given."""
        write_tags(self._file.parent, tags)

    def _undoable(self) -> list[Event]:
        """That an answer was shown cannot be taken back."""
        return [event for event in self._events if event.kind is not Kind.REVEAL]

    def _about(self, event: Event | None, kind: Kind) -> int | None:
        if event is None:
            return None
        self._add(
            Event(
                id=uuid.uuid4().hex,
                kind=kind,
                author=event.author,
                trace_sha256=self._trace_sha256,
                decision=event.decision,
                target=event.id,
                when_s=self._clock(),
            )
        )
        return WHOLE if event.kind is Kind.LEG_END else event.decision

    def _add(self, *events: Event) -> None:
        """Store events, and read whatever others have stored since."""
        if not self._trace_sha256:
            self._events += events
            return
        self._file.parent.mkdir(parents=True, exist_ok=True)
        with Store(self._file) as store, store.writing() as writing:
            for event in events:
                writing.append(event)
            for number, event in writing.events(after=self._read):
                self._read = number
                if event.trace_sha256 == self._trace_sha256 and "study" not in event.extra:
                    self._events.append(event)


def store_beside(trace: Path) -> Path:
    """The store for a trace's reviews: its run's, or one in its own folder."""
    folder = trace.resolve().parent
    return (folder.parent if folder.name == "traces" else folder) / FILE
