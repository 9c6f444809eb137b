from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from c2nav_engine.metrics.dtw import dtw_m
from c2nav_engine.metrics.ndtw import ndtw

coordinate = st.floats(-5.0, 5.0)
paths = st.lists(st.tuples(coordinate, coordinate, coordinate), min_size=1, max_size=7)
Path = list[tuple[float, float, float]]


def by_recursion(a: Path, b: Path) -> float:
    @cache
    def least(i: int, j: int) -> float:
        if i < 0 or j < 0:
            return 0.0 if i == j else math.inf
        return math.dist(a[i], b[j]) + min(least(i - 1, j), least(i, j - 1), least(i - 1, j - 1))

    return least(len(a) - 1, len(b) - 1)


@given(paths, paths)
def test_dtw_is_the_least_cost_over_all_alignments(a: Path, b: Path) -> None:
    assert dtw_m(np.array(a), np.array(b)) == pytest.approx(by_recursion(a, b))


@given(paths, paths)
def test_dtw_is_symmetric_and_zero_on_itself(a: Path, b: Path) -> None:
    assert dtw_m(np.array(a), np.array(b)) == pytest.approx(dtw_m(np.array(b), np.array(a)))
    assert dtw_m(np.array(a), np.array(a)) == 0.0


@given(paths, paths, st.data())
def test_standing_still_changes_no_ndtw(a: Path, b: Path, data: st.DataObject) -> None:
    repeated = [point for point in a for _ in range(data.draw(st.integers(1, 3)))]
    assert ndtw(tuple(repeated), tuple(b)) == ndtw(tuple(a), tuple(b))
    assert 0.0 <= ndtw(tuple(a), tuple(b)) <= 1.0


@given(paths)
def test_a_path_follows_itself(a: Path) -> None:
    assert ndtw(tuple(a), tuple(a)) == 1.0


def test_a_worked_value() -> None:
    # Three points each 1 m beside theirs: DTW = 3, |G| = 3, so exp(−3 / 9).
    path = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.0))
    beside = tuple((x, y, 1.0) for x, y, _ in path)
    assert ndtw(beside, path) == pytest.approx(math.exp(-1.0 / 3.0))
