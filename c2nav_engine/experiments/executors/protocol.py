"""The contract between a batch and whatever runs its tasks."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from pathlib import Path
from typing import Protocol, runtime_checkable

from c2nav_engine.experiments.spec import Task
from c2nav_engine.experiments.working import Finished

Started = Callable[[Task], None]
"""Told that a worker was given the task; again when it is given to another."""

ATTEMPTS = 3
"""Workers that may be lost to one task before it is handed back as failed [C]."""


@runtime_checkable
class Executor(Protocol):
    """Runs tasks somewhere and hands back each as it finishes, in any order.

    The conformance kit (`executors.conformance`) holds every implementation to this.
    """

    def run(self, tasks: Sequence[Task], folder: Path, *, started: Started) -> Generator[Finished]:
        """One `Finished` a task, whatever happens to workers.

        A task whose worker was lost is given to another, `ATTEMPTS` times in all. Closing the
        iterator stops every worker; what they were at stays unfinished and nothing of it is
        handed back.

        Args:
            tasks: What to run; keys are distinct.
            folder: The run folder, which every worker must be able to write.
            started: Called before a worker gets a task.
        """
        ...


def lost(task: Task, attempts: int) -> Finished:
    """A task that cost every worker it was given to."""
    message = (
        f"expected a worker to finish {task.name}, came {attempts} that died at it; look for "
        "memory or a crash in that scene, then resume the run"
    )
    return Finished.failed(task, message)
