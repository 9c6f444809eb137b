"""A batch in a process of its own, with stand-in work that takes a moment."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

from c2nav_engine.experiments.batch import run_batch
from c2nav_engine.experiments.executors.local import LocalExecutor
from c2nav_engine.experiments.spec import RunSpec, Setting, Task
from c2nav_engine.experiments.working import Finished, Stopping

ROOT = Path(__file__).resolve().parents[2]
MOMENT_S = 0.15


def stand_in_spec(episodes: int = 12, **options: str) -> RunSpec:
    """Built-in episodes that nobody will open."""
    setting = Setting("builtin", ranker="scripted", ranker_options=options)
    ids = tuple(str(number) for number in range(1, episodes + 1))
    scenes = tuple(f"scene{number % 3}" for number in range(episodes))
    return RunSpec(setting, ids, ("full",), (0,), scenes)


def dawdling(task: Task, folder: Path, stop: Stopping) -> Finished | None:
    """Marks its begin and its end, a moment apart; a trace in the making stands between them."""
    marks = folder / "marks"
    marks.mkdir(exist_ok=True)
    name = f"{task.name}.{time.time_ns()}.{os.getpid()}"
    (marks / f"{name}.begun").touch()
    trace = task.trace(folder)
    trace.parent.mkdir(exist_ok=True)
    part = trace.with_name(f"{trace.name}.part")
    part.write_text("unfinished")
    time.sleep(MOMENT_S)
    part.replace(trace)
    (marks / f"{name}.ended").touch()
    row = {"episode_id": task.episode_id, "variant": task.variant, "seed": task.seed}
    return Finished(task.key, {**row, "ranker": "x", "outcome": "stopped", "success": 1})


def ends(folder: Path) -> Counter[str]:
    """How often each task was run to its end."""
    return Counter(path.name.split(".")[0] for path in (folder / "marks").glob("*.ended"))


def batch_process(folder: Path, *, workers: int) -> subprocess.Popen[bytes]:
    """Run or resume the stand-in batch in a process of its own."""
    code = f"from tests.helpers.batch_work import main; main({str(folder)!r}, {workers})"
    with (folder.parent / "log").open("ab") as log:
        return subprocess.Popen(
            [sys.executable, "-c", code], cwd=ROOT, stdout=log, stderr=log, start_new_session=True
        )


def main(folder: str, workers: int) -> None:
    """What that process does."""
    executor = LocalExecutor(workers, work=dawdling)
    run_batch(stand_in_spec(), Path(folder), executor, resume=True)
