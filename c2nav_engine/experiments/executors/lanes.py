"""Several tasks of one process at once, for rankers that wait: episodes overlap while they do."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from c2nav_engine.experiments.executors.agenda import Agenda
from c2nav_engine.experiments.executors.protocol import Started
from c2nav_engine.experiments.spec import Task
from c2nav_engine.experiments.working import Finished, Work, never

GOODBYE_S = 5.0
"""How long an interrupted lane may take to end its query."""

HandBack = Callable[[Task, Finished | None], None]
"""Takes a lane's result; None when it was interrupted."""


class Lanes:
    """Threads that each run one task at a time and hand it back.

    Args:
        count: How many.
        work: What runs a task.
        folder: The run folder.
        hand_back: Called from the lanes' threads.
    """

    def __init__(self, count: int, work: Work, folder: Path, *, hand_back: HandBack) -> None:
        self._given: queue.SimpleQueue[Task | None] = queue.SimpleQueue()
        self._stopping = threading.Event()
        self._work = work
        self._folder = folder
        self._hand_back = hand_back
        self._threads = [threading.Thread(target=self._serve, daemon=True) for _ in range(count)]
        for thread in self._threads:
            thread.start()

    def give(self, task: Task) -> None:
        """Queue a task for the next free lane."""
        self._given.put(task)

    def close(self) -> None:
        """Stop every lane between two exchanges."""
        self._stopping.set()
        for _ in self._threads:
            self._given.put(None)
        for thread in self._threads:
            thread.join(GOODBYE_S)

    def _serve(self) -> None:
        while (task := self._given.get()) is not None and not self._stopping.is_set():
            self._hand_back(task, self._work(task, self._folder, self._stopping.is_set))


def run_here(
    tasks: Sequence[Task], folder: Path, *, lanes: int, work: Work, started: Started
) -> Iterator[Finished]:
    """Run tasks in this process, so many at once; see `Executor.run`."""
    agenda = Agenda(tasks)
    if lanes == 1:
        while (task := agenda.next(0)) is not None:
            started(task)
            finished = work(task, folder, never)
            if finished is not None:
                yield finished
        return
    done: queue.SimpleQueue[tuple[Task, Finished | None]] = queue.SimpleQueue()
    crew = Lanes(lanes, work, folder, hand_back=lambda task, result: done.put((task, result)))
    try:
        while agenda.open:
            while agenda.under_way(0) < lanes and (task := agenda.next(0)) is not None:
                started(task)
                crew.give(task)
            task, finished = done.get()
            agenda.finished(0, task.key)
            if finished is not None:
                yield finished
    finally:
        crew.close()
