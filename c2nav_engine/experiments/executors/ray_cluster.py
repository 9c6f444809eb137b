"""The Ray executor: actors on an existing cluster, or on a local one that is made and ended.

Every node must have this package and see the run folder and the scenes under the same paths.
This module is where Ray, which types little, meets the rest.
"""

from __future__ import annotations

import os
from collections.abc import Generator, Iterator, Sequence
from pathlib import Path
from typing import Any

from c2nav_engine.errors import InternalError, MissingExtra
from c2nav_engine.experiments.executors.agenda import Agenda
from c2nav_engine.experiments.executors.processes import THREAD_VARIABLES
from c2nav_engine.experiments.executors.protocol import Started
from c2nav_engine.experiments.spec import Task
from c2nav_engine.experiments.working import Finished, Work, never, work


class RayExecutor:
    """One actor a worker; each keeps the scenes of its tasks.

    Args:
        workers: Actors, each on one CPU of the cluster.
        lanes: Episodes at once in each.
        address: Of an existing cluster ("auto" finds this machine's); "" makes a local one.
        work: Runs a task.
    """

    def __init__(
        self, workers: int = 1, *, lanes: int = 1, address: str = "", work: Work = work
    ) -> None:
        self._workers = workers
        self._lanes = lanes
        self._address = address
        self._work = work
        self._crew: dict[int, Any] = {}

    def run(self, tasks: Sequence[Task], folder: Path, *, started: Started) -> Generator[Finished]:
        """See `Executor.run`; raises `MissingExtra` without Ray."""
        ray = _ray()
        ours = not ray.is_initialized()
        if ours:
            self._connect(ray)
        try:
            yield from self._spread(ray, Agenda(tasks), folder.resolve(), started)
        finally:
            for actor in self._crew.values():
                ray.kill(actor)
            self._crew.clear()
            if ours:
                ray.shutdown()

    def _connect(self, ray: Any) -> None:
        if self._address:
            ray.init(address=self._address, log_to_driver=False)
            return
        ray.init(
            num_cpus=self._workers,
            include_dashboard=False,
            log_to_driver=False,
            _node_ip_address="127.0.0.1",
        )

    def _spread(
        self, ray: Any, agenda: Agenda, folder: Path, started: Started
    ) -> Iterator[Finished]:
        """Keep every actor busy; replace those that die."""
        places: dict[Any, tuple[int, Task]] = {}
        while agenda.open:
            for place in range(self._workers):
                while agenda.under_way(place) < self._lanes:
                    task = agenda.next(place)
                    if task is None:
                        break
                    started(task)
                    reference = self._actor(ray, place).work.remote(task, folder)
                    places[reference] = (place, task)
            ready, _ = ray.wait(list(places), num_returns=1)
            place, task = places.pop(ready[0])
            try:
                finished: Finished | None = ray.get(ready[0])
            except ray.exceptions.RayActorError:
                # All that this actor was at is lost with it, and stands in `agenda` alone.
                places = {ref: at for ref, at in places.items() if at[0] != place}
                self._crew.pop(place, None)
                yield from agenda.lost(place)
                continue
            except ray.exceptions.RayTaskError as error:
                raise InternalError(f"a Ray worker failed at {task.name}: {error}") from error
            agenda.finished(place, task.key)
            if finished is not None:
                yield finished

    def _actor(self, ray: Any, place: int) -> Any:
        if place not in self._crew:
            variables = {name: os.environ.get(name, "1") for name in THREAD_VARIABLES}
            made = ray.remote(_Worker).options(
                num_cpus=1,
                max_concurrency=self._lanes,
                runtime_env={"env_vars": variables},
            )
            self._crew[place] = made.remote(self._work)
        return self._crew[place]


class _Worker:
    """What lives in an actor's process."""

    def __init__(self, work: Work) -> None:
        self._work = work

    def work(self, task: Task, folder: Path) -> Finished | None:
        """Run one task."""
        return self._work(task, folder, never)


def _ray() -> Any:
    try:
        import ray
    except ImportError as error:
        message = "expected the package ray, came none; install the extra: pip install 'c2nav[ray]'"
        raise MissingExtra(message) from error
    return ray
