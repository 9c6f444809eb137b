"""Results by way of the run folder, for workers that outlive whoever started them."""

from __future__ import annotations

import json
import time
import uuid
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path

from c2nav_engine.experiments.executors.lanes import run_here
from c2nav_engine.experiments.spec import Task
from c2nav_engine.experiments.working import Finished, Stopping, Work

OWNER_CHECK_S = 1.0
"""How often a job looks whether it is still wanted."""


class Inbox:
    """Finished tasks as files, one each, and the name of the run that wants them.

    Args:
        folder: `RUN/jobs`, on a disk that coordinator and jobs share.
    """

    def __init__(self, folder: Path) -> None:
        self._results = folder / "finished"
        self._owner = folder / "owner"

    def open(self) -> str:
        """Take the inbox over: jobs of an earlier coordinator stop; returns the new owner."""
        self._results.mkdir(parents=True, exist_ok=True)
        owner = uuid.uuid4().hex
        _write(self._owner, owner)
        return owner

    def close(self) -> None:
        """Want no more results: jobs that still run stop."""
        self._owner.unlink(missing_ok=True)

    @property
    def was_owned(self) -> bool:
        """Whether an earlier coordinator may have left jobs behind."""
        return self._owner.is_file()

    def owned_by(self, owner: str) -> bool:
        """Whether that coordinator still wants results."""
        try:
            return self._owner.read_text(encoding="utf-8") == owner
        except OSError:
            return False

    def put(self, finished: Finished) -> None:
        """Hand a task back, whole or not at all."""
        _write(self._results / f"{finished.key}.json", json.dumps(asdict(finished)))

    def take(self) -> Iterator[Finished]:
        """Everything that was handed back since, each once."""
        for path in sorted(self._results.glob("*.json")):
            facts = json.loads(path.read_text(encoding="utf-8"))
            path.unlink()
            yield Finished(**facts)


def work_through(tasks: Sequence[Task], folder: Path, owner: str, *, lanes: int, work: Work) -> int:
    """A job: run tasks one after the other and hand each back; returns how many.

    It stops between two exchanges once another coordinator has taken the inbox over.
    """
    inbox = Inbox(folder / "jobs")
    stop = _no_longer(inbox, owner)

    def heeding(task: Task, run: Path, _stop: Stopping) -> Finished | None:
        return None if stop() else work(task, run, stop)

    count = 0
    for finished in run_here(tasks, folder, lanes=lanes, work=heeding, started=lambda _task: None):
        if stop():
            break
        inbox.put(finished)
        count += 1
    return count


def _no_longer(inbox: Inbox, owner: str) -> Stopping:
    """Whether the owner changed, looked up once a second at most."""
    looked_s = -OWNER_CHECK_S
    unwanted = False

    def stop() -> bool:
        nonlocal looked_s, unwanted
        now_s = time.monotonic()
        if not unwanted and now_s - looked_s >= OWNER_CHECK_S:
            looked_s, unwanted = now_s, not inbox.owned_by(owner)
        return unwanted

    return stop


def _write(path: Path, text: str) -> None:
    part = path.with_name(f"{path.name}.{uuid.uuid4().hex[:8]}.part")
    part.write_text(text, encoding="utf-8")
    part.replace(path)
