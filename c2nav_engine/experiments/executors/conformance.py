"""The executor conformance kit: what every executor must do, wherever its workers are.

Ships with the engine so that an executor written elsewhere is held to the same laws:

```
check_every_task_once(MyExecutor(work=obliging), folder)
check_lost_workers(MyExecutor(work=obliging), folder)
check_closing(MyExecutor(work=obliging), folder)
```

The tasks are stand-ins: `obliging` reads from a task's seed what is to happen to its worker.
"""

from __future__ import annotations

import os
import signal
import time
from collections import Counter
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path

from c2nav_engine.experiments.columns import Row
from c2nav_engine.experiments.executors.protocol import ATTEMPTS, Executor
from c2nav_engine.experiments.spec import Setting, Task
from c2nav_engine.experiments.working import Finished, Stopping

PLAIN, DIES_ONCE, DIES_ALWAYS, SLOW = 0, 1, 2, 3
"""Seeds: what happens to the worker of such a task."""
_SLOW_S = 20.0


class NotConforming(AssertionError):
    """An executor broke a law of the contract; the message says which, and with what."""


def tasks_of(*seeds: int, scenes: int = 2) -> list[Task]:
    """Stand-in tasks, spread over a few scenes."""
    setting = Setting("builtin", ranker="scripted")
    return [
        Task(setting, str(number), "full", seed, f"scene{number % scenes}")
        for number, seed in enumerate(seeds)
    ]


def obliging(task: Task, folder: Path, stop: Stopping) -> Finished | None:
    """Leaves a mark for every try, then does what the task's seed says."""
    marks = folder / "tried" / task.episode_id
    marks.mkdir(parents=True, exist_ok=True)
    (marks / f"{time.time_ns()}.{os.getpid()}").touch()
    tries = len(list(marks.iterdir()))
    if task.seed == DIES_ALWAYS or (task.seed == DIES_ONCE and tries == 1):
        os.kill(os.getpid(), signal.SIGKILL)
    until_s = time.monotonic() + _SLOW_S
    while task.seed == SLOW and time.monotonic() < until_s:
        if stop():
            return None
        time.sleep(0.02)
    row: Row = {
        "episode_id": task.episode_id,
        "scene_id": task.scene_id,
        "variant": task.variant,
        "ranker": "obliging",
        "seed": task.seed,
        "outcome": "stopped",
        "success": 1,
    }
    return Finished(task.key, row)


def tries(folder: Path, task: Task) -> int:
    """How often a worker took the task up."""
    return len(list((folder / "tried" / task.episode_id).glob("*")))


def check_every_task_once(executor: Executor, folder: Path) -> None:
    """Every task is started, run and handed back once; none is invented; none is left out."""
    tasks = tasks_of(*[PLAIN] * 9, scenes=3)
    started: list[str] = []
    handed = list(executor.run(tasks, folder, started=lambda task: started.append(task.key)))
    _same_keys("handed back", [finished.key for finished in handed], tasks)
    _same_keys("started", started, tasks)
    for task in tasks:
        _demand(tries(folder, task) == 1, f"one try at {task.name}", tries(folder, task))
    _demand(list(executor.run([], folder, started=_ignore)) == [], "nothing of nothing", "more")


def check_lost_workers(executor: Executor, folder: Path) -> None:
    """A task whose worker died is run again; one that kills every worker comes back as failed.

    Only for executors whose workers are processes of their own.
    """
    tasks = tasks_of(PLAIN, DIES_ONCE, PLAIN, DIES_ALWAYS)
    started: list[str] = []
    found = executor.run(tasks, folder, started=lambda task: started.append(task.key))
    handed = {finished.key: finished for finished in found}
    _same_keys("handed back", list(handed), tasks)
    for task in tasks:
        failed = task.seed == DIES_ALWAYS
        _demand(bool(handed[task.key].error) == failed, f"an error: {failed}", handed[task.key])
    deadly, once = tasks[3], tasks[1]
    _demand(1 <= tries(folder, deadly) <= ATTEMPTS, f"{ATTEMPTS} tries", tries(folder, deadly))
    _demand(started.count(deadly.key) == ATTEMPTS, f"{ATTEMPTS} starts", started)
    _demand(tries(folder, once) >= 2, "another try", tries(folder, once))


def check_closing(executor: Executor, folder: Path) -> None:
    """Closing the iterator stops all workers; what they were at is not handed back."""
    tasks = tasks_of(PLAIN, *[SLOW] * 4, scenes=5)
    start_s = time.monotonic()
    with closing(executor.run(tasks, folder, started=_ignore)) as results:
        first = next(results)
    _demand(first.key == tasks[0].key, "the quick task first", first)
    spent_s = time.monotonic() - start_s
    begun = [task for task in tasks if tries(folder, task)]
    time.sleep(0.3)
    later = [task for task in tasks if tries(folder, task)]
    _demand(later == begun, "no task taken up after closing", [task.name for task in later])
    _demand(len(begun) < len(tasks) or spent_s < 4 * _SLOW_S, "an end before all is done", spent_s)


def _ignore(task: Task) -> None:
    del task


def _same_keys(what: str, came: Sequence[str], tasks: Sequence[Task]) -> None:
    expected = Counter(task.key for task in tasks)
    _demand(Counter(came) == expected, f"every task {what} once", Counter(came) - expected)


def _demand(holds: bool, expected: str, came: object) -> None:
    if not holds:
        raise NotConforming(f"expected {expected}, came {came!r}")
