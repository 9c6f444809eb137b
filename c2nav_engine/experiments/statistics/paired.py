"""Two runs on the same episodes: exact McNemar for rates, paired bootstrap for SPL and NE."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from c2nav_engine.experiments.statistics.intervals import (
    LEVEL,
    RESAMPLES,
    Interval,
    bca_mean,
    resampled_means,
)


@dataclass(frozen=True, slots=True)
class McNemar:
    """The 2 × 2 table of two runs' successes, with its exact two-sided p.

    Attributes:
        both: Episodes where both succeed.
        only_a: Discordant: the first alone.
        only_b: Discordant: the second alone.
        neither: Episodes where both fail.
        p: Probability of a split at least this uneven among the discordant ones by chance.
    """

    both: int
    only_a: int
    only_b: int
    neither: int
    p: float

    @property
    def discordant(self) -> int:
        """Episodes that only one of the two solves."""
        return self.only_a + self.only_b


def mcnemar_p(only_a: int, only_b: int) -> float:
    """Exact two-sided p of a split of discordant episodes; 1 without any."""
    discordant = only_a + only_b
    if discordant == 0:
        return 1.0
    # scipy takes a fifth of a second: what only shows or steps a run does not pay for it.
    from scipy.special import bdtr

    return min(1.0, 2.0 * float(bdtr(min(only_a, only_b), discordant, 0.5)))


def mcnemar(a: Sequence[bool], b: Sequence[bool]) -> McNemar:
    """Exact McNemar test of two runs' outcomes, given in the same order of episodes."""
    _same_length(a, b)
    pairs = [(bool(x), bool(y)) for x, y in zip(a, b, strict=True)]
    only_a, only_b = pairs.count((True, False)), pairs.count((False, True))
    return McNemar(
        both=pairs.count((True, True)),
        only_a=only_a,
        only_b=only_b,
        neither=pairs.count((False, False)),
        p=mcnemar_p(only_a, only_b),
    )


@dataclass(frozen=True, slots=True)
class PairedDifference:
    """Mean of b − a over episodes.

    Attributes:
        difference: With its BCa interval, in the unit of the values.
        p: Two-sided bootstrap p of the difference under its own centred resamples.
        left_out: Episodes without two finite values (an unreachable goal), not part of it.
    """

    difference: Interval
    p: float
    left_out: int


def paired_difference(
    a: Sequence[float],
    b: Sequence[float],
    *,
    seed: int,
    level: float = LEVEL,
    resamples: int = RESAMPLES,
) -> PairedDifference:
    """Paired bootstrap of b − a; raises `ValueError` when no episode has two finite values."""
    _same_length(a, b)
    pairs = [(x, y) for x, y in zip(a, b, strict=True) if math.isfinite(x) and math.isfinite(y)]
    gaps = [y - x for x, y in pairs]
    difference = bca_mean(gaps, seed=seed, level=level, resamples=resamples)
    means = resampled_means(np.array(gaps, dtype=float), seed=seed, resamples=resamples)
    extreme = np.abs(means - difference.estimate) >= abs(difference.estimate) - 1e-12
    # Counting the observed one keeps p above zero: 1 / (resamples + 1) is all it can resolve.
    p = (1 + int(extreme.sum())) / (1 + resamples)
    return PairedDifference(difference, p, left_out=len(a) - len(pairs))


def holm(p_values: Mapping[str, float]) -> dict[str, float]:
    """Holm's step-down adjustment over distinct comparisons.

    Keys must name configurations by their hash: presets that are one configuration count once.
    """
    adjusted: dict[str, float] = {}
    highest = 0.0
    ranked = sorted(p_values, key=lambda key: p_values[key])
    for rank, key in enumerate(ranked):
        highest = max(highest, min(1.0, (len(ranked) - rank) * p_values[key]))
        adjusted[key] = highest
    return adjusted


def _same_length(a: Sequence[object], b: Sequence[object]) -> None:
    if len(a) != len(b) or not a:
        message = (
            "expected the outcomes of two runs on the same episodes, in the same order, "
            f"came {len(a)} and {len(b)} values"
        )
        raise ValueError(message)
