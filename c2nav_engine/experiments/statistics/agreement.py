"""Do two rankers, or a ranker and people, say the same?

Answers are compared by the candidate's role ("left", "stay"), never by its position on the page.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, permutations
from statistics import fmean

from c2nav_engine.experiments.statistics.intervals import Interval, wilson


@dataclass(frozen=True, slots=True)
class Choice:
    """Two winners of one decision.

    Attributes:
        a: The first ranker's winner, by role.
        b: The second's.
        options: Feasible alternatives that were offered (m ≥ 2).
    """

    a: Hashable
    b: Hashable
    options: int


@dataclass(frozen=True, slots=True)
class Top1:
    """How often two rankers elect the same alternative.

    Attributes:
        agreement: Rate with its Wilson interval.
        chance: What two independent uniform choices would give: the mean of 1/m.
    """

    agreement: Interval
    chance: float


def top1(choices: Sequence[Choice]) -> Top1 | None:
    """Top-1 agreement beside its chance line; None without choices."""
    if not choices:
        return None
    equal = sum(choice.a == choice.b for choice in choices)
    return Top1(wilson(equal, len(choices)), fmean(1.0 / choice.options for choice in choices))


def kendall_tau(a: Mapping[str, int], b: Mapping[str, int]) -> float | None:
    """τ-b of two rankings of the same keys, given as key → tier; None where one ties them all."""
    if a.keys() != b.keys():
        message = f"expected two rankings of the same keys, came {sorted(a)} and {sorted(b)}"
        raise ValueError(message)
    agreeing, strict_a, strict_b = 0, 0, 0
    for x, y in combinations(sorted(a), 2):
        sign_a, sign_b = _sign(a[x] - a[y]), _sign(b[x] - b[y])
        agreeing += sign_a * sign_b
        strict_a += sign_a != 0
        strict_b += sign_b != 0
    if strict_a == 0 or strict_b == 0:
        return None
    return agreeing / (strict_a * strict_b) ** 0.5


def mean_kendall_tau(pairs: Sequence[tuple[Mapping[str, int], Mapping[str, int]]]) -> float | None:
    """Mean τ over decisions: one alone says nothing (at m = 3 it takes ±1 and ±1/3)."""
    values = [tau for a, b in pairs if (tau := kendall_tau(a, b)) is not None]
    return fmean(values) if values else None


def tiers_to_ranks(tiers: Sequence[Sequence[str]]) -> dict[str, int]:
    """Key → tier, best 0, of an ordering's tiers."""
    return {key: rank for rank, tier in enumerate(tiers) for key in tier}


def krippendorff_alpha(units: Sequence[Sequence[Hashable | None]]) -> float | None:
    """Krippendorff's α for nominal labels, any number of raters, missing ones as None.

    1 is perfect agreement, 0 is chance. None where it is undefined: fewer than one unit with two
    labels, or one label throughout.

    Args:
        units: For each decision, the labels that its raters gave.
    """
    totals: Counter[Hashable] = Counter()
    disagreement = 0.0
    for unit in units:
        labels = [label for label in unit if label is not None]
        if len(labels) < 2:
            continue
        totals.update(labels)
        unequal = sum(a != b for a, b in permutations(labels, 2))
        disagreement += unequal / (len(labels) - 1)
    n = sum(totals.values())
    expected = n * n - sum(count * count for count in totals.values())
    return 1.0 - (n - 1) * disagreement / expected if expected else None


def _sign(value: int) -> int:
    return (value > 0) - (value < 0)
