"""The Slurm executor: jobs of a few dozen tasks by submitit, results by way of the run folder.

This module is where submitit, which types little, meets the rest.
"""

from __future__ import annotations

import time
from collections.abc import Generator, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from c2nav_engine.errors import MissingExtra
from c2nav_engine.experiments.executors.agenda import Agenda
from c2nav_engine.experiments.executors.inbox import Inbox, work_through
from c2nav_engine.experiments.executors.processes import THREAD_VARIABLES
from c2nav_engine.experiments.executors.protocol import Started
from c2nav_engine.experiments.spec import Task
from c2nav_engine.experiments.working import Finished, Work, work

TASKS_A_JOB = 25
"""Most tasks of one job [C]: a lost job costs no more than its unfinished ones."""
GRACE_S = 3.0
"""How long jobs of a dead coordinator get to notice that they are no longer wanted."""
GOODBYE_S = 10.0
"""How long submitit's own processes may take to end."""
_USUAL: Mapping[str, str | int] = {"timeout_min": 240, "cpus_per_task": 1, "mem_gb": 8}


class SlurmExecutor:
    """One job a worker at a time; the next follows when it ends.

    Args:
        workers: Jobs at once.
        lanes: Episodes at once in each.
        cluster: "slurm", or "local" for submitit's own processes (tests).
        options: Submitit's parameters (`timeout_min`, `slurm_partition`, …) as words.
        tasks_a_job: Most tasks of one job.
        poll_s: How often jobs are looked at.
        work: Runs a task; a module-level function.
    """

    def __init__(
        self,
        workers: int = 1,
        *,
        lanes: int = 1,
        cluster: str = "slurm",
        options: Mapping[str, str] | None = None,
        tasks_a_job: int = TASKS_A_JOB,
        poll_s: float = 1.0,
        work: Work = work,
    ) -> None:
        self._workers = workers
        self._lanes = lanes
        self._cluster = cluster
        self._options = dict(options or {})
        self._tasks_a_job = tasks_a_job
        self._poll_s = poll_s
        self._work = work
        self._jobs: dict[int, Any] = {}

    def run(self, tasks: Sequence[Task], folder: Path, *, started: Started) -> Generator[Finished]:
        """See `Executor.run`; raises `MissingExtra` without submitit."""
        folder = folder.resolve()
        inbox = Inbox(folder / "jobs")
        late = inbox.was_owned
        owner = inbox.open()
        if late:
            time.sleep(GRACE_S)
        # What a dead coordinator's jobs finished after it died is done all the same.
        wanted = {task.key for task in tasks}
        early = {finished.key: finished for finished in inbox.take() if finished.key in wanted}
        yield from early.values()
        agenda = Agenda([task for task in tasks if task.key not in early])
        submitting = self._submitting(folder)
        try:
            while agenda.open:
                for place in range(self._workers):
                    self._submit(place, agenda, (submitting, folder, owner), started)
                yield from self._collect(agenda, inbox)
        finally:
            inbox.close()
            self._end()

    def _end(self) -> None:
        """Cancel what still runs; own processes notice by themselves and get the time for it."""
        until_s = time.monotonic() + (GOODBYE_S if self._cluster == "local" else 0.0)
        for job in self._jobs.values():
            while not job.done() and time.monotonic() < until_s:
                time.sleep(0.05)
            if not job.done():
                job.cancel(check=False)
        self._jobs.clear()

    def _submitting(self, folder: Path) -> Any:
        executor = _submitit().AutoExecutor(folder=folder / "jobs", cluster=self._cluster)
        given = {
            name: int(text) if text.isdigit() else text for name, text in self._options.items()
        }
        own = {} if self._cluster != "slurm" else {"slurm_setup": _setup()}
        executor.update_parameters(**{**_USUAL, "name": "c2nav", **own, **given})
        return executor

    def _submit(
        self, place: int, agenda: Agenda, where: tuple[Any, Path, str], started: Started
    ) -> None:
        """Give a free place its next job."""
        submitting, folder, owner = where
        if place in self._jobs:
            return
        tasks: list[Task] = []
        while len(tasks) < self._tasks_a_job and (task := agenda.next(place)) is not None:
            started(task)
            tasks.append(task)
        if tasks:
            self._jobs[place] = submitting.submit(
                work_through, tasks, folder, owner, lanes=self._lanes, work=self._work
            )

    def _collect(self, agenda: Agenda, inbox: Inbox) -> Iterator[Finished]:
        """Wait a little; hand on what came in, and bury jobs that ended without finishing."""
        time.sleep(self._poll_s)
        # Asked before the inbox is emptied: a job that is over has put everything there.
        over = [place for place, job in self._jobs.items() if job.done()]
        for finished in inbox.take():
            agenda.finished_anywhere(finished.key)
            yield finished
        for place in over:
            del self._jobs[place]
            if agenda.under_way(place):
                yield from agenda.lost(place)


def _setup() -> list[str]:
    return [f"export {name}=${{{name}:-1}}" for name in THREAD_VARIABLES]


def _submitit() -> Any:
    try:
        import submitit
    except ImportError as error:
        message = (
            "expected the package submitit, came none; install the extra: pip install "
            "'c2nav[slurm]'"
        )
        raise MissingExtra(message) from error
    return submitit
