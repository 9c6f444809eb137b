"""How far people and models agree: by pair of raters, by kind of pair, by slot.

Answers are compared by role ("left", "stay"), never by position. Intervals come from drawing whole
episodes again, because the answers of one episode are alike. α stands for single slots only: over
several slots the slot alone would already tell "stay" from "left", and α would flatter.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations
from statistics import fmean

import numpy as np

from app.reviews.answers import Answer, Answers, Rater
from c2nav_engine.experiments.statistics.agreement import (
    kendall_tau,
    krippendorff_alpha,
    tiers_to_ranks,
)
from c2nav_engine.experiments.statistics.clusters import RESAMPLES, cluster_mean_interval
from c2nav_engine.experiments.statistics.intervals import LEVEL, Interval
from c2nav_engine.experiments.statistics.orders import (
    chance_of_winning,
    first_excess,
    last_excess,
    position_consistency,
    repetition_stability,
)

KINDS = ("human-human", "human-model", "model-model", "seen", "privileged")
"""Of pairs; a person who had seen the model's answer, or a ranker that knows the truth, makes every
pair of theirs one apart, whoever the other one is."""
ALL = "all"
"""Stands for every slot together."""


@dataclass(frozen=True, slots=True)
class Agreement:
    """One row: a pair of raters, or all pairs of a kind, on one slot or on all.

    Attributes:
        kind: One of `KINDS`.
        a: First rater; "" for all pairs of the kind.
        b: Second rater.
        slot: Decision slot, or "all".
        questions: Questions that both answered, electing or not, over all pairs.
        episodes: Episodes that they are of: what intervals are drawn over.
        top1: Share of equal winners where both elected one; interval over episodes.
        chance: What two uniform choices would give there: mean 1/m over offered alternatives.
        tau: Mean Kendall's τ-b where both ranked.
        alpha: Krippendorff's nominal α over winners by role; None over several slots,
            and for raters of different kinds all together.
        confusion: (winner of a, winner of b) → how often.
    """

    kind: str
    a: str
    b: str
    slot: str
    questions: int
    episodes: int
    top1: Interval | None
    chance: float | None
    tau: Interval | None
    alpha: Interval | None
    confusion: dict[tuple[str, str], int]


@dataclass(frozen=True, slots=True)
class OrderEffects:
    """What the order shown does to one rater, on one slot or on all.

    Attributes:
        rater: Who.
        slot: Decision slot, or "all".
        consistency: Share of questions shown in several orders with one winner throughout.
        stability: Share of presentations that came again as they were, answered alike.
        first: How much more often than 1/m the alternative shown first wins.
        last: The same for the one shown last.
        chance: Mean 1/m: the line that the excesses are measured from.
    """

    rater: Rater
    slot: str
    consistency: Interval
    stability: Interval
    first: Interval | None
    last: Interval | None
    chance: float | None


@dataclass(frozen=True, slots=True)
class Pair:
    """Two answers to one question."""

    a: Answer
    b: Answer


def agreements(answers: Answers, *, seed: int = 0) -> list[Agreement]:
    """Every kind of pair together, then every pair; each over all slots and slot by slot."""
    pairs = pairs_of(answers)
    rows: list[Agreement] = []
    for kind in KINDS:
        mine = {names: found for names, found in pairs.items() if kind_of(*names) == kind and found}
        together = [pair for found in mine.values() for pair in found]
        if len(mine) > 1:
            rows += _rows((kind, "", ""), together, seed)
        for (a, b), found in mine.items():
            rows += _rows((kind, a.name, b.name), found, seed)
    return rows


def pairs_of(answers: Answers) -> dict[tuple[Rater, Rater], list[Pair]]:
    """Every two raters, people first → their answers to what both were asked."""
    by_rater: dict[Rater, dict[str, Answer]] = {}
    for answer in answers.given:
        by_rater.setdefault(answer.rater, {})[answer.question] = answer
    raters = sorted(by_rater, key=standing)
    return {
        (a, b): [
            Pair(by_rater[a][question], by_rater[b][question])
            for question in by_rater[a]
            if question in by_rater[b]
        ]
        for a, b in combinations(raters, 2)
    }


def standing(rater: Rater) -> tuple[bool, bool, bool, str]:
    """Raters in the order in which they stand: people, models, whoever had seen or knows more."""
    return (rater.privileged, rater.seen, not rater.human, rater.name)


def kind_of(a: Rater, b: Rater) -> str:
    """Which of `KINDS` a pair is; a model never comes before a person."""
    if a.privileged or b.privileged:
        return "privileged"
    return "seen" if a.seen or b.seen else KINDS[2 - a.human - b.human]


def _rows(names: tuple[str, str, str], pairs: Sequence[Pair], seed: int) -> list[Agreement]:
    slots = sorted({pair.a.slot for pair in pairs})
    shares = {ALL: list(pairs)} | {
        slot: [pair for pair in pairs if pair.a.slot == slot] for slot in slots
    }
    if len(slots) == 1:
        del shares[ALL]
    return [_row(names, slot, found, seed) for slot, found in shares.items()]


def _row(names: tuple[str, str, str], slot: str, pairs: Sequence[Pair], seed: int) -> Agreement:
    elected = [pair for pair in pairs if None not in (pair.a.winner, pair.b.winner)]
    kind, a, b = names
    # Raters of different kinds together are no sample of one: only a pair of them has its α.
    alike = bool(a) or kind in ("human-human", "model-model")
    return Agreement(
        kind=kind,
        a=a,
        b=b,
        slot=slot,
        questions=len(pairs),
        episodes=len({pair.a.episode for pair in pairs}),
        top1=_mean(elected, lambda pair: float(pair.a.winner == pair.b.winner), seed),
        chance=fmean(1.0 / len(pair.a.keys) for pair in elected) if elected else None,
        tau=_mean(pairs, _tau, seed),
        alpha=alpha_interval(_units(elected), seed=seed) if alike and slot != ALL else None,
        confusion=dict(
            Counter((str(pair.a.winner), str(pair.b.winner)) for pair in elected).most_common()
        ),
    )


def _tau(pair: Pair) -> float | None:
    a, b = tiers_to_ranks(pair.a.tiers), tiers_to_ranks(pair.b.tiers)
    return kendall_tau(a, b) if a and a.keys() == b.keys() else None


def _mean(
    pairs: Iterable[Pair], value: Callable[[Pair], float | None], seed: int
) -> Interval | None:
    clusters: dict[str, list[float]] = {}
    for pair in pairs:
        if (found := value(pair)) is not None:
            clusters.setdefault(pair.a.episode, []).append(found)
    return cluster_mean_interval(list(clusters.values()), seed=seed) if clusters else None


Units = dict[str, list[list[str]]]
"""Episode → its questions → the winners that were given there."""


def _units(pairs: Sequence[Pair]) -> Units:
    """Each question once, with one winner a rater."""
    labels: dict[tuple[str, str], dict[Rater, str]] = {}
    for pair in pairs:
        for answer in (pair.a, pair.b):
            if answer.winner is not None:
                found = labels.setdefault((answer.episode, answer.question), {})
                found[answer.rater] = answer.winner
    units: Units = {}
    for (episode, _), found in labels.items():
        units.setdefault(episode, []).append(list(found.values()))
    return units


def alpha_interval(
    units: Units, *, seed: int, level: float = LEVEL, resamples: int = RESAMPLES
) -> Interval | None:
    """Krippendorff's nominal α with a percentile interval over episodes; None where undefined.

    α is made of sums over questions, so a resample needs its episodes' sums alone.
    """
    every = [unit for found in units.values() for unit in found]
    estimate = krippendorff_alpha(every)
    if estimate is None:
        return None
    names = sorted({label for unit in every for label in unit})
    sums = np.array([_sums(found, names) for found in units.values()])
    generator = np.random.default_rng(seed)
    chosen = generator.integers(0, len(sums), size=(resamples, len(sums)))
    drawn = sums[chosen].sum(axis=1)
    counts, disagreement = drawn[:, :-1], drawn[:, -1]
    n = counts.sum(axis=1)
    expected = n * n - (counts * counts).sum(axis=1)
    defined = expected > 0
    alphas = 1.0 - (n[defined] - 1.0) * disagreement[defined] / expected[defined]
    low, high = np.quantile(alphas, [0.5 - level / 2.0, 0.5 + level / 2.0])
    return Interval(estimate, float(low), float(high), len(every))


def _sums(units: Sequence[Sequence[str]], names: Sequence[str]) -> list[float]:
    """Counts of each label, then the observed disagreement, over questions with two labels."""
    paired = [unit for unit in units if len(unit) >= 2]
    counts = Counter(label for unit in paired for label in unit)
    disagreement = sum(
        sum(a != b for a, b in combinations(unit, 2)) * 2 / (len(unit) - 1) for unit in paired
    )
    return [*(float(counts[name]) for name in names), disagreement]


def order_effects(answers: Answers, *, seed: int = 0) -> list[OrderEffects]:
    """Every rater, over all slots and slot by slot."""
    rows: list[OrderEffects] = []
    raters = {showing.rater for showing in answers.showings}
    for rater in sorted(raters, key=standing):
        mine = [showing for showing in answers.showings if showing.rater == rater]
        for slot in (ALL, *sorted({showing.slot for showing in mine})):
            shown = [one.shown for one in mine if slot in (ALL, one.slot)]
            rows.append(
                OrderEffects(
                    rater=rater,
                    slot=slot,
                    consistency=position_consistency(shown),
                    stability=repetition_stability(shown),
                    first=first_excess(shown, seed=seed),
                    last=last_excess(shown, seed=seed),
                    chance=chance_of_winning(shown),
                )
            )
    return rows
