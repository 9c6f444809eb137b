"""What turning tables say of whole runs: every analysed failure stands in one class.

A report and a run's page read `summary_of_run(folder)`: it finds the tables of `c2nav turning` in
the run folder and beside it, by their columns and by the traces they speak of.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from c2nav_engine.contract.question import Slot
from c2nav_engine.experiments.columns import read_rows
from c2nav_engine.experiments.statistics.intervals import Interval, wilson
from c2nav_engine.experiments.turning.flips import TURNING, UNSTABLE
from c2nav_engine.experiments.turning.regrets import WRONG
from c2nav_engine.experiments.turning.table import (
    FLIP,
    RECOVERABLE,
    REGRET,
    Row,
    is_turning_table,
    read_table,
)

UNFINISHED = "not finished"
BY_CONTROLLER = "lost by the controller"
NOT_ONE_AWAY = "not one answer away"

VERDICTS = (TURNING, NOT_ONE_AWAY, UNSTABLE, BY_CONTROLLER, UNFINISHED)
"""Every class of a failed episode, in the order of reading."""


@dataclass(frozen=True, slots=True)
class TurningSummary:
    """The failures of one or more runs, sorted.

    Attributes:
        failures: Failed episodes of the runs.
        analysed: How many of them a table speaks of; all rates are of these.
        verdicts: Class → rate, every class once.
        by_slot: Slot → rate of failures one answer away in it, by `turning_point`, so that each
            failure counts once.
    """

    failures: int
    analysed: int
    verdicts: Mapping[str, Interval]
    by_slot: Mapping[Slot, Interval]


def summary_of_run(folder: Path) -> TurningSummary | None:
    """The failures of a run folder; None where no turning table speaks of any of its traces."""
    failed = failed_traces(read_rows(folder))
    summary = summary_of(rows_beside(folder), failed)
    return summary if summary.analysed else None


def failed_traces(rows: Iterable[Mapping[str, object]]) -> list[str]:
    """Digests of the traces of rows of `episodes.parquet` that are no success."""
    return [str(row["trace_sha256"]) for row in rows if row["success"] == 0]


def rows_beside(folder: Path) -> list[Row]:
    """Rows of every turning table in a run folder or in the folder that holds it."""
    paths = [*sorted(folder.glob("*.parquet")), *sorted(folder.resolve().parent.glob("*.parquet"))]
    return [row for path in paths if is_turning_table(path) for row in read_table(path)]


def summary_of(rows: Iterable[Row], failed: Collection[str]) -> TurningSummary:
    """Sort failed traces by what their rows say.

    Args:
        rows: Of one or more turning tables; other traces may stand in them.
        failed: Digests of the failed traces.
    """
    wanted = set(failed)
    by_trace: dict[str, list[Row]] = defaultdict(list)
    for row in rows:
        if row["trace_sha256"] in wanted:
            by_trace[str(row["trace_sha256"])].append(row)
    verdicts = Counter(verdict_of(mine) for mine in by_trace.values())
    points = (turning_point(mine) for mine in by_trace.values())
    slots = Counter(Slot(str(point["slot"])) for point in points if point is not None)
    analysed = len(by_trace)
    return TurningSummary(
        failures=len(failed),
        analysed=analysed,
        verdicts={name: wilson(verdicts[name], analysed) for name in VERDICTS},
        by_slot={slot: wilson(slots[slot], analysed) for slot in Slot if slots[slot]},
    )


def verdict_of(rows: Sequence[Row]) -> str:
    """The class of one failed episode by its rows: the first of these that holds.

    one answer away: a changed answer alone led to success, and its control never did.
    not finished: an answer that was to be tried was not.
    unstable: a changed answer or a control succeeded, but not reliably.
    lost by the controller: the truth itself fails from the first question on, or nothing good was
    offered somewhere and no committed answer was wrong.
    not one answer away: all else.
    """
    flips = [row for row in rows if row["part"] == FLIP]
    found = {row["verdict"] for row in flips}
    if TURNING in found:
        return TURNING
    if _untried(rows, flips):
        return UNFINISHED
    if UNSTABLE in found:
        return UNSTABLE
    return BY_CONTROLLER if _lost_by_controller(rows) else NOT_ONE_AWAY


def turning_point(rows: Iterable[Row]) -> Row | None:
    """The turning point that an episode is named by: at its worst decision by regret that has one.

    Decisions are tried worst first, so it is the first row that is one. None without one.
    """
    return next((r for r in rows if r["part"] == FLIP and r["verdict"] == TURNING), None)


def _untried(rows: Iterable[Row], flips: Iterable[Row]) -> bool:
    tried: dict[object, set[object]] = defaultdict(set)
    for flip in flips:
        tried[flip["decision"]].add(flip["answer"])
    return any(
        len(tried[row["decision"]]) < int(row["to_try"] or 0)
        for row in rows
        if row["part"] == REGRET
    )


def _lost_by_controller(rows: Iterable[Row]) -> bool:
    rows = list(rows)
    if any(row["part"] == RECOVERABLE and row["decision"] is None for row in rows):
        return True
    words = [row["words"] for row in rows if row["part"] == REGRET]
    return any(words) and WRONG not in words
