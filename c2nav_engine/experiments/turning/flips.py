"""(c) One answer away: the same ranker goes on after a changed answer, beside a control."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import cast

from c2nav_engine.contract.outcome import Abstention, Answered, Key, Ordering
from c2nav_engine.contract.question import Form, Slot
from c2nav_engine.experiments.turning.moments import Recording, going_on
from c2nav_engine.experiments.turning.regrets import Regret
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.episode_run import EpisodeRun
from c2nav_engine.runner.exchange import Exchange, Override
from c2nav_engine.runner.opening import SeatFor

UNDECIDED = "undecided"
"""The third answer of terminal evidence: neither for nor against."""
TERMINAL = frozenset({Slot.GROUND, Slot.JOURNEY, Slot.LOOKBACK})

TURNING = "one answer away"
UNSTABLE = "unstable"
NO_SUCCESS = "no success"

WHO = "turning points"
"""Whom the record of a changed answer names."""


@dataclass(frozen=True, slots=True)
class Trial:
    """One other answer that is worth trying.

    Attributes:
        exchange: The decision as it was recorded.
        slot: Decision slot.
        answer: A key, or "undecided".
        outcome: What is committed for it.
    """

    exchange: Exchange
    slot: Slot
    answer: str
    outcome: Answered

    @property
    def decision(self) -> int:
        """Number."""
        return cast("int", self.exchange.decision)


@dataclass(frozen=True, slots=True)
class Flip:
    """One changed answer, run as often as its unchanged control.

    Attributes:
        decision: Number.
        slot: Decision slot.
        answer: What was committed instead: a key, or "undecided".
        changed: Successes with the change.
        control: Successes of the unchanged decision, run on by the same ranker.
        repeats: Runs of each.
        queries: Queries that the changed runs took, and the control's with a decision's first.
    """

    decision: int
    slot: Slot
    answer: str
    changed: int
    control: int
    repeats: int
    queries: int

    @property
    def verdict(self) -> str:
        """A turning point only where every change and no control succeeded."""
        if self.control > 0 or 0 < self.changed < self.repeats:
            return UNSTABLE
        return TURNING if self.changed else NO_SUCCESS


@dataclass(frozen=True, slots=True)
class Budget:
    """How much may be asked.

    Attributes:
        repeats: Runs of each changed and unchanged decision.
        max_queries: Queries after which nothing new is tried; None for no limit.
    """

    repeats: int = 3
    max_queries: int | None = None

    def spent(self, queries: int) -> bool:
        """Whether nothing new may be tried."""
        return self.max_queries is not None and queries >= self.max_queries


def other_answers(exchange: Exchange) -> list[tuple[str, Answered]]:
    """Each other feasible answer: another winner, stay or next; for, against or undecided."""
    request = exchange.request
    if not isinstance(request, Ask) or request.question.form not in {Form.ORDINAL, Form.ACTION}:
        return []
    keys = request.question.keys
    committed: Key = exchange.response.winner if isinstance(exchange.response, Ordering) else ""
    found: list[tuple[str, Answered]] = [
        (key, Ordering.winner_only(key, keys)) for key in keys if key != committed
    ]
    if request.question.slot in TERMINAL and committed:
        found.append((UNDECIDED, Abstention(UNDECIDED)))
    return found


def trials_of(recording: Recording, regrets: Sequence[Regret], *, suspects: int) -> list[Trial]:
    """Every other answer of the worst decisions by regret, worst decision first.

    Args:
        recording: The failed episode.
        regrets: All of its decisions (`regrets_of`).
        suspects: How many decisions to change.
    """
    by_number = {exchange.decision: exchange for exchange in recording.questions}
    worst = sorted(regrets, key=lambda regret: regret.weight)[:suspects]
    return [
        Trial(by_number[regret.decision], regret.slot, answer, outcome)
        for regret in worst
        for answer, outcome in other_answers(by_number[regret.decision])
    ]


def expected_queries(recording: Recording, trials: Sequence[Trial], *, repeats: int) -> int:
    """What trying them is expected to ask: each run as many queries as the recording then took."""
    return sum(
        repeats * _queries_after(recording, decision) * (1 + len(list(group)))
        for decision, group in groupby(trials, key=lambda trial: trial.decision)
    )


def _queries_after(recording: Recording, decision: int) -> int:
    after = (e for e in recording.questions if (e.decision or 0) > decision)
    return sum(len(e.ranked.queries) for e in after if e.ranked)


class _Stopped(Exception):
    """Somebody cancelled; a run was left before its end."""


def flips_of(
    recording: Recording,
    trials: Sequence[Trial],
    seat_for: SeatFor,
    *,
    budget: Budget,
    stopped: Callable[[], bool] = lambda: False,
) -> Iterator[Flip]:
    """Run trials and their controls, one flip a step; nothing is lost by leaving early.

    Args:
        recording: The failed episode.
        trials: What to change, those of one decision together: they share its control.
        seat_for: The ranker that made the recording, going on.
        budget: Repeats and most queries.
        stopped: Looked at between any two requests; once true, no further flip comes.

    Raises:
        RankerError: The ranker cannot go on.
    """
    spent = 0
    runner = _Runner(recording, seat_for, budget.repeats, stopped)
    for _, group in groupby(trials, key=lambda trial: trial.decision):
        if budget.spent(spent):
            return
        control: tuple[int, int] | None = None
        for trial in group:
            if control is not None and budget.spent(spent):
                return
            try:
                asked = 0
                if control is None:
                    control = runner.successes(trial, cast("Answered", trial.exchange.response))
                    asked = control[1]
                changed, queries = runner.successes(trial, trial.outcome)
            except _Stopped:
                return
            spent += asked + queries
            yield Flip(
                decision=trial.decision,
                slot=trial.slot,
                answer=trial.answer,
                changed=changed,
                control=control[0],
                repeats=budget.repeats,
                queries=asked + queries,
            )


@dataclass(frozen=True, slots=True)
class _Runner:
    """Goes on from decisions of one recording."""

    recording: Recording
    seat_for: SeatFor
    repeats: int
    stopped: Callable[[], bool]

    def successes(self, trial: Trial, outcome: Answered) -> tuple[int, int]:
        """(successes, queries) with an outcome committed at a decision."""
        successes = queries = 0
        for _ in range(self.repeats):
            override = Override(outcome, WHO)
            run = going_on(self.recording, trial.decision, self.seat_for, override=override)
            successes += self._succeeds(run)
            after = run.exchanges[trial.exchange.index :]
            queries += sum(len(e.ranked.queries) for e in after if e.ranked)
        return successes, queries

    def _succeeds(self, run: EpisodeRun) -> bool:
        while run.footer is None:
            if self.stopped():
                run.close()
                raise _Stopped
            run.advance()
        return run.footer.metrics.get("success") == 1
