"""The ladder's 27 rows, written out as the method states them."""

from __future__ import annotations

import itertools

import pytest

from c2nav_engine.faculties.arriving.ladder import LADDER, Evidence, Verdict, verdict_of

CODES = (-1, 0, 1)
STOPS = {(1, 1, 0), (1, 1, 1), (1, 0, 1), (0, 1, 1)}
INSPECTS = {(1, 0, 0), (0, 1, 0)}


@pytest.mark.parametrize("row", list(itertools.product(CODES, repeat=3)))
def test_row(row):
    wanted = Verdict.STOP if row in STOPS else Verdict.INSPECT if row in INSPECTS else Verdict.HOLD
    assert verdict_of(Evidence(*row)) is wanted


def test_the_table_is_whole():
    assert set(LADDER) == set(itertools.product(CODES, repeat=3))


def test_more_evidence_never_turns_a_stop_into_less():
    order = {Verdict.HOLD: 0, Verdict.INSPECT: 1, Verdict.STOP: 2}
    for row in LADDER:
        for place in range(3):
            if row[place] < 1 and not (place == 2 and row[2] == -1):
                more = (*row[:place], row[place] + 1, *row[place + 1 :])
                assert order[LADDER[more]] >= order[LADDER[row]]
