"""Keeping the index what its folder is: new, changed and vanished traces.

A trace is read again when its time or size changed; its digest then says whether its bytes did.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from app.pages.index.columns import Row
from app.pages.index.reading import Courses, row_of_task, row_of_trace, run_of
from app.pages.index.store import Store
from c2nav_engine.errors import TraceError
from c2nav_engine.experiments.ledger import failures_of
from c2nav_engine.traces.reader import TraceFile

EXPORTS = "case-sets"
"""Where sets are exported below the folder; their copies of traces are no runs."""
_SKIPPED = frozenset({EXPORTS, "studies", "legs"})


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a refresh is.

    Attributes:
        done: Traces looked at.
        total: Traces under the folder.
        read: Of these, read because they are new or changed.
        unreadable: Path → why it could not be read.
    """

    done: int
    total: int
    read: int = 0
    unreadable: tuple[tuple[str, str], ...] = ()


def refresh(
    store: Store,
    courses: Courses,
    *,
    heard: Callable[[Progress], bool] = lambda _: True,
    retry_truth: bool = False,
) -> Progress:
    """Bring the index up to date.

    Args:
        store: The index.
        courses: Where the truth of scenes may be had.
        heard: Told after every trace; False ends the refresh early.
        retry_truth: Read those again whose scene was not to be had.
    """
    stamps = store.stamps()
    files = dict(_files(store.root))
    tasks = {row.path: row for row in _lost_tasks(store.root) if row.path not in files}
    store.forget([path for path in stamps if path not in files and path not in tasks])
    store.put_all((row, 0, 0) for path, row in tasks.items() if path not in stamps)
    read, unreadable = 0, list[tuple[str, str]]()
    for done, (name, stat) in enumerate(files.items(), start=1):
        known = stamps.get(name)
        stamp = (stat.st_mtime_ns, stat.st_size)
        if known is None or known[:2] != stamp or (retry_truth and not known[2]):
            try:
                read += _reread(store, courses, name, stamp, anyway=retry_truth)
            except TraceError as error:
                unreadable.append((name, str(error)))
                store.forget([name])
        progress = Progress(done, len(files), read, tuple(unreadable))
        if not heard(progress):
            return progress
    return Progress(len(files), len(files), read, tuple(unreadable))


def _reread(
    store: Store, courses: Courses, name: str, stamp: tuple[int, int], *, anyway: bool
) -> int:
    """1 when the trace had to be read; 0 when its bytes are those that are known."""
    path = store.root / name
    mtime_ns, size = stamp
    with TraceFile(path) as file:
        known = store.read(
            "select 1 from episodes where path = ? and trace_sha256 = ?", (name, file.sha256)
        )
    if known and not anyway:
        store.touch(name, mtime_ns=mtime_ns, size=size)
        return 0
    row = row_of_trace(path, name=name, run=run_of(name), courses=courses)
    store.put(row, mtime_ns=mtime_ns, size=size)
    return 1


def _files(root: Path) -> Iterator[tuple[str, os.stat_result]]:
    """Every finished trace below a folder by its name there, runs together."""
    for folder, inner, names in os.walk(root):
        inner[:] = sorted(each for each in inner if each not in _SKIPPED and each[0] != ".")
        for name in sorted(names):
            if name.endswith(".mcap"):
                path = Path(folder) / name
                yield path.relative_to(root).as_posix(), path.stat()


def _lost_tasks(root: Path) -> Iterator[Row]:
    """Failed tasks of every run; those without a trace appear as errors."""
    for ledger in sorted({*root.glob("ledger.sqlite"), *root.glob("*/ledger.sqlite")}):
        run = ledger.parent.relative_to(root).as_posix()
        for name, (row, error) in failures_of(ledger).items():
            yield row_of_task(
                f"{run}/traces/{name}.mcap".removeprefix("./"), row, run=run, error=error
            )
