"""Serialisable specs: a run, and the tasks it consists of."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import cached_property, lru_cache
from pathlib import Path

from c2nav_engine.episodes.profile import profile_named
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.asking import ASKING_OPTIONS
from c2nav_engine.experiments.parsing import parser_named
from c2nav_engine.experiments.rankers import DEFAULT_RANKER, RANKERS
from c2nav_engine.navigator.variants import preset
from c2nav_engine.sensing.noise import NoiseConfig


@dataclass(frozen=True)
class Setting:
    """What all tasks of a run share; plain values, so that it travels to any worker.

    Attributes:
        source: `builtin` or an episode file.
        scenes: Scenes folder ("" for none).
        headings: File whose start rotations are taken ("" for none).
        ground_truth: Ground-truth file ("" for the default).
        profile: Embodiment profile.
        ranker: Ranker name.
        ranker_options: Its options; keys of services are named, never held.
        odometry_noise: Standard deviation of steps and turns, as a fraction of them.
        depth_noise: Standard deviation of depths, as a fraction of them.
        sliding: Whether blocked moves slide.
        parser: Route parser; `model` asks the ranker's own server, once a text.
    """

    source: str
    scenes: str = ""
    headings: str = ""
    ground_truth: str = ""
    profile: str = "vlnce"
    ranker: str = DEFAULT_RANKER
    ranker_options: Mapping[str, str] = field(default_factory=dict[str, str])
    odometry_noise: float = 0.0
    depth_noise: float = 0.0
    sliding: bool = True
    parser: str = "english"

    def check(self) -> None:
        """Reject unknown names and impossible noise before anything starts; raises `UsageError`."""
        profile_named(self.profile)
        parser_named(self.parser)
        if self.ranker not in RANKERS:
            message = f"expected a ranker ({', '.join(RANKERS)}), came {self.ranker!r}"
            raise UsageError(message)
        _ = self.noise

    @property
    def noise(self) -> NoiseConfig:
        """How unreliable sensing is; raises `UsageError` where that makes no sense."""
        return NoiseConfig(
            translation=self.odometry_noise,
            rotation=self.odometry_noise,
            depth=self.depth_noise,
        )

    @cached_property
    def identity(self) -> str:
        """Everything that decides a result, as JSON.

        How widely to ask and when to stop does not: a run that used up its budget is resumed with
        a larger one.
        """
        options = {k: v for k, v in self.ranker_options.items() if k not in ASKING_OPTIONS}
        return json.dumps(asdict(self) | {"ranker_options": options}, sort_keys=True)


@dataclass(frozen=True)
class Task:
    """One episode under one variant and seed.

    Attributes:
        setting: What the run's tasks share.
        episode_id: Episode.
        variant: Preset.
        seed: Run seed.
        scene_id: The episode's scene, so that workers keep to one; "" when not known.
    """

    setting: Setting
    episode_id: str
    variant: str
    seed: int
    scene_id: str = ""

    @cached_property
    def key(self) -> str:
        """Hash of everything that decides the result; equal configs share it across names."""
        facts = [self.setting.identity, self.episode_id, config_sha256(self.variant), self.seed]
        return hashlib.sha256(json.dumps(facts).encode()).hexdigest()

    @property
    def name(self) -> str:
        """Stem of the trace file."""
        return trace_name(self.episode_id, self.variant, self.seed)

    def trace(self, run: Path) -> Path:
        """Where its trace stands in a run folder."""
        return run / "traces" / f"{self.name}.mcap"


@dataclass(frozen=True, slots=True)
class RunSpec:
    """Episodes × variants × seeds.

    Attributes:
        setting: What the tasks share.
        episodes: Episode ids in source order.
        variants: Presets.
        seeds: Seeds.
        scenes: Scene id of each episode; () when not known.
    """

    setting: Setting
    episodes: tuple[str, ...]
    variants: tuple[str, ...]
    seeds: tuple[int, ...]
    scenes: tuple[str, ...] = ()

    def tasks(self) -> tuple[Task, ...]:
        """All tasks, in the order of the run's tables."""
        scenes = self.scenes or ("",) * len(self.episodes)
        return tuple(
            Task(self.setting, episode, variant, seed, scene)
            for variant in self.variants
            for seed in self.seeds
            for episode, scene in zip(self.episodes, scenes, strict=True)
        )

    def sha256(self) -> str:
        """Hash of what decides the results; the manifest of a resumed run must have the same."""
        facts = [self.setting.identity, self.episodes, self.variants, self.seeds]
        return hashlib.sha256(json.dumps(facts).encode()).hexdigest()


@lru_cache(maxsize=64)
def config_sha256(variant: str) -> str:
    """Hash of a preset's config; raises `UsageError` for an unknown one."""
    return preset(variant).sha256()


def trace_name(episode_id: str, variant: str, seed: int) -> str:
    """Stem of a trace file, whatever characters the episode's id holds."""
    safe = "".join(c if c.isalnum() or c in "-_" else "_" for c in episode_id)
    return f"{safe}.{variant}.{seed}"


def distinct(tasks: Iterable[Task]) -> dict[str, list[Task]]:
    """Tasks by key: presets with one config are run once and appear under both names."""
    grouped: dict[str, list[Task]] = {}
    for task in tasks:
        grouped.setdefault(task.key, []).append(task)
    return grouped


def by_scene(tasks: Sequence[Task]) -> list[Task]:
    """The same tasks with those of one scene together, scenes in order of first appearance."""
    places: dict[str, int] = {}
    for task in tasks:
        places.setdefault(task.scene_id, len(places))
    return sorted(tasks, key=lambda task: places[task.scene_id])
