"""What turning tables say of runs: every analysed failure once, found in or beside the run."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from c2nav_engine.contract.question import Slot
from c2nav_engine.experiments.columns import read_rows, write_rows
from c2nav_engine.experiments.report.writing import write_report
from c2nav_engine.experiments.statistics.intervals import wilson
from c2nav_engine.experiments.turning.flips import TURNING, UNSTABLE
from c2nav_engine.experiments.turning.summary import (
    BY_CONTROLLER,
    NOT_ONE_AWAY,
    UNFINISHED,
    VERDICTS,
    summary_of_run,
)
from c2nav_engine.experiments.turning.table import COLUMNS, Row, write_table
from tests.helpers.runs import make_run

FAILURES = 6
"""Of the made-up run's ten episodes; the last one is in no turning table."""


def row(trace: str, part: str, **facts: str | int) -> Row:
    return {name: {"trace_sha256": trace, "part": part, **facts}.get(name) for name in COLUMNS}


def flip(trace: str, decision: int, slot: Slot, verdict: str) -> Row:
    return row(trace, "flip", decision=decision, slot=slot.value, answer="x", verdict=verdict)


def regret(trace: str, decision: int, *, to_try: int = 1) -> Row:
    return row(trace, "regret", decision=decision, words="wrong", to_try=to_try)


def recoverable(trace: str, decision: int | None = 0) -> Row:
    return row(trace, "recoverable", **({} if decision is None else {"decision": decision}))


TABLE = [
    # Two turning points: the first row is the worse decision, and names the episode.
    *(regret("t0", 4), regret("t0", 9), recoverable("t0")),
    *(flip("t0", 9, Slot.JOURNEY, TURNING), flip("t0", 4, Slot.SEEING, TURNING)),
    *(regret("t1", 2), recoverable("t1"), flip("t1", 2, Slot.SEEING, UNSTABLE)),
    *(regret("t2", 2), recoverable("t2", None), flip("t2", 2, Slot.SEEING, "no success")),
    *(regret("t3", 2), recoverable("t3"), flip("t3", 2, Slot.SEEING, "no success")),
    *(regret("t4", 2, to_try=2), recoverable("t4"), flip("t4", 2, Slot.SEEING, "no success")),
    # Of an episode that succeeded, and of another run.
    flip("t6", 0, Slot.SEEING, TURNING),
    flip("elsewhere", 0, Slot.SEEING, TURNING),
]


@pytest.fixture
def run(tmp_path: Path) -> Path:
    folder = tmp_path / "runs" / "one"
    make_run(folder, ("full",), lambda _variant, _episode, _seed: {}, episodes=10)
    rows = [
        {**each, "trace_sha256": f"t{place}", "success": int(place >= FAILURES)}
        for place, each in enumerate(read_rows(folder))
    ]
    write_rows(rows, folder)
    return folder


@pytest.mark.parametrize("where", ["in", "beside"])
def test_every_analysed_failure_stands_in_one_class(run: Path, where: str):
    write_table(TABLE, (run if where == "in" else run.parent) / "any name.parquet")
    summary = summary_of_run(run)
    assert summary is not None
    assert (summary.failures, summary.analysed) == (FAILURES, FAILURES - 1)
    one = wilson(1, FAILURES - 1)
    assert summary.verdicts == dict.fromkeys(VERDICTS, one)
    assert set(VERDICTS) == {TURNING, UNSTABLE, BY_CONTROLLER, NOT_ONE_AWAY, UNFINISHED}
    assert summary.by_slot == {Slot.JOURNEY: one}


def test_a_run_without_a_turning_table_has_no_summary(run: Path):
    assert summary_of_run(run) is None
    write_table([flip("elsewhere", 0, Slot.SEEING, TURNING)], run / "turning.parquet")
    assert summary_of_run(run) is None


def test_the_report_takes_the_figures_up(run: Path, tmp_path: Path):
    write_table(TABLE, run / "turning.parquet")
    write_report([run], tmp_path / "out")
    with (tmp_path / "out" / "csv" / "turning.csv").open(encoding="utf-8") as file:
        records = list(csv.DictReader(file))
    assert [(each["verdict"], each["slot"], each["count"]) for each in records] == [
        *((verdict, "", "1") for verdict in VERDICTS),
        (TURNING, "journey", "1"),
    ]
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "Turning points of the failures" in page
    assert "journey 1: 20.0" in page


def test_a_report_without_turning_tables_says_nothing_of_them(run: Path, tmp_path: Path):
    write_report([run], tmp_path / "out")
    assert not (tmp_path / "out" / "csv" / "turning.csv").exists()
    assert "Turning points" not in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
