"""Paired tests on the same episodes: every configuration against `full`, and rankers in pairs.

Only rows with per-episode outcomes are ever tested; a reported figure has none.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from statistics import fmean

from c2nav_engine.experiments.columns import Row
from c2nav_engine.experiments.estimates import SEED, number
from c2nav_engine.experiments.report.systems import Arm, Section
from c2nav_engine.experiments.statistics.paired import (
    McNemar,
    PairedDifference,
    holm,
    mcnemar,
    paired_difference,
)
from c2nav_engine.experiments.statistics.resolution import ALPHA, resolution


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two arms on the episodes that both ran.

    Attributes:
        a: What is compared with.
        b: What is compared.
        family: Comparisons that Holm's adjustment counts together.
        episodes: Episodes that both ran.
        seed: The seed of the McNemar test: seeds of one episode are not independent.
        success: The 2 × 2 table of SR, with `only_a` the episodes that `a` alone solves.
        spl: Difference b − a of SPL, seeds of an episode averaged; None without values.
        ne_m: The same for NE; episodes with an unreachable goal are left out.
        holm: Adjusted p by figure ("sr", "spl", "ne_m").
        words: What n episodes can say about the success counts.
    """

    a: str
    b: str
    family: str
    episodes: int
    seed: int
    success: McNemar
    spl: PairedDifference | None
    ne_m: PairedDifference | None
    holm: Mapping[str, float]
    words: str

    @property
    def pair(self) -> str:
        """Names the comparison within its family."""
        return f"{self.b} against {self.a}"

    def p_values(self) -> dict[str, float]:
        """Unadjusted p by figure."""
        paired = {"spl": self.spl, "ne_m": self.ne_m}
        known = {name: each.p for name, each in paired.items() if each is not None}
        return {"sr": self.success.p, **known}

    def significant(self, name: str, *, alpha: float = ALPHA) -> bool:
        """Whether the adjusted p of a figure is below the level."""
        return self.holm.get(name, 1.0) < alpha


def variants_against_full(section: Section) -> tuple[Comparison, ...]:
    """Every distinct configuration of every system against its `full`."""
    made: list[Comparison] = []
    for system in section.systems:
        full = system.arm("full")
        for arm in system.arms if full is not None else ():
            if arm is not full and full is not None:
                named = (f"{system.label}: full", f"{system.label}: {' = '.join(arm.variants)}")
                made += _compared(full, arm, named, family=system.label)
    return _adjusted(made)


def systems_in_pairs(section: Section) -> tuple[Comparison, ...]:
    """`full` of every two systems."""
    made: list[Comparison] = []
    for a, b in combinations(section.systems, 2):
        full_a, full_b = a.arm("full"), b.arm("full")
        if full_a is not None and full_b is not None:
            made += _compared(full_a, full_b, (a.label, b.label), family="systems")
    return _adjusted(made)


def _compared(a: Arm, b: Arm, names: tuple[str, str], *, family: str) -> Iterator[Comparison]:
    seeds = [seed for seed in a.seeds if seed in b.seeds]
    if not seeds:
        return
    of_a, of_b = a.outcomes(seeds[0]), b.outcomes(seeds[0])
    known = [
        episode
        for episode in of_a
        if episode in of_b
        and number(of_a[episode], "success") is not None
        and number(of_b[episode], "success") is not None
    ]
    if not known:
        return
    table = mcnemar(*(_flags(rows, known) for rows in (of_a, of_b)))
    yield Comparison(
        a=names[0],
        b=names[1],
        family=family,
        episodes=len(known),
        seed=seeds[0],
        success=table,
        spl=_paired(a, b, "spl"),
        ne_m=_paired(a, b, "ne_m"),
        holm={},
        words=resolution(table.both + table.only_a, table.both + table.only_b, n=len(known)).words,
    )


def _flags(rows: Mapping[str, Row], episodes: Sequence[str]) -> list[bool]:
    return [number(rows[episode], "success") == 1.0 for episode in episodes]


def _paired(a: Arm, b: Arm, column: str) -> PairedDifference | None:
    """Means over the seeds that both ran, episode by episode."""
    shared = set(a.seeds) & set(b.seeds)
    of_a, of_b = (_means(arm, column, shared) for arm in (a, b))
    episodes = [episode for episode in of_a if episode in of_b]
    if not episodes:
        return None
    values = [[of[episode] for episode in episodes] for of in (of_a, of_b)]
    return paired_difference(values[0], values[1], seed=SEED)


def _means(arm: Arm, column: str, seeds: set[int]) -> dict[str, float]:
    groups: dict[str, list[float]] = {}
    for row in arm.rows:
        value = number(row, column)
        if value is not None and int(row["seed"] or 0) in seeds:
            groups.setdefault(str(row["episode_id"]), []).append(value)
    return {episode: fmean(values) for episode, values in groups.items()}


def _adjusted(made: Sequence[Comparison]) -> tuple[Comparison, ...]:
    """Holm within each family and figure; arms are distinct by config, so each counts once."""
    families: dict[str, list[Comparison]] = {}
    for each in made:
        families.setdefault(each.family, []).append(each)
    return tuple(each for members in families.values() for each in _with_holm(members))


def _with_holm(members: Sequence[Comparison]) -> Iterator[Comparison]:
    raised: dict[str, dict[str, float]] = {}
    for name in ("sr", "spl", "ne_m"):
        p_values = {m.pair: m.p_values()[name] for m in members if name in m.p_values()}
        for pair, p in holm(p_values).items():
            raised.setdefault(pair, {})[name] = p
    for each in members:
        yield replace(each, holm=raised[each.pair])
