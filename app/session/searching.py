"""The work behind the turning points of one branch: all that needs its scene, and no desk."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from app.session.branches import Branch
from c2nav_engine.experiments.turning.flips import (
    Budget,
    Flip,
    Trial,
    expected_queries,
    flips_of,
    trials_of,
)
from c2nav_engine.experiments.turning.moments import Recording, recording_in
from c2nav_engine.experiments.turning.recoverable import Recoverable, last_recoverable
from c2nav_engine.experiments.turning.regrets import Regret, regrets_of
from c2nav_engine.experiments.turning.same_ranker import Continuing
from c2nav_engine.runner.record import Footer
from c2nav_engine.runner.worlds import World

SUSPECTS = 5
"""Decisions whose answers are changed, worst first [C]."""
BUDGET = Budget(repeats=3)

Tried = tuple[int, str]
"""A decision and the answer that was committed there instead."""


@dataclass
class Search:
    """One failed branch in its scene.

    Attributes:
        recording: The branch.
        regrets: (a), worst first.
        recoverable: (b).
        trials: Every answer that (c) is to try.
        on: Who goes on.
        budget: How often each answer and its control are run.
        flips: The search that runs; None before the first.
        cancelled: Set to leave it; looked at between any two requests.
    """

    recording: Recording
    regrets: Sequence[Regret]
    recoverable: Recoverable
    trials: Sequence[Trial]
    on: Continuing
    budget: Budget
    flips: Iterator[Flip] | None = None
    cancelled: threading.Event = field(default_factory=threading.Event)

    def start(self, left: Sequence[Tried]) -> None:
        """Begin to try some of the answers."""
        self.cancelled = threading.Event()
        self.flips = flips_of(
            self.recording,
            self._trials(left),
            self.on.seat_for,
            budget=self.budget,
            stopped=self.cancelled.is_set,
        )

    def queries(self, left: Sequence[Tried]) -> int:
        """How many queries some of the answers are expected to take."""
        return expected_queries(self.recording, self._trials(left), repeats=self.budget.repeats)

    def trial(self, place: Tried) -> Trial | None:
        """One of the answers."""
        return next(iter(self._trials([place])), None)

    def _trials(self, wanted: Sequence[Tried]) -> list[Trial]:
        return [trial for trial in self.trials if (trial.decision, trial.answer) in wanted]


def search_of(branch: Branch, footer: Footer, world: World, on: Continuing) -> Search:
    """Measure (a) and (b) of a branch; takes as long as running it several times over.

    Raises:
        InputError: The episode has no goal on the floor.
    """
    recording = recording_in(
        world,
        branch.header,
        branch.exchanges,
        footer=footer,
        trace_sha256=branch.trace_sha256,
    )
    regrets = sorted(regrets_of(recording), key=lambda regret: regret.weight)
    trials = trials_of(recording, regrets, suspects=SUSPECTS)
    return Search(recording, regrets, last_recoverable(recording), trials, on, BUDGET)
