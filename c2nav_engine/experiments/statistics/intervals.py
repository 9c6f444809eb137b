"""Intervals of one figure over episodes: Wilson for rates, BCa bootstrap for means."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from jaxtyping import Float

LEVEL = 0.95
RESAMPLES = 10_000
_NORMAL = NormalDist()
_CHUNK = 2_000_000
"""Drawn values held at once."""


@dataclass(frozen=True, slots=True)
class Interval:
    """An estimate with a confidence interval, in the unit of the estimate.

    Attributes:
        estimate: The figure itself.
        low: Lower end; −inf where nothing bounds it (a single value).
        high: Upper end.
        n: Episodes (or answers) behind it.
    """

    estimate: float
    low: float
    high: float
    n: int


def wilson(successes: int, n: int, *, level: float = LEVEL) -> Interval:
    """Score interval of a rate, as a fraction of one; n = 0 gives an estimate of nan in [0, 1]."""
    if n == 0:
        return Interval(math.nan, 0.0, 1.0, 0)
    z = _NORMAL.inv_cdf(0.5 + level / 2.0)
    rate = successes / n
    centre = (rate + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * math.sqrt(rate * (1 - rate) / n + z * z / (4 * n * n))
    # At 0 of n and n of n one end is the estimate itself; rounding must not pass it.
    return Interval(rate, min(rate, max(0.0, centre - half)), max(rate, min(1.0, centre + half)), n)


def bca_mean(
    values: Sequence[float], *, seed: int, level: float = LEVEL, resamples: int = RESAMPLES
) -> Interval:
    """Bias-corrected and accelerated bootstrap interval of a mean, over episodes.

    Equal values give an interval of width zero; one value is bounded by nothing. Raises
    `ValueError` for no values or infinite ones: leave unreachable goals out and say how many.
    """
    sample = _finite(values)
    n, mean = len(sample), float(sample.mean())
    if n == 1:
        return Interval(mean, -math.inf, math.inf, 1)
    if np.ptp(sample) == 0.0:
        return Interval(mean, mean, mean, n)
    means = resampled_means(sample, seed=seed, resamples=resamples)
    low, high = _bca_ends(sample, means, level=level)
    return Interval(mean, low, high, n)


def resampled_means(
    sample: Float[np.ndarray, " n"], *, seed: int, resamples: int = RESAMPLES
) -> Float[np.ndarray, " resamples"]:
    """Means of samples drawn with replacement, sorted."""
    generator = np.random.default_rng(seed)
    n = len(sample)
    means = np.empty(resamples)
    chunk = max(1, _CHUNK // n)
    for start in range(0, resamples, chunk):
        count = min(chunk, resamples - start)
        drawn = generator.integers(0, n, size=(count, n))
        means[start : start + count] = sample[drawn].mean(axis=1)
    means.sort()
    return means


def _bca_ends(
    sample: Float[np.ndarray, " n"], means: Float[np.ndarray, " resamples"], *, level: float
) -> tuple[float, float]:
    mean = float(sample.mean())
    # Half of the ties count as below (rates and other discrete values have many), and sums in
    # another order are ties although their last digits differ.
    rounding = 1e-9 * float(np.ptp(sample))
    below = np.count_nonzero(means < mean - rounding)
    at_or_below = np.count_nonzero(means <= mean + rounding)
    # Kept off 0 and 1, where few resamples may all lie on one side of the mean.
    share = (below + at_or_below) / (2 * len(means))
    edge = 0.5 / len(means)
    bias = _NORMAL.inv_cdf(min(max(share, edge), 1.0 - edge))
    # The jackknife of a mean is linear in the values: only their skewness is left. It has no unit,
    # so the values are scaled first: cubes of very small ones would vanish.
    centred = sample - mean
    centred /= np.abs(centred).max()
    acceleration = float((centred**3).sum() / (6.0 * (centred**2).sum() ** 1.5))
    z = _NORMAL.inv_cdf(0.5 + level / 2.0)
    shifted = [bias + (bias + side) / (1.0 - acceleration * (bias + side)) for side in (-z, z)]
    low, high = np.quantile(means, [_NORMAL.cdf(each) for each in shifted])
    return float(low), float(high)


def _finite(values: Sequence[float]) -> Float[np.ndarray, " n"]:
    sample = np.array(values, dtype=float)
    if len(sample) == 0 or not np.isfinite(sample).all():
        odd = int((~np.isfinite(sample)).sum())
        message = f"expected one or more finite values, came {len(sample)} with {odd} not finite"
        raise ValueError(message)
    return sample
