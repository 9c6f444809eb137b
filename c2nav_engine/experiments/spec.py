"""Serialisable specs: a run, and the tasks it consists of."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

from c2nav_engine.episodes.profile import profile_named
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.rankers import DEFAULT_RANKER, RANKERS
from c2nav_engine.navigator.variants import preset


@dataclass(frozen=True, slots=True)
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

    def check(self) -> None:
        """Reject unknown names before anything starts; raises `UsageError`."""
        profile_named(self.profile)
        if self.ranker not in RANKERS:
            message = f"expected a ranker ({', '.join(RANKERS)}), came {self.ranker!r}"
            raise UsageError(message)


@dataclass(frozen=True, slots=True)
class Task:
    """One episode under one variant and seed.

    Attributes:
        setting: What the run's tasks share.
        episode_id: Episode.
        variant: Preset.
        seed: Run seed.
    """

    setting: Setting
    episode_id: str
    variant: str
    seed: int

    @property
    def key(self) -> str:
        """Hash of everything that decides the result; equal configs share it across names."""
        facts = asdict(self) | {"variant": "", "config": preset(self.variant).sha256()}
        return hashlib.sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest()

    @property
    def name(self) -> str:
        """Stem of the trace file."""
        safe = "".join(c if c.isalnum() or c in "-_" else "_" for c in self.episode_id)
        return f"{safe}.{self.variant}.{self.seed}"

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
    """

    setting: Setting
    episodes: tuple[str, ...]
    variants: tuple[str, ...]
    seeds: tuple[int, ...]

    def tasks(self) -> tuple[Task, ...]:
        """All tasks; neighbours share a scene where the source lists them so."""
        return tuple(
            Task(self.setting, episode, variant, seed)
            for variant in self.variants
            for seed in self.seeds
            for episode in self.episodes
        )


def distinct(tasks: Sequence[Task]) -> dict[str, list[Task]]:
    """Tasks by key: presets with one config are run once and appear under both names."""
    grouped: dict[str, list[Task]] = {}
    for task in tasks:
        grouped.setdefault(task.key, []).append(task)
    return grouped
