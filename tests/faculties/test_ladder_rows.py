"""The ladder's 27 rows, written out as the method states them."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest

from c2nav_engine.faculties.arriving.ladder import LADDER, Evidence, Verdict, verdict_of

CODES = (-1, 0, 1)
STOPS = {(1, 1, 0), (1, 1, 1), (1, 0, 1), (0, 1, 1)}
INSPECTS = {(1, 0, 0), (0, 1, 0)}


@pytest.mark.parametrize("row", list(itertools.product(CODES, repeat=3)))
def test_row(row: tuple[int, int, int]):
    wanted = Verdict.STOP if row in STOPS else Verdict.INSPECT if row in INSPECTS else Verdict.HOLD
    assert verdict_of(Evidence(*row)) is wanted


def test_the_table_is_whole():
    assert set(LADDER) == set(itertools.product(CODES, repeat=3))


def test_more_evidence_never_turns_a_stop_into_less():
    order = {Verdict.HOLD: 0, Verdict.INSPECT: 1, Verdict.STOP: 2}
    for row in LADDER:
        for place in range(3):
            if row[place] < 1 and not (place == 2 and row[2] == -1):
                more = Evidence(*(*row[:place], row[place] + 1, *row[place + 1 :]))
                assert order[verdict_of(more)] >= order[LADDER[row]]


def test_the_documentation_shows_the_same_table():
    page = (Path(__file__).parents[2] / "docs" / "arriving.md").read_text(encoding="utf-8")
    cells = [
        [cell.strip().replace("−", "-") for cell in line.strip("|").split("|")]
        for line in page.splitlines()
        if line.startswith("| ") and line.count("|") == 5 and "look-back" not in line
    ]
    table = {tuple(map(int, row[:3])): row[3] for row in cells}
    assert table == {row: verdict.value for row, verdict in LADDER.items()}
