"""Every executor against the conformance kit; the kit itself must bite."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from pathlib import Path

import pytest

from c2nav_engine.errors import InternalError, UsageError
from c2nav_engine.experiments.executors import conformance
from c2nav_engine.experiments.executors.agenda import MOST_DEATHS, Agenda
from c2nav_engine.experiments.executors.choosing import executor_for, lanes_of
from c2nav_engine.experiments.executors.conformance import (
    NotConforming,
    check_closing,
    check_every_task_once,
    check_lost_workers,
    obliging,
    tasks_of,
)
from c2nav_engine.experiments.executors.local import LocalExecutor
from c2nav_engine.experiments.executors.protocol import Executor, Started
from c2nav_engine.experiments.executors.slurm import SlurmExecutor
from c2nav_engine.experiments.spec import Setting, Task
from c2nav_engine.experiments.working import Finished


def slurm() -> Executor:
    return SlurmExecutor(2, cluster="local", tasks_a_job=3, poll_s=0.1, work=obliging)


IN_PROCESS: dict[str, Callable[[], Executor]] = {
    "one-worker": lambda: LocalExecutor(1, work=obliging),
    "one-worker-three-lanes": lambda: LocalExecutor(1, lanes=3, work=obliging),
}
APART: dict[str, Callable[[], Executor]] = {
    "two-workers": lambda: LocalExecutor(2, work=obliging),
    "two-workers-two-lanes": lambda: LocalExecutor(2, lanes=2, work=obliging),
    "slurm-local": slurm,
}


@pytest.mark.parametrize("name", [*IN_PROCESS, *APART])
def test_every_task_is_run_once(name: str, tmp_path: Path) -> None:
    check_every_task_once((IN_PROCESS | APART)[name](), tmp_path)


@pytest.mark.parametrize("name", APART)
def test_a_dead_worker_costs_no_task(name: str, tmp_path: Path) -> None:
    check_lost_workers(APART[name](), tmp_path)


@pytest.mark.parametrize("name", ["one-worker-three-lanes", *APART])
def test_closing_stops_the_workers(name: str, tmp_path: Path) -> None:
    check_closing((IN_PROCESS | APART)[name](), tmp_path)


def test_the_kit_bites(tmp_path: Path) -> None:
    class Twice:
        def run(
            self, tasks: Sequence[Task], folder: Path, *, started: Started
        ) -> Generator[Finished]:
            for task in [*tasks, *tasks]:
                started(task)
                finished = obliging(task, folder, lambda: False)
                assert finished is not None
                yield finished

    class Forgetful(LocalExecutor):
        def run(
            self, tasks: Sequence[Task], folder: Path, *, started: Started
        ) -> Generator[Finished]:
            yield from super().run(tasks[1:], folder, started=started)

    with pytest.raises(NotConforming, match="once"):
        check_every_task_once(Twice(), tmp_path / "a")
    with pytest.raises(NotConforming, match="once"):
        check_every_task_once(Forgetful(work=obliging), tmp_path / "b")


def test_workers_keep_to_their_scenes() -> None:
    agenda = Agenda(tasks_of(*[conformance.PLAIN] * 8, scenes=2))
    taken: dict[int, list[str]] = {0: [], 1: []}
    while agenda.open:
        for worker in taken:
            task = agenda.next(worker)
            assert task is not None
            taken[worker].append(task.scene_id)
            agenda.finished(worker, task.key)
    assert {frozenset(scenes) for scenes in taken.values()} == {
        frozenset({"scene0"}),
        frozenset({"scene1"}),
    }


def test_a_worker_without_a_scene_of_its_own_helps_with_another() -> None:
    agenda = Agenda(tasks_of(*[conformance.PLAIN] * 4, scenes=1))
    assert [agenda.next(worker) is not None for worker in (0, 1, 2, 3, 4)] == [True] * 4 + [False]


def test_workers_that_all_die_end_the_run() -> None:
    agenda = Agenda(tasks_of(*[conformance.PLAIN] * 50), attempts=3)
    with pytest.raises(InternalError, match="died one after the other"):
        for _ in range(MOST_DEATHS + 1):
            agenda.next(0)
            agenda.lost(0)


def test_only_rankers_that_wait_get_lanes() -> None:
    assert lanes_of(Setting("builtin", ranker="reference-cv")) == 1
    waiting = Setting("builtin", ranker="openai-chat", ranker_options={"concurrency": "5"})
    assert lanes_of(waiting) == 5


@pytest.mark.parametrize(
    ("name", "workers", "options", "message"),
    [
        ("lokal", 1, {}, "expected an executor"),
        ("local", 0, {}, "one or more workers"),
        ("local", 1, {"address": "auto"}, "no option address"),
        ("slurm", 1, {"tasks_a_job": "many"}, "tasks_a_job"),
    ],
)
def test_wrong_words_are_bad_usage(
    name: str, workers: int, options: dict[str, str], message: str
) -> None:
    with pytest.raises(UsageError, match=message):
        executor_for(name, Setting("builtin"), workers=workers, options=options)
