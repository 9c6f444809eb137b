"""One spawned worker process: it runs what it is sent and dies with its parent."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from pathlib import Path

from c2nav_engine.experiments.executors.lanes import Lanes
from c2nav_engine.experiments.spec import Task
from c2nav_engine.experiments.working import Finished, Work, never

# Read by numpy's, numba's, torch's and OpenCV's thread pools when a process starts.
THREAD_VARIABLES = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "NUMBA_NUM_THREADS",
    "OPENCV_FOR_THREADS_NUM",
)


@dataclass(frozen=True, slots=True)
class Job:
    """What a worker process is started with.

    Attributes:
        work: Runs a task; a module-level function, because it is sent by name.
        folder: The run folder.
        lanes: Tasks at once.
    """

    work: Work
    folder: Path
    lanes: int = 1


class WorkerProcess:
    """The parent's end of a spawned worker.

    Args:
        job: What it does.
        threads: Threads of its numerical libraries.
    """

    def __init__(self, job: Job, *, threads: int) -> None:
        # Spawn: a forked child would share the parent's threads and Open3D's state.
        context = multiprocessing.get_context("spawn")
        self._connection, theirs = context.Pipe()
        self._process: SpawnProcess = context.Process(target=serve, args=(theirs, job), daemon=True)
        with _environment(dict.fromkeys(THREAD_VARIABLES, str(threads))):
            self._process.start()
        theirs.close()

    @property
    def pid(self) -> int:
        """Process id."""
        return self._process.pid or 0

    @property
    def readable(self) -> Connection:
        """Becomes ready when the worker sent something, or died."""
        return self._connection

    def give(self, task: Task) -> bool:
        """Send a task; False when the worker is no longer there."""
        try:
            self._connection.send(task)
        except OSError:
            return False
        return True

    def take(self) -> Finished | None:
        """What the worker sent; None when it is no longer there."""
        try:
            return self._connection.recv()
        except (EOFError, OSError):
            return None

    def end(self) -> None:
        """Kill it, whatever it is at; its trace stays unfinished and recoverable."""
        self._connection.close()
        self._process.kill()
        self._process.join()
        self._process.close()


def serve(connection: Connection, job: Job) -> None:
    """The worker's side: run until the parent hangs up."""
    # An interrupt reaches the whole group; the parent alone decides what it means.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_die_with_parent, daemon=True).start()
    sending = threading.Lock()

    def hand_back(_task: Task, finished: Finished | None) -> None:
        if finished is not None:
            with sending:
                connection.send(finished)

    try:
        if job.lanes == 1:
            while True:
                task: Task = connection.recv()
                hand_back(task, job.work(task, job.folder, never))
        crew = Lanes(job.lanes, job.work, job.folder, hand_back=hand_back)
        while True:
            crew.give(connection.recv())
    except (EOFError, OSError):
        os._exit(0)


def _die_with_parent() -> None:
    """A killed parent cannot stop its workers, and a resumed run must not find them writing."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)


@contextmanager
def _environment(variables: Mapping[str, str]) -> Generator[None]:
    """Variables for a child about to start; the user's own setting wins."""
    added = {name: value for name, value in variables.items() if name not in os.environ}
    os.environ.update(added)
    try:
        yield
    finally:
        for name in added:
            del os.environ[name]
