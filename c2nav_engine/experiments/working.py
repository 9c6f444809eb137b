"""What a worker does: one task, from spec to trace and row."""

from __future__ import annotations

import functools
import threading
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from c2nav_engine.episodes.profile import profile_named
from c2nav_engine.errors import C2NavError, InputError, RankerStopped
from c2nav_engine.experiments.columns import Row
from c2nav_engine.experiments.parsing import parse_for
from c2nav_engine.experiments.rankers import completion_for, seats_for
from c2nav_engine.experiments.spec import Setting, Task
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.episode_run import EpisodeRun
from c2nav_engine.runner.opening import OpenSpec, Workbench
from c2nav_engine.runner.record import EpisodeOutcome
from c2nav_engine.runner.recording import TraceWriter
from c2nav_engine.runner.source import Source, open_source
from c2nav_engine.runner.worlds import Worlds, WorldsConfig
from c2nav_engine.sensing.renderer import Renderer
from c2nav_engine.world.scene import Scene

Stopping = Callable[[], bool]
"""Whether the run is being interrupted; asked between two exchanges."""


@dataclass(frozen=True, slots=True)
class Finished:
    """What a worker hands back.

    Attributes:
        key: The task's.
        row: Its row of `episodes.csv`.
        error: Why it failed; "" when it did not.
        stops: No further task makes sense (quota, rejected key).
        bad_input: The episode or its scene cannot be used as it is.
        cost_usd: Known price of its queries; None where none is known.
    """

    key: str
    row: Row
    error: str = ""
    stops: bool = False
    bad_input: bool = False
    cost_usd: float | None = None

    @staticmethod
    def failed(task: Task, error: str) -> Finished:
        """A task of which nothing is known but that it failed."""
        row: Row = {
            "episode_id": task.episode_id,
            "scene_id": task.scene_id,
            "variant": task.variant,
            "ranker": task.setting.ranker,
            "seed": task.seed,
            "outcome": EpisodeOutcome.ERROR.value,
        }
        return Finished(task.key, row, error)


Work = Callable[[Task, Path, Stopping], Finished | None]
"""Task, run folder, whether to stop → the result; None when it was interrupted."""


def never() -> bool:
    """Stops for nobody."""
    return False


def source_of(setting: Setting) -> Source:
    """Open the setting's episodes; raises `InputError`."""
    return open_source(
        setting.source,
        scenes=_path(setting.scenes),
        headings=_path(setting.headings),
        ground_truth=_path(setting.ground_truth),
    )


def workbench_of(setting: Setting, run: Path) -> Workbench:
    """Everything the tasks of a setting share in one process, made once.

    Its renderers keep to one thread: a worker is one core, whatever else the machine does.
    """
    source = source_of(setting)
    profile = replace(profile_named(setting.profile), sliding=setting.sliding)
    return Workbench(
        source=source,
        worlds=Worlds(source, WorldsConfig(profile, renderer=_on_one_core)),
        profile=profile,
        seat_for=seats_for(setting.ranker, setting.ranker_options),
        recorder_for=TraceWriter,
        parse=parse_for(
            setting.parser,
            lambda: completion_for(setting.ranker, setting.ranker_options),
            run / "legs",
        ),
        noise=setting.noise,
    )


def _on_one_core(scene: Scene) -> Renderer:
    from c2nav_engine.sensing.embree import EmbreeRenderer

    return EmbreeRenderer(scene, threads=1)


class Simulating:
    """The simulations of one process: they take turns at the scene and overlap at the ranker.

    Scenes, floors and renderers serve one thread at a time, so whatever touches them happens under
    one lock; only the ranker's answer is waited for outside it.

    Args:
        bench_for: Setting and run folder → what its tasks share; `workbench_of` by default.
    """

    def __init__(self, bench_for: Callable[[Setting, Path], Workbench] | None = None) -> None:
        self._bench_for = bench_for
        self._turn = threading.Lock()
        self._benches: dict[str, Workbench] = {}

    def work(self, task: Task, run: Path, stop: Stopping = never) -> Finished | None:
        """Run one task to its end, whatever it is."""
        try:
            with self._turn:
                bench = self._bench(task.setting, run)
            return self._work(bench, task, run, stop)
        except C2NavError as error:
            return _ended(Finished.failed(task, str(error)), error)
        except Exception as error:  # a bug of ours ends its task, not the night's run
            lines = "".join(traceback.format_exception(error))
            return Finished.failed(task, f"unexpected {type(error).__name__}: {error}\n{lines}")

    def _bench(self, setting: Setting, run: Path) -> Workbench:
        name = f"{run}/{setting.identity}/{sorted(setting.ranker_options.items())}"
        if name not in self._benches:
            self._benches = {name: (self._bench_for or workbench_of)(setting, run)}
        return self._benches[name]

    def _work(self, bench: Workbench, task: Task, run: Path, stop: Stopping) -> Finished | None:
        path = task.trace(run)
        path.parent.mkdir(parents=True, exist_ok=True)
        spec = OpenSpec(task.episode_id, task.variant, task.seed, run=run.name, trace=path)
        with self._turn:
            try:
                episode_run = bench.open(spec)
            except C2NavError as error:
                row = _row(task, bench, None)
                return _ended(Finished(task.key, row, str(error)), error)
        try:
            return self._to_end(episode_run, task, bench, stop)
        finally:
            episode_run.close()

    def _to_end(
        self, run: EpisodeRun, task: Task, bench: Workbench, stop: Stopping
    ) -> Finished | None:
        failure: C2NavError | None = None
        try:
            while run.footer is None:
                if stop():
                    return None
                if isinstance(run.pending, Ask):
                    run.propose()
                with self._turn:
                    run.advance()
        except C2NavError as error:
            failure = error
            if run.footer is None:
                run.end(EpisodeOutcome.ERROR, str(error))
        done = Finished(task.key, _row(task, bench, run), cost_usd=_cost_usd(run))
        return done if failure is None else _ended(replace(done, error=str(failure)), failure)


@functools.lru_cache(maxsize=1)
def _simulating() -> Simulating:
    return Simulating()


def work(task: Task, run: Path, stop: Stopping = never) -> Finished | None:
    """Run one task in this process, sharing scenes with the tasks before it."""
    return _simulating().work(task, run, stop)


def _ended(finished: Finished, error: C2NavError) -> Finished:
    return replace(
        finished,
        stops=isinstance(error, RankerStopped),
        bad_input=isinstance(error, InputError),
    )


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


def _cost_usd(run: EpisodeRun) -> float | None:
    costs = [
        query.reply.cost_usd
        for exchange in run.exchanges
        if exchange.ranked is not None
        for query in exchange.ranked.queries
        if query.reply.cost_usd is not None
    ]
    return sum(costs) if costs else None


def _path(text: str) -> Path | None:
    return Path(text) if text else None
