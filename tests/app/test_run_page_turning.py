"""The run page takes up what `c2nav turning` found, with intervals."""

from __future__ import annotations

import re
from collections.abc import Iterator
from html import unescape
from pathlib import Path

import pytest

from app.pages.index.finding import rows
from app.pages.library import Library
from app.pages.run import run_page
from app.pages.turned import RULES, turned_of
from c2nav_engine.contract.question import Slot
from c2nav_engine.experiments.statistics.intervals import wilson
from c2nav_engine.experiments.turning.flips import TURNING
from c2nav_engine.experiments.turning.summary import VERDICTS
from c2nav_engine.experiments.turning.table import COLUMNS, Row, write_table
from tests.helpers.cases import filled, made_rows

RUN, FAILED = "run-0", 3


@pytest.fixture
def library(tmp_path: Path) -> Iterator[Library]:
    """A folder with one run of three failures."""
    made = [row for row in made_rows(200) if row.values["run"] == RUN]
    failed = [row for row in made if row.values["success"] == 0 and row.values["variant"] == "full"]
    filled(tmp_path, failed[:FAILED]).close()
    (tmp_path / RUN).mkdir()
    library = Library(tmp_path)
    yield library
    library.close()


def failures(library: Library) -> list[str]:
    return [str(row["trace_sha256"]) for row in rows(library.store, RUN)]


def analysed(trace: str, verdict: str) -> list[Row]:
    facts = {"decision": 2, "slot": Slot.JOURNEY.value, "answer": "x", "words": "wrong"}
    return [
        {name: (facts | more | {"trace_sha256": trace}).get(name) for name in COLUMNS}
        for more in (
            {"part": "regret", "to_try": 1},
            {"part": "recoverable"},
            {"part": "flip", "verdict": verdict},
        )
    ]


def said(library: Library) -> str:
    page = run_page(library, RUN, menu=())
    return " ".join(unescape(re.sub(r"<[^>]+>", " ", page)).split())


def test_failures_stand_in_their_classes_with_intervals(library: Library):
    one, two, _ = failures(library)
    write_table([*analysed(one, TURNING), *analysed(two, "no success")], library.root / "t.parquet")
    interval = wilson(1, 2)
    ends = f"{100 * interval.low:.0f}–{100 * interval.high:.0f}"
    page = said(library)
    assert f"one answer away 1 50 % {ends} in journey 1 50 % {ends}" in page
    assert f"not one answer away 1 50 % {ends}" in page
    assert "2 of 3 failures analysed" in page


def test_a_run_that_nobody_analysed_says_nothing_of_it(library: Library):
    write_table(analysed("elsewhere", TURNING), library.root / RUN / "turning.parquet")
    assert turned_of(library.root / RUN, rows(library.store, RUN)) is None
    assert "one other answer" not in said(library)


def test_every_class_is_explained():
    assert set(RULES) == set(VERDICTS)
