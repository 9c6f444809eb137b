from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import ttest_rel
from statsmodels.stats.contingency_tables import mcnemar as statsmodels_mcnemar
from statsmodels.stats.multitest import multipletests

from c2nav_engine.experiments.statistics.paired import holm, mcnemar, mcnemar_p, paired_difference
from c2nav_engine.experiments.statistics.resolution import (
    Resolvable,
    least_resolvable_gap,
    power,
    resolution,
)


@given(st.lists(st.tuples(st.booleans(), st.booleans()), min_size=1, max_size=120))
def test_mcnemar_equals_statsmodels(pairs: list[tuple[bool, bool]]) -> None:
    test = mcnemar([a for a, _ in pairs], [b for _, b in pairs])
    table = [[test.both, test.only_a], [test.only_b, test.neither]]
    assert sum(map(sum, table)) == len(pairs)
    theirs = statsmodels_mcnemar(table, exact=True)
    assert test.p == pytest.approx(theirs.pvalue, abs=1e-12)  # pyright: ignore[reportAttributeAccessIssue]
    assert test.discordant == sum(a != b for a, b in pairs)


@given(st.integers(0, 60), st.integers(0, 60))
def test_mcnemar_is_the_same_both_ways(a: int, b: int) -> None:
    assert mcnemar_p(a, b) == mcnemar_p(b, a)


def test_runs_of_different_episodes_are_refused() -> None:
    with pytest.raises(ValueError, match="came 2 and 1 values"):
        mcnemar([True, False], [True])


def test_paired_difference_is_near_the_t_test_where_that_holds() -> None:
    generator = np.random.default_rng(4)
    a = generator.normal(5.0, 2.0, size=100)
    b = a + generator.normal(0.3, 1.2, size=100)
    test = paired_difference(list(a), list(b), seed=0)
    theirs = ttest_rel(b, a)
    assert test.difference.estimate == pytest.approx((b - a).mean())
    assert test.p == pytest.approx(theirs.pvalue, abs=0.01)
    low, high = theirs.confidence_interval(0.95)
    assert (test.difference.low, test.difference.high) == pytest.approx((low, high), abs=0.03)


def test_unreachable_goals_are_left_out_and_counted() -> None:
    test = paired_difference([1.0, math.inf, 2.0, 4.0], [2.0, 3.0, 2.5, math.inf], seed=0)
    assert (test.left_out, test.difference.n) == (2, 2)
    assert test.difference.estimate == 0.75


def test_equal_runs_do_not_differ() -> None:
    test = paired_difference([1.0, 2.0, 3.0], [1.0, 2.0, 3.0], seed=0)
    assert (test.difference.estimate, test.p) == (0.0, 1.0)


@given(st.lists(st.floats(0.0, 1.0), min_size=1, max_size=12))
@settings(max_examples=20)
def test_holm_equals_statsmodels(p_values: list[float]) -> None:
    named = {f"config{i}": p for i, p in enumerate(p_values)}
    adjusted = holm(named)
    theirs = np.asarray(multipletests(p_values, method="holm")[1])
    assert [adjusted[key] for key in named] == pytest.approx(list(theirs))


@pytest.mark.parametrize(
    ("other", "verdict", "most"),
    [
        (12, Resolvable.ALWAYS, 43),
        (14, Resolvable.ALWAYS, 45),
        (21, Resolvable.DEPENDS, 20),
        (25, Resolvable.DEPENDS, 6),
        (28, Resolvable.NEVER, -1),
        (29, Resolvable.NEVER, -1),
    ],
)
def test_what_a_hundred_episodes_resolve(other: int, verdict: Resolvable, most: int) -> None:
    told = resolution(31, other, n=100)
    assert (told.verdict, told.most_discordant) == (verdict, most)
    assert told.least_discordant == 31 - other
    assert resolution(other, 31, n=100).verdict == verdict


def test_the_sentences_of_a_report() -> None:
    assert resolution(31, 28, n=100).words == "31 against 28 of 100 cannot be resolved with n = 100"
    assert resolution(31, 25, n=100).words.endswith("significant only if nested")
    assert resolution(31, 21, n=100).words.endswith("only with at most 20 discordant episodes")
    assert resolution(31, 12, n=100).words.endswith("significant whatever the overlap")


@given(st.integers(1, 60), st.data())
def test_every_overlap_is_judged_by_the_test_itself(n: int, data: st.DataObject) -> None:
    a, b = data.draw(st.integers(0, n)), data.draw(st.integers(0, n))
    told = resolution(a, b, n=n)
    shared = range(max(0, a + b - n), min(a, b) + 1)
    verdicts = {mcnemar_p(a - both, b - both) < 0.05 for both in shared}
    expected = {
        Resolvable.ALWAYS: {True},
        Resolvable.NEVER: {False},
        Resolvable.DEPENDS: {True, False},
    }
    assert verdicts == expected[told.verdict]


def test_six_episodes_are_the_least_that_anything_resolves() -> None:
    assert least_resolvable_gap() == 6


def test_power_for_ten_points_is_about_one_half() -> None:
    assert power(only_a=0.15, only_b=0.05, n=100) == pytest.approx(0.5, abs=0.1)
    assert power(only_a=0.0, only_b=0.0, n=100) == 0.0


def test_power_equals_a_simulation() -> None:
    generator = np.random.default_rng(0)
    counts = generator.multinomial(50, [0.25, 0.05, 0.70], size=4000)
    hits = np.mean([mcnemar_p(int(a), int(b)) < 0.05 for a, b, _ in counts])
    assert power(only_a=0.25, only_b=0.05, n=50) == pytest.approx(hits, abs=0.03)


def test_a_level_test_stays_at_its_level() -> None:
    assert power(only_a=0.1, only_b=0.1, n=100) <= 0.05
