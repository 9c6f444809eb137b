"""What is done and what is missing: one SQLite row a task, safe to kill at any moment."""

from __future__ import annotations

import json
import sqlite3
import time
from collections.abc import Callable, Iterable
from contextlib import closing
from pathlib import Path

from c2nav_engine.errors import InputError
from c2nav_engine.experiments.columns import Row

_SCHEMA = """
create table if not exists tasks (
  key text primary key,
  name text not null,
  state text not null default 'waiting' check (state in ('waiting', 'leased', 'done', 'failed')),
  attempts integer not null default 0,
  lease_until_s real not null default 0,
  row text,
  error text not null default '',
  cost_usd real
)
"""


class Ledger:
    """The state of every task of a run folder.

    Only the coordinating process writes; a killed one leaves leases that mean nothing any more.

    Args:
        path: `RUN/ledger.sqlite`; made when absent.
        clock: Seconds since the epoch.
    """

    def __init__(self, path: Path, *, clock: Callable[[], float] = time.time) -> None:
        self._clock = clock
        try:
            self._db = sqlite3.connect(path, isolation_level=None)
            # One file and whole commits: run folders lie on network disks too, where a shared
            # write-ahead log does not work.
            self._db.execute("pragma journal_mode = delete")
            self._db.execute(_SCHEMA)
        except sqlite3.DatabaseError as error:
            message = f"expected a ledger at {path}, came: {error}; name another --out folder"
            raise InputError(message) from error

    def add(self, tasks: Iterable[tuple[str, str]]) -> None:
        """Know these (key, name) tasks; those already known keep their state."""
        with self._db:
            self._db.execute("begin")
            self._db.executemany("insert or ignore into tasks (key, name) values (?, ?)", tasks)

    def missing(self) -> list[str]:
        """Keys that are not done, in the order they were added."""
        rows = self._db.execute("select key from tasks where state <> 'done' order by rowid")
        return [key for (key,) in rows]

    def lease(self, key: str, *, seconds: float = 3600.0) -> None:
        """A worker took the task."""
        self._db.execute(
            "update tasks set state = 'leased', attempts = attempts + 1, lease_until_s = ? "
            "where key = ?",
            (self._clock() + seconds, key),
        )

    def finish(self, key: str, row: Row, *, cost_usd: float | None = None) -> None:
        """The task is done; its row is kept here until the tables are written."""
        self._db.execute(
            "update tasks set state = 'done', row = ?, error = '', cost_usd = ? where key = ?",
            (json.dumps(dict(row)), cost_usd, key),
        )

    def fail(self, key: str, error: str, row: Row, *, cost_usd: float | None = None) -> None:
        """The task ended as `error`; a resumed run takes it up again."""
        self._db.execute(
            "update tasks set state = 'failed', row = ?, error = ?, cost_usd = ? where key = ?",
            (json.dumps(dict(row)), error, cost_usd, key),
        )

    def rows(self) -> dict[str, Row]:
        """Rows of finished and failed tasks by key."""
        found = self._db.execute("select key, row from tasks where row is not null order by rowid")
        return {key: json.loads(row) for key, row in found}

    def errors(self) -> dict[str, str]:
        """Why tasks failed, by name."""
        found = self._db.execute(
            "select name, error from tasks where state = 'failed' order by rowid"
        )
        return dict(found.fetchall())

    def cost_usd(self) -> float | None:
        """Known price of all tasks so far; None where none is known."""
        return self._db.execute("select sum(cost_usd) from tasks").fetchone()[0]

    def states(self) -> dict[str, int]:
        """How many tasks are in each state."""
        return dict(self._db.execute("select state, count(*) from tasks group by state").fetchall())

    def close(self) -> None:
        """Let go of the file."""
        self._db.close()


def states_of(path: Path) -> dict[str, int]:
    """States of a run's tasks without touching its ledger, also while it runs."""
    with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as db:
        return dict(db.execute("select state, count(*) from tasks group by state").fetchall())


def failures_of(path: Path) -> dict[str, tuple[Row, str]]:
    """Name → (row, error) of a run's failed tasks, read as `states_of` does."""
    with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as db:
        found = db.execute(
            "select name, row, error from tasks where state = 'failed' and row is not null"
        )
        return {name: (json.loads(row), error) for name, row, error in found}
