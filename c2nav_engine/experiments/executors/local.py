"""The local executor: this process, or spawned ones that each keep to their scenes."""

from __future__ import annotations

import os
from collections.abc import Generator, Iterator, Sequence
from multiprocessing.connection import wait
from pathlib import Path

from c2nav_engine.experiments.executors.agenda import Agenda
from c2nav_engine.experiments.executors.lanes import run_here
from c2nav_engine.experiments.executors.processes import Job, WorkerProcess
from c2nav_engine.experiments.executors.protocol import Started
from c2nav_engine.experiments.spec import Task
from c2nav_engine.experiments.working import Finished, Work, work


class LocalExecutor:
    """One worker runs here; more are spawned.

    Args:
        workers: Worker processes.
        lanes: Episodes at once in each: more than one only pays when the ranker waits.
        work: Runs a task; a module-level function when workers are spawned.
    """

    def __init__(self, workers: int = 1, *, lanes: int = 1, work: Work = work) -> None:
        self._workers = workers
        self._lanes = lanes
        self._work = work
        self._crew: dict[int, WorkerProcess] = {}

    @property
    def pids(self) -> tuple[int, ...]:
        """Process ids of the spawned workers at work now."""
        return tuple(worker.pid for worker in self._crew.values())

    def run(self, tasks: Sequence[Task], folder: Path, *, started: Started) -> Generator[Finished]:
        """See `Executor.run`."""
        if self._workers <= 1:
            yield from run_here(tasks, folder, lanes=self._lanes, work=self._work, started=started)
            return
        try:
            yield from self._spread(Agenda(tasks), folder, started)
        finally:
            for worker in self._crew.values():
                worker.end()
            self._crew.clear()

    def _spread(self, agenda: Agenda, folder: Path, started: Started) -> Iterator[Finished]:
        """Keep every worker busy; replace those that die."""
        job = Job(self._work, folder, self._lanes)
        while agenda.open:
            for place in range(self._workers):
                yield from self._fill(place, agenda, job, started)
            readable = {worker.readable: place for place, worker in self._crew.items()}
            for connection in wait(list(readable)):
                place = readable[connection]  # pyright: ignore[reportArgumentType]
                finished = self._crew[place].take()
                if finished is None:
                    yield from self._bury(place, agenda)
                else:
                    agenda.finished(place, finished.key)
                    yield finished

    def _fill(self, place: int, agenda: Agenda, job: Job, started: Started) -> Iterator[Finished]:
        while agenda.under_way(place) < self._lanes and (task := agenda.next(place)) is not None:
            if place not in self._crew:
                share = max(1, (os.cpu_count() or 1) // self._workers)
                self._crew[place] = WorkerProcess(job, threads=share)
            started(task)
            if not self._crew[place].give(task):
                yield from self._bury(place, agenda)

    def _bury(self, place: int, agenda: Agenda) -> Iterator[Finished]:
        """A worker died: its tasks wait again, and its place is filled when there is work."""
        self._crew.pop(place).end()
        yield from agenda.lost(place)
