"""A running session that a test can wait for."""

from __future__ import annotations

import queue
from collections.abc import Callable

from app.session import commands as c
from app.session.snapshot import Snapshot
from app.session.worker import Session


class Watched:
    """A session whose snapshots can be waited for."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self._queue: queue.Queue[Snapshot] = queue.Queue()
        session.subscribe(self._queue.put)
        session.start()

    def until(self, wanted: Callable[[Snapshot], bool]) -> Snapshot:
        """The first snapshot, now or to come, for which it holds."""
        if wanted(self.session.snapshot):
            return self.session.snapshot
        while True:
            snapshot = self._queue.get(timeout=20.0)
            if wanted(snapshot):
                return snapshot

    def do(self, command: c.Command) -> None:
        """Send a command."""
        self.session.dispatch(command)
