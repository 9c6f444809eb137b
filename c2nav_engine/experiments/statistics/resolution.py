"""What n episodes can tell apart, before anyone reads a difference into them."""

from __future__ import annotations

import enum
from dataclasses import dataclass

from c2nav_engine.experiments.statistics.paired import mcnemar_p

ALPHA = 0.05
_NEGLIGIBLE = 1e-9


class Resolvable(enum.StrEnum):
    """Whether two success counts on the same episodes can differ significantly."""

    ALWAYS = "always"
    """Whatever the overlap of the two runs' successes."""
    DEPENDS = "depends"
    """Only with few enough discordant episodes."""
    NEVER = "never"
    """Not even when one run's successes hold all of the other's."""


@dataclass(frozen=True, slots=True)
class Resolution:
    """What n episodes say about two success counts.

    Attributes:
        verdict: Always, depends or never.
        least_discordant: Discordant episodes when one run's successes hold the other's.
        most_discordant: Largest number of discordant episodes that still is significant; −1 when
            none is.
        words: One sentence for a report.
    """

    verdict: Resolvable
    least_discordant: int
    most_discordant: int
    words: str


def resolution(successes_a: int, successes_b: int, *, n: int, alpha: float = ALPHA) -> Resolution:
    """Which overlaps of two runs would make their difference significant (exact McNemar)."""
    if not (0 <= successes_a <= n and 0 <= successes_b <= n):
        message = f"expected success counts within 0 … {n}, came {successes_a} and {successes_b}"
        raise ValueError(message)
    more, fewer = max(successes_a, successes_b), min(successes_a, successes_b)
    gap = more - fewer
    # k episodes are solved by the weaker run alone; p grows with k.
    possible = range(min(fewer, n - more) + 1)
    significant = [k for k in possible if mcnemar_p(gap + k, k) < alpha]
    if not significant:
        words = f"{_counts(successes_a, successes_b, n)} cannot be resolved with n = {n}"
        return Resolution(Resolvable.NEVER, gap, -1, words)
    most = gap + 2 * significant[-1]
    if len(significant) == len(possible):
        words = f"{_counts(successes_a, successes_b, n)} is significant whatever the overlap"
        return Resolution(Resolvable.ALWAYS, gap, most, words)
    limit = "only if nested" if most == gap else f"only with at most {most} discordant episodes"
    words = f"{_counts(successes_a, successes_b, n)} is significant {limit}"
    return Resolution(Resolvable.DEPENDS, gap, most, words)


def least_resolvable_gap(*, alpha: float = ALPHA) -> int:
    """Fewest episodes by which nested runs must differ: 6 at 0.05, whatever n."""
    gap = 1
    while mcnemar_p(gap, 0) >= alpha:
        gap += 1
    return gap


def power(*, only_a: float, only_b: float, n: int, alpha: float = ALPHA) -> float:
    """Chance that exact McNemar resolves two runs with these true rates of discordance.

    Args:
        only_a: Probability that an episode is solved by the first alone.
        only_b: Probability that it is solved by the second alone.
        n: Episodes.
        alpha: Significance level.
    """
    discordance = only_a + only_b
    if discordance == 0.0:
        return 0.0
    # scipy takes a fifth of a second: what only shows or steps a run does not pay for it.
    from scipy.special import bdtr, bdtrc

    share, total, below = only_a / discordance, 0.0, 0.0
    for discordant in range(n + 1):
        up_to = float(bdtr(discordant, n, discordance))
        weight, below = up_to - below, up_to
        low = _critical(discordant, alpha) if weight > _NEGLIGIBLE else -1
        if low >= 0:
            few = float(bdtr(low, discordant, share))
            many = float(bdtrc(discordant - low - 1, discordant, share))
            total += weight * (few + many)
    return total


def _critical(discordant: int, alpha: float) -> int:
    """Largest minority count that is significant; −1 when none is."""
    low = -1
    while low + 1 <= discordant // 2 and mcnemar_p(low + 1, discordant - low - 1) < alpha:
        low += 1
    return low


def _counts(a: int, b: int, n: int) -> str:
    return f"{a} against {b} of {n}"
