"""Asking the index: pages of episodes, counts of what a filter left, the rows of a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from app.pages.index.columns import COLUMNS, Value
from app.pages.index.counting import Counter, Counts
from app.pages.index.query import Query
from app.pages.index.store import Store
from c2nav_engine.experiments.health import Health, merged
from c2nav_engine.experiments.tags.rules import TAGS

PAGE = 24
"""Episodes on a page [C]."""
_AT_ONCE = 500
"""Keys in one query: SQLite bounds the values that a statement may name."""


@dataclass(frozen=True, slots=True)
class Case:
    """An episode of the index with what people said of it.

    Attributes:
        path: Where its trace lies below the folder.
        values: By column.
        instruction: What the robot was told.
        error: Why it failed, where it ended in an error.
        drawing: Its small map.
        marks: Manual tags.
        sets: Names of the sets it is in.
    """

    path: str
    values: dict[str, Value]
    instruction: str
    error: str
    drawing: str
    marks: tuple[str, ...] = ()
    sets: tuple[str, ...] = ()

    @property
    def sha256(self) -> str:
        """Digest of its trace; "" without one."""
        return str(self.values["trace_sha256"] or "")

    @property
    def tags(self) -> tuple[str, ...]:
        """Names of the automatic tags that hold."""
        return tuple(name for name in TAGS if self.values[name] == 1)


@dataclass(frozen=True, slots=True)
class Found:
    """A page of what a query leaves.

    Attributes:
        cases: The episodes of the page.
        page: From 1.
        counts: Of everything that the query leaves.
    """

    cases: tuple[Case, ...]
    page: int
    counts: Counts

    @property
    def pages(self) -> int:
        """Pages that there are; at least one."""
        return max(1, -(-self.counts.total // PAGE))


class Finder:
    """Asks one index, page by page."""

    def __init__(self, store: Store) -> None:
        self.store = store
        self._counter = Counter(store)
        self._choices: dict[str, list[tuple[str, int]]] = {}
        self._version: object = None

    def choices(self, column: str) -> list[tuple[str, int]]:
        """See the function of that name; counted again only when the index has changed."""
        if self._version != self.store.version:
            self._version, self._choices = self.store.version, {}
        if column not in self._choices:
            self._choices[column] = choices(self.store, column)
        return self._choices[column]

    def find(self, query: Query, *, page: int = 1) -> Found:
        """A page of a query, else its last one; raises `InputError` for a query that is none."""
        where, order = query.where(), query.order()
        counts = self._counter.count(where)
        page = min(max(1, page), max(1, -(-counts.total // PAGE)))
        keys = self.store.column(
            f"select id from episodes where {where.sql} order by {order} limit ? offset ?",
            (*where.values, PAGE, (page - 1) * PAGE),
        )
        return Found(_cases(self.store, keys), page, counts)


def everything(store: Store, query: Query) -> tuple[Case, ...]:
    """All that a query leaves, in its order."""
    where = query.where()
    found = store.read(
        f"select id from episodes where {where.sql} order by {query.order()}", where.values
    )
    return _cases(store, [key for (key,) in found])


def rows(store: Store, run: str) -> list[dict[str, Value]]:
    """The episodes of a run as the statistics read them."""
    names = ", ".join(("path", *COLUMNS))
    return [
        dict(row)
        for row in store.read(f"select {names} from episodes where run = ? order by path", (run,))
    ]


def health(store: Store, run: str) -> Health:
    """The health of a run's answers."""
    kept = store.column(
        "select health from drawings join episodes using (id) where run = ?", (run,)
    )
    return merged(map(Health.from_json, kept))


def case_of(store: Store, sha256: str) -> Case | None:
    """The episode of a trace; None where the index does not have it."""
    found = store.read(
        "select id from episodes where trace_sha256 = ? and trace_sha256 <> '' order by path",
        (sha256,),
    )
    return _cases(store, [found[0][0]])[0] if found else None


def choices(store: Store, column: str) -> list[tuple[str, int]]:
    """Values of a column of words with how often they occur, most frequent first."""
    found = store.read(
        f"select {column}, count(*) as n from episodes where {column} is not null "
        f"group by {column} order by n desc, {column} limit 40"
    )
    return [(str(value), int(count)) for value, count in found]


def _cases(store: Store, keys: Sequence[int]) -> tuple[Case, ...]:
    """Whole episodes in the order of their keys."""
    found: dict[int, Any] = {}
    for begin in range(0, len(keys), _AT_ONCE):
        some = keys[begin : begin + _AT_ONCE]
        rows = store.read(
            "select * from episodes join words using (id) join drawings using (id) "
            f"where id in ({', '.join('?' * len(some))})",
            some,
        )
        found |= {row["id"]: row for row in rows}
    return tuple(_case(store, found[key]) for key in keys)


def _case(store: Store, row: Any) -> Case:
    sha256 = row["trace_sha256"] or ""
    said = store.read("select tag from marks where trace_sha256 = ? order by tag", (sha256,))
    within = store.read("select name from members where trace_sha256 = ? order by name", (sha256,))
    return Case(
        path=row["path"],
        values={name: row[name] for name in COLUMNS},
        instruction=row["instruction"],
        error=row["error"],
        drawing=row["drawing"],
        marks=tuple(tag for (tag,) in said) if sha256 else (),
        sets=tuple(name for (name,) in within) if sha256 else (),
    )
