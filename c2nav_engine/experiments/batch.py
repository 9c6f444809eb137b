"""A run folder: manifest, ledger, traces, tables; resumable at any moment."""

from __future__ import annotations

import json
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from filelock import FileLock, Timeout

from c2nav_engine.episodes.profile import profile_named
from c2nav_engine.errors import RankerStopped, UsageError
from c2nav_engine.experiments.columns import Row, write_rows
from c2nav_engine.experiments.executors.protocol import Executor
from c2nav_engine.experiments.ledger import Ledger
from c2nav_engine.experiments.rankers import RANKERS
from c2nav_engine.experiments.spec import RunSpec, Task, by_scene, distinct
from c2nav_engine.experiments.summary import summarise
from c2nav_engine.experiments.working import Finished, source_of
from c2nav_engine.navigator.variants import preset
from c2nav_engine.runner.opening import code_version

MANIFEST_SCHEMA = 1


@dataclass(frozen=True, slots=True)
class Standing:
    """How far a run is.

    Attributes:
        total: Tasks, each distinct configuration once.
        done: Tasks that ended, failed ones included.
        failed: Of these, ended in an error.
        successes: Of these, successful.
        tokens: Tokens so far; None where none are known.
        cost_usd: Price so far; None where none is known.
    """

    total: int
    done: int = 0
    failed: int = 0
    successes: int = 0
    tokens: float | None = None
    cost_usd: float | None = None

    def plus(self, finished: Finished) -> Standing:
        """With one more task."""
        row = finished.row
        return Standing(
            total=self.total,
            done=self.done + 1,
            failed=self.failed + bool(finished.error),
            successes=self.successes + int(row.get("success") or 0),
            tokens=_sum(self.tokens, row.get("tokens")),
            cost_usd=_sum(self.cost_usd, finished.cost_usd),
        )


Progress = Callable[[Standing], None]
"""Told where the run stands: at its start, and after each task."""


@dataclass(frozen=True, slots=True)
class BatchResult:
    """What a run came to.

    Attributes:
        rows: All rows, in the order of the tables.
        errors: Task name → why it failed.
        bad_input: Whether one of them failed at an episode or scene that cannot be used.
    """

    rows: tuple[Row, ...]
    errors: Mapping[str, str]
    bad_input: bool


