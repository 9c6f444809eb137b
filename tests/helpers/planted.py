"""Episodes with planted wrong answers: a noiseless observer that errs where it was told to.

The step budget is exactly what the flawless episode takes, so that a detour cannot be made up for.
"""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path

from c2nav_engine.contract.outcome import Key, Ordering
from c2nav_engine.contract.prompt import Ranked
from c2nav_engine.contract.question import Question, Slot
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.experiments.rankers import seats_for
from c2nav_engine.experiments.simulated_seat import course_at
from c2nav_engine.experiments.truth import Course, course_of, goal_after_m
from c2nav_engine.experiments.turning.moments import Recording, recording_in
from c2nav_engine.experiments.turning.recoverable import NOISELESS
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.rankers.protocol import Ranker
from c2nav_engine.runner.episode_run import run_to_end
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.opening import OpenSpec, Seat, SeatFor, Stage, Workbench, task_of
from c2nav_engine.runner.recording import TraceWriter
from c2nav_engine.runner.source import open_source
from c2nav_engine.runner.worlds import Worlds, WorldsConfig

SHORT = "9"
"""A short built-in episode that two mistakes spoil and no one answer saves.

Where the built-in hundred is made anew and it does not any more, `twice_spoilt_episodes` tells of
others.
"""

NOISELESS_SEATS = seats_for("simulated", NOISELESS)

Wrong = Mapping[int, int]
"""Number of an election of the episode, from 0 → which view is elected there, from the worst, 0.

Not by name: another way through the episode brings other views to that election, and a detour
around one mistake is not to turn the next one into the right answer.
"""


def erring_seats(*habits: Wrong) -> SeatFor:
    """Seats that err by the first habit when first made, by the next when made again, in turn."""
    made = Counter[str]()

    def seat_for(stage: Stage) -> Seat:
        wrong = habits[made[stage.episode.episode_id] % len(habits)]
        made[stage.episode.episode_id] += 1
        seat = NOISELESS_SEATS(stage)
        assert seat.ranker is not None
        erring = _Erring(stage, seat, seat.ranker, wrong)
        return replace(seat, ranker=erring, before_ask=erring.before_ask)

    return seat_for


class _Erring:
    """Answers as the ranker of a seat does, but for some elections."""

    def __init__(self, stage: Stage, seat: Seat, ranker: Ranker, wrong: Wrong) -> None:
        self._stage, self._seat, self._ranker, self._wrong = stage, seat, ranker, wrong
        self._worst_first: list[Key] = []

    @property
    def name(self) -> str:
        return self._ranker.name

    def before_ask(self, ask: Ask, exchanges: Sequence[Exchange]) -> None:
        assert self._seat.before_ask is not None
        self._seat.before_ask(ask, exchanges)
        place = self._wrong.get(len(_elections(exchanges)))
        self._worst_first = []
        if ask.question.slot is Slot.SEEING and place is not None:
            poses = [pose for each in exchanges if each.truth for pose in each.truth.poses]
            offered = [c for c in ask.facts.candidates if c.key in ask.question.keys]
            pose = poses[-1] if poses else self._stage.start
            after_m = goal_after_m(course_at(self._stage), pose, offered)
            # Whatever is offered here, what is elected stays wrong.
            place = min(place, max(len(offered) - 2, 0))
            self._worst_first = sorted(after_m, key=lambda key: -after_m[key])[place:]

    def rank(self, question: Question) -> Ranked:
        ranked = self._ranker.rank(question)
        if not self._worst_first:
            return ranked
        wrong = Ordering.winner_only(self._worst_first[0], question.keys)
        return replace(ranked, outcome=wrong)


def _elections(exchanges: Sequence[Exchange]) -> list[Exchange]:
    asked = [e for e in exchanges if isinstance(e.request, Ask)]
    return [e for e in asked if _ask(e).question.slot is Slot.SEEING]


def _ask(exchange: Exchange) -> Ask:
    assert isinstance(exchange.request, Ask)
    return exchange.request


# ---------------------------------------------------------------- episodes


@functools.cache
def _worlds() -> Worlds:
    return Worlds(open_source("builtin"), WorldsConfig(VLNCE))


def run_through(
    episode_id: str, seat_for: SeatFor, *, max_steps: int = 500, trace: Path | None = None
) -> Recording:
    """An episode run to its end, ready to be gone on from."""
    worlds = _worlds()
    bench = Workbench(
        source=open_source("builtin"),
        worlds=worlds,
        profile=replace(VLNCE, max_steps=max_steps),
        seat_for=seat_for,
        recorder_for=TraceWriter,
    )
    run = bench.open(OpenSpec(episode_id, trace=trace))
    footer = run_to_end(run)
    world = worlds.of(run.header.episode.scene_id)
    return recording_in(
        world, run.header, run.exchanges, footer=footer, trace_sha256=run.trace_sha256
    )


