"""(a) What every committed answer cost, from one distance field and without a query."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from c2nav_engine.contract.outcome import Key, Ordering
from c2nav_engine.contract.question import Slot
from c2nav_engine.experiments.regret import controller_fault, regret_m
from c2nav_engine.experiments.truth import EpisodeTruth, course_of, goal_after_m
from c2nav_engine.experiments.turning.moments import Recording
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.opening import task_of

WRONG = "wrong"
"""What is said of an answer that differs from the right one."""
WRONG_M = 1.0
"""Weight of a wrong answer without metres: more than most bundles can lose [C]."""
SPATIAL = frozenset({Slot.SEEING, Slot.DIRECT})
"""Slots whose alternatives end at different places, so that regret is metres."""


@dataclass(frozen=True, slots=True)
class Regret:
    """One decision against what was offered.

    Attributes:
        decision: Number.
        slot: Decision slot.
        committed: Elected key; "" for an answer that elected nothing.
        target: Right answer by the truth; "" where no answer is right.
        regret_m: Goal distance after the committed bundle less after the best offered one; None
            for slots that do not move.
        words: "controller: nothing good offered", "vetoed", "wrong", or "".
    """

    decision: int
    slot: Slot
    committed: Key
    target: Key
    regret_m: float | None
    words: str

    @property
    def weight(self) -> tuple[float, int]:
        """Sorting key, worst first, then latest; a wrong answer that moves nothing counts 1 m."""
        if self.regret_m is not None:
            return (-self.regret_m, -self.decision)
        return (-WRONG_M if self.words == WRONG else 0.0, -self.decision)


def regrets_of(recording: Recording) -> list[Regret]:
    """Every question of the episode, in order."""
    config = task_of(recording.header).config
    episode = recording.header.episode
    course = course_of(
        episode,
        start=episode.start,
        surface=recording.world.surface,
        field=recording.field,
        profile=recording.header.profile,
        controller=config.controller,
    )
    truth = EpisodeTruth(course, episode.start)
    found: list[Regret] = []
    for exchange in recording.questions:
        ask = exchange.request
        if not isinstance(ask, Ask) or exchange.decision is None:
            continue
        truth.before_ask(ask, recording.exchanges[: exchange.index])
        target = truth.of(ask.question).target or ""
        shell = recording.shells[exchange.decision]
        after_m = goal_after_m(course, shell.pose, ask.facts.candidates)
        here_m = recording.field.distance_m(shell.pose.position_m)
        found.append(_regret(exchange, ask, (target, here_m), after_m))
    return found


def _regret(
    exchange: Exchange, ask: Ask, truth: tuple[Key, float], after_m: Mapping[Key, float]
) -> Regret:
    target, here_m = truth
    committed = exchange.response.winner if isinstance(exchange.response, Ordering) else ""
    slot = ask.question.slot
    metres: float | None = None
    words = WRONG if target and committed and committed != target else ""
    if slot in SPATIAL:
        offered = {c.key: after_m[c.key] for c in ask.facts.candidates if c.feasible}
        vetoed = {c.key: after_m[c.key] for c in ask.facts.candidates if not c.feasible}
        metres = regret_m(offered, committed) if committed in offered else None
        words = controller_fault(offered, vetoed, here_m=here_m) or words
    return Regret(exchange.decision or 0, slot, committed, target, metres, words)
