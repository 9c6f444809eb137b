"""The state as JSON, once per snapshot, and the event stream that sends what changed."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from typing import Any

from app.session.snapshot import Snapshot
from app.session.state_json import state_json
from app.session.timeline import Timelines
from app.session.worker import Session

_PULSE_S = 0.03
"""Changes closer together than this reach a page as one event."""

_HEARTBEAT_S = 15.0
"""A comment on an idle stream, so that proxies and tunnels keep it open."""

Sections = dict[str, str]
"""Top-level key → its JSON text."""


class Feed:
    """Serialises snapshots and tells open pages about them."""

    def __init__(self, session: Session) -> None:
        """Follow a session; `attach` must run on the event loop before any stream is read."""
        self._session = session
        self._cached: tuple[tuple[int, int], Sections] | None = None
        self._timelines = Timelines()
        self._texts: dict[str, tuple[object, str]] = {}
        self._changed: set[asyncio.Event] = set()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._closing = False

    def attach(self) -> None:
        """Wake the streams from the worker's thread through this loop."""
        self._loop = asyncio.get_running_loop()
        self._session.subscribe(self._heard)

    def _heard(self, _: Snapshot) -> None:
        if self._loop is not None and not self._closing:
            self._loop.call_soon_threadsafe(self._wake)

    def close(self) -> None:
        """End all streams."""
        self._closing = True
        self._wake()

    def _wake(self) -> None:
        for event in self._changed:
            event.set()

    def state(self) -> bytes:
        """The whole state as one JSON object."""
        return _object(self._sections()).encode()

    def _sections(self) -> Sections:
        snapshot = self._session.snapshot
        key = (snapshot.version, len(self._changed))
        if self._cached is None or self._cached[0] != key:
            self._cached = (key, self._serialised(snapshot))
        return self._cached[1]

    def _serialised(self, snapshot: Snapshot) -> Sections:
        whole = state_json(snapshot, self._timelines) | {"pages": len(self._changed)}
        known, self._texts = self._texts, {}
        for name, value in whole.items():
            was, text = known.get(name, (None, ""))
            # What is still the same object is not written again: a timeline has 50 kB.
            self._texts[name] = (value, text if value is was and text else _text(value))
        return {name: text for name, (_, text) in self._texts.items()}

    async def events(self) -> AsyncIterator[str]:
        """Server-sent events for one page: the whole state first, then changed sections."""
        changed = asyncio.Event()
        self._changed.add(changed)
        self._wake()
        sent: Sections = {}
        try:
            while not self._closing:
                # Cleared before the state is read: what changes meanwhile wakes the next round.
                changed.clear()
                now = self._sections()
                fresh = {name: text for name, text in now.items() if sent.get(name) != text}
                if fresh:
                    sent = now
                    yield f"event: state\ndata: {_object(fresh)}\n\n"
                    await asyncio.sleep(_PULSE_S)
                try:
                    await asyncio.wait_for(changed.wait(), _HEARTBEAT_S)
                except TimeoutError:
                    yield ": still here\n\n"
        finally:
            self._changed.discard(changed)
            self._wake()


def _object(sections: Sections) -> str:
    return "{" + ",".join(f"{json.dumps(name)}:{text}" for name, text in sections.items()) + "}"


def _text(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
