"""The events of a run on disk: one SQLite file beside it, in WAL mode.

The database itself refuses to change or delete an event, so no code of ours can. Several processes
may add at once; each addition is one transaction, and an event that is there already is not added
again.
"""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Generator, Iterable, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import TracebackType

from app.reviews.events import Event, event_line, event_of
from c2nav_engine.errors import UsageError

FILE = "reviews.sqlite"
"""Name of the store in a run folder."""

_PATIENCE_S = 30.0
"""How long a writer waits for another one."""

_TABLES = """
CREATE TABLE IF NOT EXISTS events (
    seq INTEGER PRIMARY KEY AUTOINCREMENT, id TEXT NOT NULL UNIQUE, line TEXT NOT NULL
);
CREATE TABLE IF NOT EXISTS people (
    number INTEGER PRIMARY KEY AUTOINCREMENT, name TEXT NOT NULL UNIQUE
);
CREATE TABLE IF NOT EXISTS leases (
    queue TEXT NOT NULL, item INTEGER NOT NULL, holder TEXT NOT NULL, until_s REAL NOT NULL,
    PRIMARY KEY (queue, item)
);
CREATE TRIGGER IF NOT EXISTS events_stay BEFORE UPDATE ON events
    BEGIN SELECT RAISE(ABORT, 'events are never changed'); END;
CREATE TRIGGER IF NOT EXISTS events_remain BEFORE DELETE ON events
    BEGIN SELECT RAISE(ABORT, 'events are never deleted'); END;
"""


class Writing:
    """What may be done inside one transaction."""

    def __init__(self, connection: sqlite3.Connection) -> None:
        self._connection = connection

    def events(self, *, after: int = 0) -> list[tuple[int, Event]]:
        """Events with their sequence numbers, oldest first."""
        rows = self._connection.execute(
            "SELECT seq, line FROM events WHERE seq > ? ORDER BY seq", (after,)
        )
        return [(seq, event_of(line, where=f"event {seq}")) for seq, line in rows]

    def append(self, event: Event) -> bool:
        """Add an event; False when it is there already.

        Raises:
            UsageError: Another event has its id.
        """
        line = event_line(event)
        found = self._connection.execute(
            "SELECT line FROM events WHERE id = ?", (event.id,)
        ).fetchone()
        if found is None:
            self._connection.execute(
                "INSERT INTO events (id, line) VALUES (?, ?)", (event.id, line)
            )
            return True
        if found[0] != line:
            message = f"expected a new event, came another one with the id {event.id}"
            raise UsageError(message)
        return False

    def pseudonym(self, name: str) -> str:
        """The person's pseudonym ("P3"), the same for ever; new names get the next number."""
        self._connection.execute("INSERT OR IGNORE INTO people (name) VALUES (?)", (name,))
        found = self._connection.execute("SELECT number FROM people WHERE name = ?", (name,))
        return f"P{found.fetchone()[0]}"

    def leases(self, queue: str, *, now_s: float) -> dict[int, str]:
        """Items of a queue that somebody holds now: item → holder."""
        rows = self._connection.execute(
            "SELECT item, holder FROM leases WHERE queue = ? AND until_s > ?", (queue, now_s)
        )
        return dict(rows.fetchall())

    def lease(self, queue: str, item: int, *, holder: str, until_s: float) -> None:
        """Hold one item and let go of every other in this queue."""
        self._connection.execute(
            "DELETE FROM leases WHERE queue = ? AND (holder = ? OR item = ?)",
            (queue, holder, item),
        )
        self._connection.execute(
            "INSERT INTO leases VALUES (?, ?, ?, ?)", (queue, item, holder, until_s)
        )


class Store:
    """An open store; safe to use from several threads.

    Args:
        path: The file; made where it is not there, in a folder that is.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock = threading.RLock()
        if not path.parent.is_dir():
            message = f"expected the folder of a run, came {path.parent}, which is not there"
            raise UsageError(message)
        self._connection = sqlite3.connect(
            path, timeout=_PATIENCE_S, check_same_thread=False, isolation_level=None
        )
        try:
            self._connection.execute("PRAGMA journal_mode = WAL")
            self._connection.execute("PRAGMA synchronous = FULL")
            self._connection.executescript(_TABLES)
        except sqlite3.DatabaseError as error:
            self._connection.close()
            message = f"expected a store of reviews at {path}, came something else ({error})"
            raise UsageError(message) from error

    @contextmanager
    def writing(self) -> Generator[Writing]:
        """One transaction: all of it happens, or nothing; nobody else writes meanwhile."""
        with self._lock:
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                yield Writing(self._connection)
            except BaseException:
                self._connection.execute("ROLLBACK")
                raise
            self._connection.execute("COMMIT")

    def append(self, events: Iterable[Event]) -> int:
        """Add events, all or none; returns how many were new."""
        with self.writing() as writing:
            return sum(writing.append(event) for event in events)

    def events(self) -> list[Event]:
        """Every event, oldest first."""
        with self._lock:
            return [event for _, event in Writing(self._connection).events()]

    def pseudonym(self, name: str) -> str:
        """See `Writing.pseudonym`."""
        with self.writing() as writing:
            return writing.pseudonym(name)

    def close(self) -> None:
        """Close the file; idempotent."""
        with self._lock:
            self._connection.close()

    def __enter__(self) -> Store:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def store_of(run: Path) -> Store:
    """The store beside a run."""
    return Store(run / FILE)


def export_lines(store: Store, *, names: bool = False) -> list[str]:
    """Every event as a line of JSON; people stand under pseudonyms unless `names`."""
    return [event_line(event) for event in shared_events(store, names=names)]


def shared_events(store: Store, *, names: bool = False) -> list[Event]:
    """Every event, with pseudonyms for authors unless `names`."""
    events = store.events()
    if names:
        return events
    with store.writing() as writing:
        called = {event.author: "" for event in events}
        called = {name: writing.pseudonym(name) for name in called}
    return [replace(event, author=called[event.author]) for event in events]


def read_lines(lines: Sequence[str], *, where: str) -> list[Event]:
    """Events from lines of JSON; empty lines are passed over. Raises `UsageError`."""
    return [
        event_of(line, where=f"{where}, line {number}")
        for number, line in enumerate(lines, start=1)
        if line.strip()
    ]
