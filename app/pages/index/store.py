"""The index on disk: one SQLite file beside the runs.

What is read from traces can be read again, so it is dropped when its shape changes. What people
said (marks, views, sets) stands in tables of its own and is never dropped; it names episodes by
the digest of their traces, so that it survives moved and renamed runs.
"""

from __future__ import annotations

import hashlib
import os
import sqlite3
import threading
from collections.abc import Generator, Iterable, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from app.pages.index.columns import COLUMNS, Row
from c2nav_engine.errors import InputError
from c2nav_engine.runner.scene_cache import cache_folder

FILE = "cases.sqlite"
VERSION = 2
"""Counts changes of the derived tables and of the tags' rules: older rows are read again."""

_DERIVED = f"""
create table episodes (
  id integer primary key,
  {", ".join(f"{name} {kind}" for name, kind in COLUMNS.items())},
  path text not null unique,
  mtime_ns integer not null,
  size integer not null
);
create index episodes_by_trace on episodes (trace_sha256);
create index episodes_by_run on episodes (run);
create table words (id integer primary key, instruction text, error text);
create table drawings (id integer primary key, drawing text, health text);
"""
"""Words and drawings stand apart: a filter reads the narrow table alone."""

_CURATED = """
create table if not exists marks (
  trace_sha256 text not null, tag text not null, primary key (trace_sha256, tag)
) without rowid;
create table if not exists views (name text primary key, query text not null, sort text not null);
create table if not exists sets (name text primary key, note text not null default '');
create table if not exists members (
  name text not null, trace_sha256 text not null, place integer not null,
  caption text not null default '', primary key (name, trace_sha256)
) without rowid;
"""


class Store:
    """One index file; safe to use from several threads.

    Args:
        root: The folder whose runs it describes.
    """

    def __init__(self, root: Path) -> None:
        self.root = root.resolve()
        self.path = _file_for(self.root)
        self._lock = threading.RLock()
        try:
            self._db = sqlite3.connect(
                self.path, isolation_level=None, check_same_thread=False, timeout=30.0
            )
            self._db.row_factory = sqlite3.Row
            self._db.execute("pragma mmap_size = 1073741824")
            self._prepare()
        except sqlite3.DatabaseError as error:
            message = (
                f"expected an index of episodes at {self.path}, came: {error}; move that file away "
                "to have the index made again"
            )
            raise InputError(message) from error

    def _prepare(self) -> None:
        with self.writing() as db:
            (version,) = db.execute("pragma user_version").fetchone()
            for statement in _statements(_CURATED):
                db.execute(statement)
            if version == VERSION:
                return
            for table in ("episodes", "words", "drawings"):
                db.execute(f"drop table if exists {table}")
            for statement in _statements(_DERIVED):
                db.execute(statement)
            db.execute(f"pragma user_version = {VERSION}")

    @contextmanager
    def writing(self) -> Generator[sqlite3.Connection]:
        """One transaction; nothing of it stays when it fails."""
        with self._lock:
            self._db.execute("begin immediate")
            try:
                yield self._db
            except BaseException:
                self._db.execute("rollback")
                raise
            self._db.execute("commit")

    def read(self, sql: str, parameters: Sequence[Any] | dict[str, Any] = ()) -> list[sqlite3.Row]:
        """The rows of a query."""
        with self._lock:
            return self._db.execute(sql, parameters).fetchall()

    def tuples(self, sql: str, parameters: Sequence[Any] = ()) -> list[tuple[Any, ...]]:
        """The same as plain tuples: a quarter of the time where there are many."""
        with self._lock:
            cursor = self._db.cursor()
            cursor.row_factory = None
            return cursor.execute(sql, parameters).fetchall()

    def column(self, sql: str, parameters: Sequence[Any] = ()) -> list[Any]:
        """The only column of a query."""
        return [value for (value,) in self.tuples(sql, parameters)]

    @property
    def version(self) -> tuple[int, int]:
        """Changes whenever anybody wrote to the file, this program or another."""
        with self._lock:
            (others,) = self._db.execute("pragma data_version").fetchone()
            return others, self._db.total_changes

    def stamps(self) -> dict[str, tuple[int, int, int]]:
        """Path → (mtime in ns, size, whether the truth was known), of everything indexed."""
        found = self.read("select path, mtime_ns, size, truth from episodes")
        return {path: (mtime_ns, size, truth or 0) for path, mtime_ns, size, truth in found}

    def put(self, row: Row, *, mtime_ns: int = 0, size: int = 0) -> None:
        """Add an episode, or replace what was known of that path."""
        self.put_all([(row, mtime_ns, size)])

    def put_all(self, rows: Iterable[tuple[Row, int, int]]) -> None:
        """The same for many (row, mtime in ns, size), in one transaction."""
        names = ("path", "mtime_ns", "size", *COLUMNS)
        insert = f"insert into episodes ({', '.join(names)}) values ({', '.join('?' * len(names))})"
        with self.writing() as db:
            for row, mtime_ns, size in rows:
                _forget(db, row.path)
                values = [row.values.get(name) for name in COLUMNS]
                key = db.execute(insert, [row.path, mtime_ns, size, *values]).lastrowid
                words = (key, row.instruction, row.error)
                db.execute("insert into words values (?, ?, ?)", words)
                drawn = (key, row.drawing, row.health)
                db.execute("insert into drawings values (?, ?, ?)", drawn)

    def touch(self, path: str, *, mtime_ns: int, size: int) -> None:
        """The file at that path was written again with the same bytes."""
        with self.writing() as db:
            db.execute(
                "update episodes set mtime_ns = ?, size = ? where path = ?", (mtime_ns, size, path)
            )

    def forget(self, paths: Iterable[str]) -> None:
        """Drop episodes whose traces are gone; what people said of them stays."""
        with self.writing() as db:
            for path in paths:
                _forget(db, path)

    def close(self) -> None:
        """Let go of the file."""
        with self._lock:
            self._db.close()


def _forget(db: sqlite3.Connection, path: str) -> None:
    for (key,) in db.execute("select id from episodes where path = ?", (path,)).fetchall():
        for table in ("episodes", "words", "drawings"):
            db.execute(f"delete from {table} where id = ?", (key,))


def _statements(text: str) -> list[str]:
    return [statement for statement in text.split(";") if statement.strip()]


def _file_for(root: Path) -> Path:
    """Beside the runs; in the cache where their folder cannot be written."""
    if not root.is_dir():
        message = f"expected a folder of runs, came {root}"
        raise InputError(message)
    if os.access(root, os.W_OK):
        return root / FILE
    folder = cache_folder() / "cases"
    folder.mkdir(parents=True, exist_ok=True)
    return folder / f"{hashlib.sha256(str(root).encode()).hexdigest()[:16]}.sqlite"
