"""Opening an episode: everything that an `EpisodeRun` is put together from."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np

from c2nav_engine.contract import template
from c2nav_engine.contract.route import RouteLadder, parse_english
from c2nav_engine.controller.odometer import planar_m
from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.profile import Profile
from c2nav_engine.errors import StartError, UsageError
from c2nav_engine.geometry import Point, Pose
from c2nav_engine.navigator.config import LoopConfig
from c2nav_engine.navigator.loop import navigate
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.navigator.state import Task
from c2nav_engine.navigator.variants import preset
from c2nav_engine.rankers.protocol import Ranker
from c2nav_engine.rankers.random_order import RandomOrder
from c2nav_engine.rankers.wrapper import AskingRanker
from c2nav_engine.runner.episode_run import BeforeAsk, EpisodeRun, Parts, Recorder
from c2nav_engine.runner.exchange import Exchange, Override
from c2nav_engine.runner.record import Header
from c2nav_engine.runner.scoring import metrics_of
from c2nav_engine.runner.shell import LiveShell, Sensors
from c2nav_engine.runner.source import Source
from c2nav_engine.runner.worlds import World, Worlds
from c2nav_engine.sensing.noise import NoiseConfig, NoisySensors
from c2nav_engine.world.surface import DistanceField

RELIABLE = NoiseConfig()
"""Sensing as the paper assumes it."""

OFF_SURFACE_M = 0.5
"""A start farther than this from the floor, across or in height, is an error [C]."""


@dataclass(frozen=True, slots=True)
class Seat:
    """Whoever answers the questions of one episode.

    Attributes:
        ranker: Answers; None when only a person does.
        name: What records call it.
        options: Options for the record; never a key.
        privileged: Whether it knows the truth.
        before_ask: Told about every question first (privileged observers).
    """

    ranker: Ranker | None
    name: str
    options: Mapping[str, str] = field(default_factory=dict[str, str])
    privileged: bool = False
    before_ask: BeforeAsk | None = None


@dataclass(frozen=True, slots=True)
class Stage:
    """What a ranker may be told about one episode before it starts.

    Only privileged observers look at anything but the seed.
    """

    episode: Episode
    world: World
    start: Pose
    field: DistanceField | None
    profile: Profile
    legs: tuple[str, ...]
    config: LoopConfig
    seed: int


SeatFor = Callable[[Stage], Seat]
"""Makes the seat of one episode; shared services (a client, a model) live in its closure."""

Parse = Callable[[str], RouteLadder]
"""Instruction → route ladder, once per episode."""

RecorderFor = Callable[[Path, Header], Recorder]
"""Opens a trace file."""


@dataclass(frozen=True, slots=True)
class OpenSpec:
    """Which episode to open, and how.

    Attributes:
        episode_id: Id in the source.
        variant: Preset name.
        seed: Run seed.
        run: Run name for the record.
        trace: Where to record; None records nothing.
        config: A config in place of the preset's own.
        parent_sha256: Trace this one is forked from.
        fork_decision: Decision at which it leaves its parent.
    """

    episode_id: str
    variant: str = "full"
    seed: int = 0
    run: str = ""
    trace: Path | None = None
    config: LoopConfig | None = None
    parent_sha256: str = ""
    fork_decision: int = -1


@dataclass(frozen=True, slots=True)
class Workbench:
    """A source with everything needed to run its episodes.

    Attributes:
        source: The episodes.
        worlds: Their scenes.
        profile: The body.
        seat_for: Who answers.
        recorder_for: Opens traces.
        parse: Makes the legs.
        noise: How unreliable sensing is; reliable by default.
    """

    source: Source
    worlds: Worlds
    profile: Profile
    seat_for: SeatFor
    recorder_for: RecorderFor
    parse: Parse = parse_english
    noise: NoiseConfig = RELIABLE

    def open(self, spec: OpenSpec) -> EpisodeRun:
        """An episode standing at its first request.

        Raises:
            StartError: The start does not lie on the walkable surface.
            SceneError: The scene is missing or unreadable.
            UsageError: No such episode or variant.
        """
        episode = self.source.episode(spec.episode_id)
        world = self.worlds.of(episode.scene_id)
        start = start_on(world, episode)
        goal_field = goal_field_of(world, episode)
        ladder = self.parse(episode.instruction)
        config = spec.config or preset(spec.variant)
        stage = Stage(
            episode, world, start, goal_field, self.profile, ladder.legs, config, spec.seed
        )
        seat = self._seat(stage)
        header = self._header(spec, stage, seat, ladder)
        shell = LiveShell(
            start=start,
            surface=world.surface,
            renderer=world.renderer,
            profile=self.profile,
            goal_distance=None if goal_field is None else goal_field.distance_m,
            sensors=sensors_of(self.noise, seed=spec.seed, episode_id=spec.episode_id),
        )
        return EpisodeRun(
            Parts(
                header=header,
                loop=navigate(task_of(header)),
                shell=shell,
                ranker=seat.ranker,
                recorder=self.recorder_for(spec.trace, header) if spec.trace else None,
                score=partial(
                    metrics_of,
                    episode=episode,
                    shortest_m=_shortest_m(shell.pose, goal_field),
                    ground_truth_m=self.source.ground_truth_of(episode),
                ),
                before_ask=seat.before_ask,
                scene=world.scene,
                surface=world.surface,
                trace=str(spec.trace or ""),
            )
        )

    def fork(self, spec: OpenSpec, exchanges: Sequence[Exchange], override: Override) -> EpisodeRun:
        """The same episode with recorded answers up to a decision, then another answer.

        Args:
            spec: With `fork_decision` and `parent_sha256` set.
            exchanges: The parent's.
            override: What to commit at the decision.

        Raises:
            UsageError: The decision does not exist, or asked nothing.
        """
        forked_at = next((e for e in exchanges if e.decision == spec.fork_decision), None)
        if forked_at is None or not isinstance(forked_at.request, Ask):
            message = (
                f"expected a decision that put a question, came {spec.fork_decision}; "
                "choose one whose outcome came from a ranker"
            )
            raise UsageError(message)
        run = self.open(spec)
        recorded = {e.index: e for e in exchanges if isinstance(e.request, Ask)}
        while run.footer is None and len(run.exchanges) < forked_at.index:
            if isinstance(run.pending, Ask):
                run.feed(recorded[len(run.exchanges)])
            else:
                run.advance()
        # What the parent's ranker said to the same question stays beside the other answer.
        run.feed(replace(forked_at, response=override.outcome, override=override))
        return run

    def _seat(self, stage: Stage) -> Seat:
        if not stage.config.variant.random_answers:
            return self.seat_for(stage)
        return Seat(AskingRanker(RandomOrder(stage.seed)), "random")

    def _header(self, spec: OpenSpec, stage: Stage, seat: Seat, ladder: RouteLadder) -> Header:
        return Header(
            run=spec.run,
            episode=stage.episode if stage.start == stage.episode.start else _started(stage),
            legs=ladder.legs,
            parser=ladder.parser,
            profile=self.profile,
            variant=spec.variant,
            config=stage.config.as_json(),
            config_sha256=stage.config.sha256(),
            ranker=seat.name,
            seed=spec.seed,
            ranker_options=seat.options,
            privileged=seat.privileged,
            surface=stage.world.surface.source,
            headings=self.source.file.headings,
            scene_licence=stage.world.scene.licence,
            code_version=code_version(),
            parent_sha256=spec.parent_sha256,
            fork_decision=spec.fork_decision,
            templates=template.texts(),
            extra={
                **self.source.facts(),
                **({"surface_note": stage.world.note} if stage.world.note else {}),
                "renderer": stage.world.renderer.name,
                "noise": json.dumps(asdict(self.noise)),
            },
        )


def sensors_of(noise: NoiseConfig, *, seed: int, episode_id: str) -> Sensors | None:
    """The noise of one episode from its own generator; None for reliable sensing."""
    if not noise.moves and not noise.sees:
        return None
    key = hashlib.sha256(f"{seed}/{episode_id}/sensors".encode()).digest()
    return NoisySensors(noise, np.random.default_rng(int.from_bytes(key[:8], "big")))


def noise_of(header: Header) -> NoiseConfig:
    """The noise that a recorded run sensed through."""
    return NoiseConfig(**json.loads(header.extra.get("noise", "{}")))


def task_of(header: Header) -> Task:
    """What the core is given, from the record of a run: nothing about the goal."""
    return Task(
        instruction=header.episode.instruction,
        legs=header.legs,
        profile=header.profile,
        config=LoopConfig.from_json(header.config),
        episode_id=header.episode.episode_id,
        seed=header.seed,
        start=header.episode.start,
    )


def start_on(world: World, episode: Episode) -> Pose:
    """The start pose on the floor; raises `StartError` when it lies off it."""
    wanted = episode.start.position_m
    found = world.surface.snap(wanted)
    if (
        found is None
        or planar_m(found, wanted) > OFF_SURFACE_M
        or abs(found[1] - wanted[1]) > OFF_SURFACE_M
    ):
        message = (
            f"episode {episode.episode_id}: expected a start on the walkable surface of "
            f"{episode.scene_id}, came {_written(wanted)}"
            + (f", whose nearest floor is {_written(found)}" if found else ", with no floor near")
            + "; check the episode's scene and units, or choose another profile"
        )
        raise StartError(message)
    return Pose(found, episode.start.yaw_rad)


def goal_field_of(world: World, episode: Episode) -> DistanceField | None:
    """Distances to the goal; None on a split without goals or where no floor is near the goal."""
    if episode.goal_m is None:
        return None
    goal_m = world.surface.snap(episode.goal_m)
    return None if goal_m is None else world.field(goal_m)


def code_version() -> str:
    """Version of this package."""
    try:
        return version("c2nav")
    except PackageNotFoundError:
        return "unpackaged"


def _started(stage: Stage) -> Episode:
    return replace(stage.episode, start=stage.start)


def _shortest_m(start: Pose, goal_field: DistanceField | None) -> float | None:
    return None if goal_field is None else goal_field.distance_m(start.position_m)


def _written(point_m: Point) -> str:
    return "({:.2f}, {:.2f}, {:.2f}) m".format(*point_m)
