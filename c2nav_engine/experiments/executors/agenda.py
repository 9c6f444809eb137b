"""Which worker gets which task: tasks of one scene go to one worker while that keeps all busy."""

from __future__ import annotations

from collections.abc import Sequence

from c2nav_engine.errors import InternalError
from c2nav_engine.experiments.executors.protocol import ATTEMPTS, lost
from c2nav_engine.experiments.spec import Task
from c2nav_engine.experiments.working import Finished

MOST_DEATHS = 12
"""Workers that die in a row before the run is given up [C]."""

Worker = int
"""Names a worker within one executor."""


class Agenda:
    """Tasks still to be given out, and those under way by worker.

    A task that was under way when its worker died is suspect, and is given out alone from then
    on: whatever kills workers takes no bystander down twice.

    Args:
        tasks: What is to be run.
        attempts: Workers that may be lost to one task.
    """

    def __init__(self, tasks: Sequence[Task], *, attempts: int = ATTEMPTS) -> None:
        self._attempts = attempts
        self._waiting: dict[str, list[Task]] = {}
        for task in tasks:
            self._waiting.setdefault(task.scene_id, []).append(task)
        self._suspect: list[Task] = []
        self._under_way: dict[Worker, dict[str, Task]] = {}
        self._scene_of: dict[Worker, str] = {}
        self._tries: dict[str, int] = {}
        self._deaths_in_a_row = 0

    @property
    def open(self) -> bool:
        """Whether anything waits or is under way."""
        return bool(self._waiting or self._suspect) or any(self._under_way.values())

    def under_way(self, worker: Worker) -> int:
        """Tasks that the worker is at."""
        return len(self._under_way.get(worker, {}))

    def next(self, worker: Worker) -> Task | None:
        """The worker's next task: of its own scene, else of the one that needs it most."""
        at = self._under_way.setdefault(worker, {})
        if any(self._tries[key] > 1 for key in at):
            return None
        if self._suspect and not at:
            return self._give(worker, self._suspect.pop(0))
        scene = self._scene_for(worker)
        if scene is None:
            return None
        task = self._waiting[scene].pop(0)
        if not self._waiting[scene]:
            del self._waiting[scene]
        return self._give(worker, task)

    def _give(self, worker: Worker, task: Task) -> Task:
        self._scene_of[worker] = task.scene_id
        self._under_way[worker][task.key] = task
        self._tries[task.key] = self._tries.get(task.key, 0) + 1
        return task

    def finished(self, worker: Worker, key: str) -> None:
        """The worker handed a task back."""
        self._deaths_in_a_row = 0
        self._under_way[worker].pop(key, None)

    def finished_anywhere(self, key: str) -> None:
        """As `finished`, where results do not say who worked on them."""
        for worker, tasks in self._under_way.items():
            if key in tasks:
                self.finished(worker, key)

    def lost(self, worker: Worker) -> list[Finished]:
        """The worker died: its tasks wait again; those that used up their attempts come back.

        Raises:
            InternalError: Workers die one after the other and none finishes anything.
        """
        self._deaths_in_a_row += 1
        if self._deaths_in_a_row > MOST_DEATHS:
            message = (
                f"{self._deaths_in_a_row} workers died one after the other and none finished a "
                "task; run one task with --workers 1 --debug to see why"
            )
            raise InternalError(message)
        given_up: list[Finished] = []
        for task in self._under_way.pop(worker, {}).values():
            if self._tries[task.key] >= self._attempts:
                given_up.append(lost(task, self._attempts))
            else:
                self._suspect.append(task)
        self._scene_of.pop(worker, None)
        return given_up

    def _scene_for(self, worker: Worker) -> str | None:
        own = self._scene_of.get(worker)
        if own in self._waiting:
            return own
        others = [scene for name, scene in self._scene_of.items() if name != worker]
        # A scene that nobody holds first; then the one with most left for each who holds it.
        return max(
            self._waiting,
            key=lambda scene: (
                scene not in others,
                len(self._waiting[scene]) / (1 + others.count(scene)),
            ),
            default=None,
        )
