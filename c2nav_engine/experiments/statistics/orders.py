"""Order effects: does the answer depend on where an alternative stood?"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from statistics import fmean

from c2nav_engine.contract.outcome import Key
from c2nav_engine.experiments.statistics.clusters import cluster_mean_interval
from c2nav_engine.experiments.statistics.intervals import Interval, wilson


@dataclass(frozen=True, slots=True)
class Shown:
    """One answer to one presentation.

    Attributes:
        episode: Which episode it belongs to (the unit that is resampled).
        decision: Which decision, unique over all episodes.
        order: Keys as they were shown, first to last.
        winner: The elected key; None when the answer elected none.
    """

    episode: Hashable
    decision: Hashable
    order: tuple[Key, ...]
    winner: Key | None


def position_consistency(shown: Sequence[Shown]) -> Interval:
    """Share of decisions, among those shown in two or more orders, whose winner never changes."""
    groups = _grouped(shown, lambda one: one.decision)
    asked = [group for group in groups if len({one.order for one in group}) >= 2]
    return wilson(sum(_unanimous(group) for group in asked), len(asked))


def repetition_stability(shown: Sequence[Shown]) -> Interval:
    """Share of presentations, among those asked twice or more as they were, answered alike."""
    groups = _grouped(shown, lambda one: (one.decision, one.order))
    repeated = [group for group in groups if len(group) >= 2]
    return wilson(sum(_unanimous(group) for group in repeated), len(repeated))


def first_excess(shown: Sequence[Shown], *, seed: int) -> Interval | None:
    """How much more often than 1/m the alternative shown first wins; bootstrap over episodes."""
    return _excess(shown, place=0, seed=seed)


def last_excess(shown: Sequence[Shown], *, seed: int) -> Interval | None:
    """The same for the alternative shown last."""
    return _excess(shown, place=-1, seed=seed)


def chance_of_winning(shown: Sequence[Shown]) -> float | None:
    """Mean 1/m over answers that elected something: the line the excesses are measured from."""
    answered = [one for one in shown if one.winner is not None]
    return fmean(1.0 / len(one.order) for one in answered) if answered else None


def _excess(shown: Sequence[Shown], *, place: int, seed: int) -> Interval | None:
    answered = [one for one in shown if one.winner is not None]
    clusters = [
        [float(one.winner == one.order[place]) - 1.0 / len(one.order) for one in group]
        for group in _grouped(answered, lambda one: one.episode)
    ]
    return cluster_mean_interval(clusters, seed=seed)


def _grouped(shown: Sequence[Shown], name: Callable[[Shown], Hashable]) -> list[list[Shown]]:
    groups: dict[Hashable, list[Shown]] = {}
    for one in shown:
        groups.setdefault(name(one), []).append(one)
    return list(groups.values())


def _unanimous(group: Sequence[Shown]) -> bool:
    winners = {one.winner for one in group}
    return len(winners) == 1 and None not in winners
