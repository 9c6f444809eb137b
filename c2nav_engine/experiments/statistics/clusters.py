"""Bootstrap over episodes for figures that are made of many answers in each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np

from c2nav_engine.experiments.statistics.intervals import LEVEL, Interval

T = TypeVar("T")
RESAMPLES = 2_000


def cluster_interval(
    clusters: Sequence[Sequence[T]],
    statistic: Callable[[Sequence[T]], float | None],
    *,
    seed: int,
    level: float = LEVEL,
    resamples: int = RESAMPLES,
) -> Interval | None:
    """Percentile interval of a statistic, drawing whole episodes with replacement.

    Answers of one episode are alike, so drawing answers singly would claim too narrow an
    interval. Resamples on which the statistic is undefined are passed over; None where it is
    undefined on the whole.

    Args:
        clusters: The items of each episode.
        statistic: Of all items of the drawn episodes together; None where undefined.
        seed: Of the draws.
        level: Of the interval.
        resamples: Draws.
    """
    items = [item for cluster in clusters for item in cluster]
    estimate = statistic(items) if items else None
    if estimate is None:
        return None
    generator = np.random.default_rng(seed)
    drawn: list[float] = []
    for _ in range(resamples):
        chosen = generator.integers(0, len(clusters), size=len(clusters))
        value = statistic([item for index in chosen for item in clusters[int(index)]])
        if value is not None:
            drawn.append(value)
    low, high = np.quantile(drawn, [0.5 - level / 2.0, 0.5 + level / 2.0])
    return Interval(estimate, float(low), float(high), len(items))


def cluster_mean_interval(
    clusters: Sequence[Sequence[float]],
    *,
    seed: int,
    level: float = LEVEL,
    resamples: int = RESAMPLES,
) -> Interval | None:
    """The same for a plain mean over all items, without a Python loop over resamples."""
    sums = np.array([sum(cluster) for cluster in clusters], dtype=float)
    counts = np.array([len(cluster) for cluster in clusters], dtype=float)
    if counts.sum() == 0:
        return None
    generator = np.random.default_rng(seed)
    chosen = generator.integers(0, len(clusters), size=(resamples, len(clusters)))
    totals = counts[chosen].sum(axis=1)
    means = sums[chosen].sum(axis=1)[totals > 0] / totals[totals > 0]
    low, high = np.quantile(means, [0.5 - level / 2.0, 0.5 + level / 2.0])
    return Interval(float(sums.sum() / counts.sum()), float(low), float(high), int(counts.sum()))
