"""People and models held against the geodesically best alternative; privileged.

It stands apart from agreement: nobody who judges is told it, and it is worked out only when nobody
judges any more.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean

from app.reviews.agreement import ALL, standing
from app.reviews.answers import Answer, Answers, Rater
from app.reviews.desk import Desk
from app.reviews.study import read_study, study_names
from c2nav_engine.contract.outcome import Key
from c2nav_engine.experiments.statistics.clusters import cluster_mean_interval
from c2nav_engine.experiments.statistics.intervals import Interval


@dataclass(frozen=True, slots=True)
class Judging:
    """How far the studies of some runs are.

    Attributes:
        answered: Places that are answered.
        places: Places in all queues.
    """

    answered: int
    places: int

    @property
    def complete(self) -> bool:
        """Whether nobody is judging any more."""
        return self.answered == self.places


def judging_of(runs: Sequence[Path]) -> Judging:
    """Progress of every study of these runs."""
    answered = places = 0
    for run in runs:
        for name in study_names(run):
            desk = Desk(read_study(run, name))
            try:
                progress = desk.progress().values()
            finally:
                desk.close()
            answered += sum(done for done, _ in progress)
            places += sum(total for _, total in progress)
    return Judging(answered, places)


@dataclass(frozen=True, slots=True)
class BestElected:
    """How often one rater elects the geodesically best alternative, on one slot or on all.

    Attributes:
        rater: Who.
        slot: Decision slot, or "all".
        share: Of answers that elected one; interval over episodes.
        chance: Mean 1/m over offered alternatives.
    """

    rater: Rater
    slot: str
    share: Interval
    chance: float


def best_elected(answers: Answers, best: Mapping[str, Key], *, seed: int = 0) -> list[BestElected]:
    """Every rater over all slots and slot by slot.

    Args:
        answers: What was answered.
        best: Question → the offered alternative whose bundle ends nearest to the goal; questions
            that are not there do not count.
        seed: Of the bootstrap over episodes.
    """
    found: dict[tuple[Rater, str], list[Answer]] = {}
    for answer in answers.given:
        if answer.question in best and answer.winner is not None:
            for slot in (ALL, answer.slot):
                found.setdefault((answer.rater, slot), []).append(answer)
    return [
        BestElected(
            rater,
            slot,
            share=_share(mine, best, seed=seed),
            chance=fmean(1.0 / len(answer.keys) for answer in mine),
        )
        for (rater, slot), mine in sorted(
            found.items(), key=lambda one: (standing(one[0][0]), one[0][1])
        )
    ]


def _share(mine: Sequence[Answer], best: Mapping[str, Key], *, seed: int) -> Interval:
    clusters: dict[str, list[float]] = {}
    for answer in mine:
        hit = float(answer.winner == best[answer.question])
        clusters.setdefault(answer.episode, []).append(hit)
    share = cluster_mean_interval(list(clusters.values()), seed=seed)
    assert share is not None, "a row has at least one answer"
    return share
