"""Every decision of a recorded episode as a place to go on from.

The episode is run through its scene once, answered from the record; at each question the shell is
copied. Going on from decision k then costs only what follows it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from c2nav_engine.errors import InputError
from c2nav_engine.navigator.loop import navigate
from c2nav_engine.navigator.requests import Ask, Look, Move
from c2nav_engine.runner.episode_run import EpisodeRun, Parts
from c2nav_engine.runner.exchange import Exchange, Override
from c2nav_engine.runner.opening import (
    SeatFor,
    Stage,
    goal_field_of,
    noise_of,
    sensors_of,
    start_on,
    task_of,
)
from c2nav_engine.runner.record import Footer, Header
from c2nav_engine.runner.recorded import Trace
from c2nav_engine.runner.reshell import source_of_record
from c2nav_engine.runner.scoring import metrics_of
from c2nav_engine.runner.shell import LiveShell
from c2nav_engine.runner.worlds import World, Worlds, WorldsConfig
from c2nav_engine.world.surface import DistanceField


@dataclass(frozen=True, slots=True)
class Recording:
    """A recorded episode with its scene, ready to be gone on from.

    Attributes:
        header: Of the trace.
        exchanges: All of them.
        footer: How it ended.
        trace_sha256: Digest of the trace.
        world: The scene with its floor.
        field: Distances to the goal.
        shells: Decision number → the shell as it stood at its question.
    """

    header: Header
    exchanges: tuple[Exchange, ...]
    footer: Footer
    trace_sha256: str
    world: World
    field: DistanceField
    shells: Mapping[int, LiveShell]

    @property
    def questions(self) -> tuple[Exchange, ...]:
        """Decisions that put a question, in order."""
        return tuple(e for e in self.exchanges if isinstance(e.request, Ask))

    @property
    def succeeded(self) -> bool:
        """Whether the recorded episode was a success."""
        return self.footer.metrics.get("success") == 1


def recording_of(trace: Trace, *, scenes: Path | None) -> Recording:
    """A trace as a recording, its scene loaded; raises as `recording_in`, and `SceneError`."""
    header = trace.header
    worlds = Worlds(source_of_record(header, scenes), WorldsConfig(header.profile))
    return recording_in(
        worlds.of(header.episode.scene_id),
        header,
        trace.exchanges,
        footer=trace.footer,
        trace_sha256=trace.sha256,
    )


def recording_in(
    world: World,
    header: Header,
    exchanges: Sequence[Exchange],
    *,
    footer: Footer,
    trace_sha256: str = "",
) -> Recording:
    """Run an episode's body through its scene again, keeping the shell at every question.

    Args:
        world: The episode's scene; used by this recording alone while it is gone on from.
        header: Of the episode.
        exchanges: All of them.
        footer: How it ended.
        trace_sha256: Digest of its trace; "" where none was written.

    Raises:
        InputError: The episode has no goal on the floor, so nothing can be said about it.
    """
    field = goal_field_of(world, header.episode)
    if field is None:
        message = (
            f"episode {header.episode.episode_id}: expected a goal on the walkable surface, came "
            f"{header.episode.goal_m}; turning points need one"
        )
        raise InputError(message)
    return Recording(
        header=header,
        exchanges=tuple(exchanges),
        footer=footer,
        trace_sha256=trace_sha256,
        world=world,
        field=field,
        shells=_shells(exchanges, _fresh_shell(header, world, field)),
    )


def _fresh_shell(header: Header, world: World, field: DistanceField) -> LiveShell:
    return LiveShell(
        start=start_on(world, header.episode),
        surface=world.surface,
        renderer=world.renderer,
        profile=header.profile,
        goal_distance=field.distance_m,
        sensors=sensors_of(
            noise_of(header), seed=header.seed, episode_id=header.episode.episode_id
        ),
    )


def _shells(exchanges: Sequence[Exchange], shell: LiveShell) -> dict[int, LiveShell]:
    kept: dict[int, LiveShell] = {}
    for exchange in exchanges:
        if isinstance(exchange.request, Look):
            shell.look(exchange.request)
        elif isinstance(exchange.request, Move):
            shell.move(exchange.request)
        elif isinstance(exchange.request, Ask) and exchange.decision is not None:
            kept[exchange.decision] = shell.copy()
    return kept


def going_on(
    recording: Recording, decision: int, seat_for: SeatFor, *, override: Override | None = None
) -> EpisodeRun:
    """The episode from a decision on: recorded answers before it, the seat's ranker after it.

    Args:
        recording: The parent.
        decision: Where to go on; its own question is open again.
        seat_for: Who answers from there.
        override: Committed at the decision itself; None lets the ranker answer it.
    """
    header = replace(recording.header, parent_sha256=recording.trace_sha256, fork_decision=decision)
    seat = seat_for(_stage(recording))
    episode = header.episode
    run = EpisodeRun(
        Parts(
            header=header,
            loop=navigate(task_of(header)),
            shell=recording.shells[decision].copy(),
            ranker=seat.ranker,
            score=partial(
                metrics_of,
                episode=episode,
                shortest_m=recording.field.distance_m(episode.start.position_m),
                ground_truth_m=episode.reference_path_m,
            ),
            before_ask=seat.before_ask,
        )
    )
    for exchange in recording.exchanges:
        if exchange.decision == decision:
            break
        run.resume(exchange)
    if override is not None:
        run.commit(override)
    return run


def _stage(recording: Recording) -> Stage:
    header = recording.header
    return Stage(
        episode=header.episode,
        world=recording.world,
        start=header.episode.start,
        field=recording.field,
        profile=header.profile,
        legs=header.legs,
        config=task_of(header).config,
        seed=header.seed,
    )
