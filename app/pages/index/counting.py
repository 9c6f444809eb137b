"""How a filter's episodes came out: counts of endings and tags, for the page's side.

Thirty sums over a hundred thousand rows are the slow part of a page in SQL. The columns that are
counted are small, so they are kept in memory and only the filter is asked of the database.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from app.pages.index.query import Condition
from app.pages.index.store import Store
from c2nav_engine.experiments.tags.endings import Ending
from c2nav_engine.experiments.tags.rules import TAGS

_UNKNOWN = -1


@dataclass(frozen=True, slots=True)
class Counts:
    """What a filter leaves.

    Attributes:
        total: Episodes.
        successes: Of them, successful.
        endings: Ending → how many.
        tags: Automatic tag → of how many it holds, and of how many it is unknown.
    """

    total: int
    successes: int
    endings: dict[str, int]
    tags: dict[str, tuple[int, int]]


class Counter:
    """Counts the episodes of one index, and notices when it changed."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._version: Any = None
        self._keys = np.empty(0, np.int64)
        self._endings = np.empty(0, np.int8)
        self._flags = np.empty((0, len(TAGS) + 1), np.int8)

    def count(self, where: Condition) -> Counts:
        """Count what a filter leaves."""
        self._load()
        if where.sql == "true":
            chosen: Any = slice(None)
        else:
            found = self._store.column(f"select id from episodes where {where.sql}", where.values)
            chosen = np.searchsorted(self._keys, found)
        endings, flags = self._endings[chosen], self._flags[chosen]
        held, unknown = (flags == 1).sum(axis=0), (flags == _UNKNOWN).sum(axis=0)
        by_ending = np.bincount(endings, minlength=len(Ending))
        return Counts(
            total=len(endings),
            successes=int(held[-1]),
            endings={e.value: int(by_ending[place]) for place, e in enumerate(Ending)},
            tags={name: (int(held[k]), int(unknown[k])) for k, name in enumerate(TAGS)},
        )

    def _load(self) -> None:
        version = self._store.version
        if version == self._version:
            return
        numbers = {ending.value: place for place, ending in enumerate(Ending)}
        columns = ", ".join(f"ifnull({name}, {_UNKNOWN})" for name in (*TAGS, "success"))
        rows = self._store.tuples(f"select id, ending, {columns} from episodes order by id")
        self._keys = np.array([row[0] for row in rows], np.int64)
        self._endings = np.array([numbers[row[1]] for row in rows], np.int8)
        self._flags = np.array([row[2:] for row in rows], np.int8).reshape(-1, len(TAGS) + 1)
        self._version = version