def run_batch(
    spec: RunSpec,
    folder: Path,
    executor: Executor,
    *,
    resume: bool = False,
    progress: Progress | None = None,
) -> BatchResult:
    """Run what is missing of a run and write its tables.

    Whatever finished stays, also when this raises or is interrupted.

    Raises:
        UsageError: The folder holds another run, is in use, or holds this one and `resume` is off.
        RankerStopped: The ranker said that no further query makes sense.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with _alone(folder):
        _claim(spec, folder, resume=resume)
        with closing(Ledger(folder / "ledger.sqlite")) as ledger:
            return _Batch(spec, folder, ledger, progress or _silent).run(executor)


class _Batch:
    """One sitting at a run: from what is missing to the tables."""

    def __init__(self, spec: RunSpec, folder: Path, ledger: Ledger, progress: Progress) -> None:
        self._tasks = spec.tasks()
        self._grouped = distinct(self._tasks)
        self._folder = folder
        self._ledger = ledger
        self._progress = progress
        ledger.add((key, tasks[0].name) for key, tasks in self._grouped.items())

    def run(self, executor: Executor) -> BatchResult:
        missing = [key for key in self._ledger.missing() if key in self._grouped]
        tasks = by_scene([self._grouped[key][0] for key in missing])
        standing = self._standing(missing)
        self._progress(standing)
        bad_input = False
        try:
            with closing(self._finished(executor, tasks)) as results:
                for finished in results:
                    standing = standing.plus(finished)
                    bad_input |= finished.bad_input
                    self._progress(standing)
                    if finished.stops:
                        raise RankerStopped(finished.error)
        finally:
            rows = self._rows()
            write_tables(rows, self._folder)
        return BatchResult(tuple(rows), self._ledger.errors(), bad_input)

    def _finished(self, executor: Executor, tasks: Sequence[Task]) -> Generator[Finished]:
        """Results as they come, each entered before anyone hears of it."""
        if not tasks:
            return
        running = executor.run(
            tasks, self._folder, started=lambda task: self._ledger.lease(task.key)
        )
        try:
            for finished in running:
                self._enter(finished)
                yield finished
        finally:
            # Workers stop when the generator is closed, not when it is forgotten.
            running.close()

    def _enter(self, finished: Finished) -> None:
        cost_usd = finished.cost_usd
        if finished.error:
            self._ledger.fail(finished.key, finished.error, finished.row, cost_usd=cost_usd)
        else:
            self._ledger.finish(finished.key, finished.row, cost_usd=cost_usd)

    def _standing(self, missing: Sequence[str]) -> Standing:
        known = self._ledger.rows()
        left = set(missing)
        standing = Standing(len(self._grouped))
        for key in self._grouped:
            if key not in left and key in known:
                standing = standing.plus(Finished(key, known[key]))
        return replace(standing, cost_usd=self._ledger.cost_usd())

    def _rows(self) -> list[Row]:
        """Rows in task order; presets that share a config appear under each of their names."""
        known = self._ledger.rows()
        return [
            {**known[task.key], "variant": task.variant}
            for task in self._tasks
            if task.key in known
        ]


def write_tables(rows: Sequence[Row], folder: Path) -> None:
    """Write the row tables and the summary."""
    write_rows(rows, folder)
    text = json.dumps(summarise(rows), indent=2, allow_nan=False)
    part = folder / "summary.json.part"
    part.write_text(text + "\n", encoding="utf-8")
    part.replace(folder / "summary.json")


def manifest_of(spec: RunSpec) -> dict[str, object]:
    """Everything that decides the run, with hashes."""
    source = source_of(spec.setting)
    return {
        "schema": MANIFEST_SCHEMA,
        "code_version": code_version(),
        "spec_sha256": spec.sha256(),
        "source": source.file.name,
        "source_sha256": source.file.sha256,
        "headings": source.file.headings,
        "ground_truth": source.ground_truth_name,
        "profile": asdict(profile_named(spec.setting.profile)),
        "ranker": spec.setting.ranker,
        "ranker_options": dict(spec.setting.ranker_options),
        "privileged": RANKERS[spec.setting.ranker].privileged,
        "seeds": list(spec.seeds),
        "variants": {
            name: {"config": preset(name).as_json(), "sha256": preset(name).sha256()}
            for name in spec.variants
        },
        "spec": asdict(spec),
    }


@contextmanager
def _alone(folder: Path) -> Generator[None]:
    """Two coordinators in one folder would run tasks twice; the lock goes with the process."""
    try:
        with FileLock(folder / ".lock", timeout=0):
            yield
    except Timeout as error:
        message = f"{folder} is in use by another run; wait for it, or name another --out folder"
        raise UsageError(message) from error


def _claim(spec: RunSpec, folder: Path, *, resume: bool) -> None:
    """Write the manifest, or check that the folder holds the same run."""
    manifest = manifest_of(spec)
    path = folder / "manifest.json"
    if not path.is_file():
        part = path.with_suffix(".json.part")
        part.write_text(json.dumps(manifest, indent=2) + "\n", encoding="utf-8")
        part.replace(path)
        return
    try:
        held = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        message = f"expected a manifest at {path}, came: {error}; name another --out folder"
        raise UsageError(message) from error
    differing = [
        name for name in ("spec_sha256", "source_sha256") if held.get(name) != manifest[name]
    ]
    if differing:
        what = "other episodes" if differing == ["source_sha256"] else "another run"
        message = f"{folder} holds {what} ({', '.join(differing)} differs); name another --out"
        raise UsageError(message)
    if not resume:
        message = f"{folder} already holds this run; add --resume to finish what is missing"
        raise UsageError(message)


def _silent(standing: Standing) -> None:
    del standing


def _sum(known: float | None, more: str | float | None) -> float | None:
    if not isinstance(more, int | float):
        return known
    return more if known is None else known + more
