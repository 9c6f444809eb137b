"""Executors by name, as the command line says them."""

from __future__ import annotations

from collections.abc import Mapping

from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.asking import asking_from
from c2nav_engine.experiments.executors.local import LocalExecutor
from c2nav_engine.experiments.executors.protocol import Executor
from c2nav_engine.experiments.executors.ray_cluster import RayExecutor
from c2nav_engine.experiments.executors.slurm import TASKS_A_JOB, SlurmExecutor
from c2nav_engine.experiments.rankers import RANKERS
from c2nav_engine.experiments.spec import Setting
from c2nav_engine.rankers.options import OptionReader

EXECUTORS = ("local", "ray", "slurm")


def lanes_of(setting: Setting) -> int:
    """Episodes at once in one worker: as many as queries may be under way, if the ranker waits."""
    if not RANKERS[setting.ranker].remote:
        return 1
    asking, _ = asking_from(setting.ranker_options)
    return asking.concurrency


def executor_for(
    name: str, setting: Setting, *, workers: int, options: Mapping[str, str] | None = None
) -> Executor:
    """The named executor.

    Args:
        name: One of `EXECUTORS`.
        setting: The run's; a ranker that waits gets several episodes a worker.
        workers: Processes, actors or jobs at once.
        options: `address` (ray); `cluster`, `tasks_a_job` and submitit's parameters (slurm).

    Raises:
        UsageError: No such executor, option, or fewer than one worker.
    """
    if workers < 1:
        message = f"expected one or more workers, came {workers}"
        raise UsageError(message)
    lanes, given = lanes_of(setting), dict(options or {})
    if name == "slurm":
        cluster = given.pop("cluster", "slurm")
        reader = OptionReader("slurm", {"tasks_a_job": given.pop("tasks_a_job", "")})
        return SlurmExecutor(
            workers,
            lanes=lanes,
            cluster=cluster,
            options=given,
            tasks_a_job=max(1, reader.integer("tasks_a_job", TASKS_A_JOB)),
        )
    if name == "ray":
        address = given.pop("address", "")
        _none_left(name, given)
        return RayExecutor(workers, lanes=lanes, address=address)
    if name == "local":
        _none_left(name, given)
        return LocalExecutor(workers, lanes=lanes)
    message = f"expected an executor ({', '.join(EXECUTORS)}), came {name!r}"
    raise UsageError(message)


def _none_left(name: str, options: Mapping[str, str]) -> None:
    if options:
        message = f"the executor {name} has no option {', '.join(sorted(options))}"
        raise UsageError(message)
