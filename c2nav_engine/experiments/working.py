"""What a worker does: one task, from spec to trace and row."""

from __future__ import annotations

import functools
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from c2nav_engine.episodes.profile import profile_named
from c2nav_engine.errors import C2NavError, InputError, RankerStopped
from c2nav_engine.experiments.columns import Row
from c2nav_engine.experiments.rankers import seats_for
from c2nav_engine.experiments.spec import Setting, Task
from c2nav_engine.runner.episode_run import EpisodeRun, run_to_end
from c2nav_engine.runner.opening import OpenSpec, Workbench
from c2nav_engine.runner.record import EpisodeOutcome
from c2nav_engine.runner.recording import TraceWriter
from c2nav_engine.runner.source import Source, open_source
from c2nav_engine.runner.worlds import Worlds, WorldsConfig
from c2nav_engine.sensing.noise import NoiseConfig


@dataclass(frozen=True, slots=True)
class Finished:
    """What a worker hands back.

    Attributes:
        key: The task's.
        row: Its row of `episodes.csv`.
        error: Why it failed; "" when it did not.
        stops: No further task makes sense (quota, rejected key).
        bad_input: The episode or its scene cannot be used as it is.
    """

    key: str
    row: Row
    error: str = ""
    stops: bool = False
    bad_input: bool = False


def source_of(setting: Setting) -> Source:
    """Open the setting's episodes; raises `InputError`."""
    return open_source(
        setting.source,
        scenes=_path(setting.scenes),
        headings=_path(setting.headings),
        ground_truth=_path(setting.ground_truth),
    )


def workbench_of(setting: Setting) -> Workbench:
    """Everything the tasks of a setting share in one process, made once."""
    return _workbench(json.dumps(asdict(setting), sort_keys=True))


@functools.lru_cache(maxsize=2)
def _workbench(setting_json: str) -> Workbench:
    setting = Setting(**json.loads(setting_json))
    source = source_of(setting)
    profile = replace(profile_named(setting.profile), sliding=setting.sliding)
    return Workbench(
        source=source,
        worlds=Worlds(source, WorldsConfig(profile)),
        profile=profile,
        seat_for=seats_for(setting.ranker, setting.ranker_options),
        recorder_for=TraceWriter,
        noise=NoiseConfig(
            translation=setting.odometry_noise,
            rotation=setting.odometry_noise,
            depth=setting.depth_noise,
        ),
    )


def work(task: Task, run: Path) -> Finished:
    """Run one task to its end, whatever it is; only a broken promise of ours raises."""
    bench = workbench_of(task.setting)
    path = task.trace(run)
    path.parent.mkdir(parents=True, exist_ok=True)
    episode_run: EpisodeRun | None = None
    try:
        episode_run = bench.open(
            OpenSpec(task.episode_id, task.variant, task.seed, run=run.name, trace=path)
        )
        run_to_end(episode_run)
    except C2NavError as error:
        if episode_run is not None and episode_run.footer is None:
            episode_run.end(EpisodeOutcome.ERROR, str(error))
        row = _row(task, bench, episode_run)
        return Finished(
            task.key,
            row,
            str(error),
            stops=isinstance(error, RankerStopped),
            bad_input=isinstance(error, InputError),
        )
    finally:
        if episode_run is not None:
            episode_run.close()
    return Finished(task.key, _row(task, bench, episode_run))


def _row(task: Task, bench: Workbench, run: EpisodeRun | None) -> Row:
    episode = bench.source.episode(task.episode_id)
    metrics: Mapping[str, float | int | None] = {}
    outcome = EpisodeOutcome.ERROR
    if run is not None and run.footer is not None:
        metrics, outcome = run.footer.metrics, run.footer.outcome
    return {
        "episode_id": episode.episode_id,
        "trajectory_id": episode.trajectory_id,
        "scene_id": episode.scene_id,
        "variant": task.variant,
        "ranker": run.header.ranker if run is not None else task.setting.ranker,
        "seed": task.seed,
        "outcome": outcome.value,
        **metrics,
        "trace_sha256": run.trace_sha256 if run is not None else None,
    }


def _path(text: str) -> Path | None:
    return Path(text) if text else None
