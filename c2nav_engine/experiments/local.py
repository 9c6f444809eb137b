"""The local executor: this process, or spawned ones for simulation."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from pathlib import Path
from typing import Protocol, runtime_checkable

from c2nav_engine.experiments.spec import Task
from c2nav_engine.experiments.working import Finished, work


@runtime_checkable
class Executor(Protocol):
    """Runs tasks somewhere and hands back each as it finishes, in any order."""

    def run(self, tasks: Sequence[Task], folder: Path) -> Iterator[Finished]:
        """Yields one `Finished` a task; closing the iterator cancels what has not started."""
        ...


class LocalExecutor:
    """One worker runs here; more are spawned, each keeping the scenes of its tasks.

    Args:
        workers: Processes.
    """

    def __init__(self, workers: int = 1) -> None:
        self._workers = workers

    def run(self, tasks: Sequence[Task], folder: Path) -> Iterator[Finished]:
        """See `Executor.run`."""
        if self._workers <= 1:
            for task in tasks:
                yield work(task, folder)
            return
        # Spawn: a forked child would share the parent's threads and Open3D's state.
        context = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(self._workers, mp_context=context) as pool:
            waiting: set[Future[Finished]] = {pool.submit(work, task, folder) for task in tasks}
            try:
                while waiting:
                    done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                    for future in done:
                        yield future.result()
            finally:
                pool.shutdown(wait=False, cancel_futures=True)
