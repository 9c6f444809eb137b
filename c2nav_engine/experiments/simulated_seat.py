"""The simulated observer's place at an episode: the one joint between truth and answers."""

from __future__ import annotations

from collections.abc import Mapping

from c2nav_engine.experiments.simulated import NAME, SimulatedObserver
from c2nav_engine.experiments.simulated_options import SimulatedOptions
from c2nav_engine.experiments.truth import Course, EpisodeTruth, course_of
from c2nav_engine.rankers.accounting import AskingConfig
from c2nav_engine.rankers.wrapper import AskingRanker
from c2nav_engine.runner.opening import Seat, Stage

# It answers in microseconds: threads would only cost.
_ASKING = AskingConfig(concurrency=1)


def simulated_seat(stage: Stage, options: Mapping[str, str]) -> Seat:
    """A privileged observer of this episode; raises `UsageError` for wrong options or no goal."""
    kind = SimulatedOptions.from_options(options)
    course = course_at(stage)
    truth = EpisodeTruth(course, stage.start)
    observer = SimulatedObserver(
        kind, truth=truth, seed=stage.seed, episode_id=stage.episode.episode_id
    )
    return Seat(
        ranker=AskingRanker(observer, _ASKING, privileged=True),
        name=NAME,
        options=kind.as_options(),
        privileged=True,
        before_ask=truth.before_ask,
    )


def course_at(stage: Stage) -> Course:
    """What is true of a stage's episode from start to end; raises `UsageError` without a goal."""
    return course_of(
        stage.episode,
        start=stage.start,
        surface=stage.world.surface,
        field=stage.field,
        profile=stage.profile,
        controller=stage.config.controller,
    )
