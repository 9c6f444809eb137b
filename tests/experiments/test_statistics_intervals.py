from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import bootstrap
from statsmodels.stats.proportion import proportion_confint

from c2nav_engine.experiments.statistics.clusters import cluster_interval, cluster_mean_interval
from c2nav_engine.experiments.statistics.intervals import bca_mean, wilson

values = st.lists(st.floats(-100.0, 100.0), min_size=2, max_size=20)


@given(st.integers(1, 2000), st.data())
def test_wilson_equals_statsmodels(n: int, data: st.DataObject) -> None:
    successes = data.draw(st.integers(0, n))
    interval = wilson(successes, n)
    low, high = proportion_confint(successes, n, method="wilson")
    assert interval.low == pytest.approx(low, abs=1e-12)
    assert interval.high == pytest.approx(high, abs=1e-12)
    assert 0.0 <= interval.low <= interval.estimate <= interval.high <= 1.0


def test_wilson_of_nothing_is_the_whole_range() -> None:
    interval = wilson(0, 0)
    assert math.isnan(interval.estimate) and (interval.low, interval.high) == (0.0, 1.0)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_bca_agrees_with_scipys_up_to_the_draws(seed: int) -> None:
    sample = np.random.default_rng(seed).gamma(1.0, 3.0, size=60)
    ours = bca_mean(list(sample), seed=seed)
    theirs = bootstrap((sample,), np.mean, n_resamples=9999, method="BCa", rng=seed)
    width = theirs.confidence_interval.high - theirs.confidence_interval.low
    assert ours.low == pytest.approx(theirs.confidence_interval.low, abs=0.05 * width)
    assert ours.high == pytest.approx(theirs.confidence_interval.high, abs=0.05 * width)


def test_bca_covers_the_mean_of_a_skewed_population_about_as_often_as_it_says() -> None:
    generator = np.random.default_rng(7)
    covered = 0
    for seed in range(300):
        interval = bca_mean(list(generator.exponential(1.0, size=60)), seed=seed, resamples=1000)
        covered += interval.low <= 1.0 <= interval.high
    assert 0.90 <= covered / 300 <= 0.98


@given(values, st.floats(-50.0, 50.0))
@settings(max_examples=30)
def test_bca_moves_with_its_values(sample: list[float], shift: float) -> None:
    before = bca_mean(sample, seed=3, resamples=200)
    after = bca_mean([value + shift for value in sample], seed=3, resamples=200)
    if np.ptp(sample) > 1e-6:
        assert after.low == pytest.approx(before.low + shift, abs=1e-6)
        assert after.high == pytest.approx(before.high + shift, abs=1e-6)
        assert before.low <= before.high


def test_bca_scales_with_its_values() -> None:
    sample = [0.0, 1.0, 1.0, 5.0]
    usual, tiny = (bca_mean([s * v for v in sample], seed=3) for s in (1.0, 2.0**-500))
    assert tiny.high == usual.high * 2.0**-500
    assert tiny.low == usual.low * 2.0**-500


def test_bca_is_seeded() -> None:
    sample = [0.13, 0.29, 0.97, 1.01, 0.43]
    assert bca_mean(sample, seed=1) == bca_mean(sample, seed=1)
    assert bca_mean(sample, seed=1) != bca_mean(sample, seed=2)


def test_bca_at_its_edges() -> None:
    assert (bca_mean([0.5] * 9, seed=0).low, bca_mean([0.5] * 9, seed=0).high) == (0.5, 0.5)
    assert bca_mean([0.5], seed=0).high == math.inf
    for bad in ([], [1.0, math.inf]):
        with pytest.raises(ValueError, match="expected one or more finite values"):
            bca_mean(bad, seed=0)


def mean(items: object) -> float | None:
    numbers = list(items) if isinstance(items, (list, tuple)) else []
    return float(np.mean(numbers)) if numbers else None


def test_both_cluster_bootstraps_are_one_for_a_mean() -> None:
    generator = np.random.default_rng(0)
    clusters = [list(generator.normal(size=generator.integers(1, 6))) for _ in range(30)]
    plain = cluster_interval(clusters, mean, seed=1)
    quick = cluster_mean_interval(clusters, seed=1)
    assert plain is not None and quick is not None
    assert quick.estimate == pytest.approx(plain.estimate)
    assert quick.n == plain.n
    assert quick.low == pytest.approx(plain.low, abs=0.03)
    assert quick.high == pytest.approx(plain.high, abs=0.03)


def test_answers_that_repeat_within_an_episode_do_not_narrow_the_interval() -> None:
    singles = [[float(i % 2)] for i in range(20)]
    repeated = [cluster * 10 for cluster in singles]
    once = cluster_mean_interval(singles, seed=5)
    tenfold = cluster_mean_interval(repeated, seed=5)
    assert once is not None and tenfold is not None
    assert (once.low, once.high) == pytest.approx((tenfold.low, tenfold.high))


def test_no_items_give_no_interval() -> None:
    assert cluster_interval([[], []], mean, seed=0) is None
    assert cluster_mean_interval([[], []], seed=0) is None