@dataclass(frozen=True)
class Mistake:
    """The wrong answer that can be planted at an election, and one less wrong.

    Attributes:
        election: Its number in the episode, from 0.
        views: How many views it orders.
        cost_m: What the worst of them costs.
        place: Which is elected, from the worst.
    """

    election: int
    views: int
    cost_m: float
    place: int = 0

    def milder(self) -> Iterator[Mistake]:
        """The other wrong answers at the same election."""
        return (replace(self, place=place) for place in range(1, self.views - 1))


def habit(*mistakes: Mistake) -> Wrong:
    """Who makes these mistakes, as what they elect."""
    return {mistake.election: mistake.place for mistake in mistakes}


@dataclass(frozen=True)
class Flawless:
    """An episode without a mistake, with the mistakes that could be planted, costliest first."""

    episode_id: str
    steps: int
    mistakes: tuple[Mistake, ...]

    def with_mistakes(
        self, *planted: Mistake, seat_for: SeatFor | None = None, trace: Path | None = None
    ) -> Recording:
        """The episode with mistakes in it, and not a step to spare."""
        seats = seat_for or erring_seats(habit(*planted))
        return run_through(self.episode_id, seats, max_steps=self.steps, trace=trace)


def flawless(episode_id: str) -> Flawless:
    """Run an episode without a mistake; raises AssertionError where even that fails."""
    found = _flawless(episode_id)
    assert found is not None, f"the noiseless observer fails in episode {episode_id}"
    return found


@functools.cache
def _flawless(episode_id: str) -> Flawless | None:
    recording = run_through(episode_id, NOISELESS_SEATS)
    if not recording.succeeded:
        return None
    course = _course(recording)
    mistakes = [
        _costliest(recording, course, number, exchange)
        for number, exchange in enumerate(_elections(recording.exchanges))
    ]
    mistakes.sort(key=lambda mistake: -mistake.cost_m)
    steps = int(recording.footer.metrics["steps"] or 0)
    return Flawless(episode_id, steps, tuple(mistakes))


TwoNeeds = tuple[tuple[Mistake, Mistake], Recording]
"""Two mistakes, and the episode with both made in it."""


def decision_of(recording: Recording, mistake: Mistake) -> int:
    """The decision that an election is."""
    decision = _elections(recording.exchanges)[mistake.election].decision
    assert decision is not None
    return decision


def spoilt_episodes() -> Iterator[tuple[Flawless, Recording, int]]:
    """Built-in episodes in their order that their costliest single mistake makes fail.

    Some mistakes cost no more than a way that is as short, and some episodes fail without one:
    there is nothing planted to explain.
    """
    for episode in open_source("builtin").file.episodes:
        whole = _flawless(episode.episode_id)
        if whole is None:
            continue
        recording = whole.with_mistakes(whole.mistakes[0])
        if not recording.succeeded:
            yield whole, recording, decision_of(recording, whole.mistakes[0])


def twice_spoilt_episodes() -> Iterator[tuple[Flawless, TwoNeeds]]:
    """Those of them that no one answer saves once two mistakes are made."""
    for whole, _, _ in spoilt_episodes():
        found = two_needs(whole)
        if found is not None:
            yield whole, found


def two_needs(whole: Flawless) -> TwoNeeds | None:
    """The costliest two mistakes that no other answer at one of them makes up for."""
    for first, second in combinations(whole.mistakes, 2):
        both = whole.with_mistakes(first, second)
        made = len(_elections(both.exchanges)) > max(first.election, second.election)
        if made and not both.succeeded and not _saved(whole, first, second):
            return (first, second), both
    return None


def _saved(whole: Flawless, first: Mistake, second: Mistake) -> bool:
    """Whether the right answer, or a less wrong one, in the place of either is enough."""
    instead = [(first,), (second,)]
    instead += [(other, second) for other in first.milder()]
    instead += [(first, other) for other in second.milder()]
    return any(whole.with_mistakes(*planted).succeeded for planted in instead)


def _course(recording: Recording) -> Course:
    header = recording.header
    return course_of(
        header.episode,
        start=header.episode.start,
        surface=recording.world.surface,
        field=recording.field,
        profile=header.profile,
        controller=task_of(header).config.controller,
    )


def _costliest(recording: Recording, course: Course, number: int, exchange: Exchange) -> Mistake:
    assert exchange.decision is not None
    offered = [c for c in _ask(exchange).facts.candidates if c.feasible]
    after_m = goal_after_m(course, recording.shells[exchange.decision].pose, offered)
    return Mistake(number, len(after_m), max(after_m.values()) - min(after_m.values()))
