"""A run folder: manifest, ledger, traces, tables; resumable at any moment."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path

from c2nav_engine.episodes.profile import profile_named
from c2nav_engine.errors import RankerStopped, UsageError
from c2nav_engine.experiments.columns import Row, write_rows
from c2nav_engine.experiments.ledger import Ledger
from c2nav_engine.experiments.local import Executor
from c2nav_engine.experiments.spec import RunSpec, Task, distinct
from c2nav_engine.experiments.summary import summarise
from c2nav_engine.experiments.working import Finished, source_of
from c2nav_engine.navigator.variants import preset
from c2nav_engine.runner.opening import code_version

MANIFEST_SCHEMA = 1

Progress = Callable[[Finished, int, int], None]
"""Told about each finished task, how many are done and how many there are."""


def run_batch(
    spec: RunSpec,
    folder: Path,
    executor: Executor,
    *,
    resume: bool = False,
    progress: Progress | None = None,
) -> list[Row]:
    """Run what is missing of a run and write its tables; returns all rows.

    Whatever finished stays, also when this raises or is interrupted.

    Raises:
        UsageError: The folder holds another run, or a run and `resume` is off.
        RankerStopped: The ranker said that no further query makes sense.
    """
    folder.mkdir(parents=True, exist_ok=True)
    _claim(spec, folder, resume=resume)
    grouped = distinct(spec.tasks())
    ledger = Ledger(folder / "ledger.sqlite")
    ledger.add((key, tasks[0].name) for key, tasks in grouped.items())
    missing = [key for key in ledger.missing() if key in grouped]
    try:
        for key in missing:
            ledger.lease(key)
        done = len(grouped) - len(missing)
        for finished in executor.run([grouped[key][0] for key in missing], folder):
            _enter(ledger, finished)
            done += 1
            if progress is not None:
                progress(finished, done, len(grouped))
            if finished.stops:
                raise RankerStopped(finished.error)
    finally:
        rows = _rows(grouped, ledger)
        write_tables(rows, folder)
        ledger.close()
    return rows


def write_tables(rows: Sequence[Row], folder: Path) -> None:
    """Write the row tables and the summary."""
    write_rows(rows, folder)
    text = json.dumps(summarise(rows), indent=2, allow_nan=False)
    (folder / "summary.json").write_text(text + "\n", encoding="utf-8")


def _enter(ledger: Ledger, finished: Finished) -> None:
    if finished.error:
        ledger.fail(finished.key, finished.error, finished.row)
    else:
        ledger.finish(finished.key, finished.row)


def _rows(grouped: dict[str, list[Task]], ledger: Ledger) -> list[Row]:
    """Rows in task order; presets that share a config appear under each of their names."""
    known = ledger.rows()
    rows: list[tuple[Task, Row]] = [
        (task, {**known[key], "variant": task.variant})
        for key, tasks in grouped.items()
        if key in known
        for task in tasks
    ]
    order = {id(task): i for i, task in enumerate(t for ts in grouped.values() for t in ts)}
    return [row for _, row in sorted(rows, key=lambda pair: order[id(pair[0])])]


def _claim(spec: RunSpec, folder: Path, *, resume: bool) -> None:
    """Write the manifest, or check that the folder holds the same run."""
    manifest = manifest_of(spec)
    path = folder / "manifest.json"
    if not path.is_file():
        path.write_text(json.dumps(manifest, indent=2) + "\n", encoding="utf-8")
        return
    try:
        held = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        message = f"expected a manifest at {path}, came: {error}; name another --out folder"
        raise UsageError(message) from error
    if held.get("spec_sha256") != manifest["spec_sha256"]:
        message = f"{folder} holds another run; name another --out folder"
        raise UsageError(message)
    if not resume:
        message = f"{folder} already holds this run; add --resume to finish what is missing"
        raise UsageError(message)


def manifest_of(spec: RunSpec) -> dict[str, object]:
    """Everything that decides the run, with hashes."""
    source = source_of(spec.setting)
    plain = asdict(spec)
    text = json.dumps(plain, sort_keys=True)
    return {
        "schema": MANIFEST_SCHEMA,
        "code_version": code_version(),
        "spec_sha256": hashlib.sha256(text.encode()).hexdigest(),
        "source": source.file.name,
        "source_sha256": source.file.sha256,
        "headings": source.file.headings,
        "ground_truth": source.ground_truth_name,
        "profile": asdict(profile_named(spec.setting.profile)),
        "ranker": spec.setting.ranker,
        "ranker_options": dict(spec.setting.ranker_options),
        "seeds": list(spec.seeds),
        "variants": {
            name: {"config": preset(name).as_json(), "sha256": preset(name).sha256()}
            for name in spec.variants
        },
        "spec": plain,
    }
