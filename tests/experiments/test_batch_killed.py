"""`kill -9` of the run and of single workers: a resumed run finishes exactly what is missing."""

from __future__ import annotations

import os
import random
import signal
import sqlite3
import subprocess
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import psutil
import pytest

from c2nav_engine.experiments.columns import read_rows
from c2nav_engine.experiments.ledger import states_of
from tests.helpers.batch_work import batch_process, ends, stand_in_spec

TASKS = 12
PATIENCE_S = 120.0


def done_names(folder: Path) -> set[str]:
    """Episodes that the ledger calls done."""
    with closing(sqlite3.connect(folder / "ledger.sqlite")) as ledger:
        rows = ledger.execute("select name from tasks where state = 'done'").fetchall()
    return {name.split(".")[0] for (name,) in rows}


def wait_until(true: Callable[[], bool], process: subprocess.Popen[bytes]) -> None:
    until_s = time.monotonic() + PATIENCE_S
    while not true() and process.poll() is None:
        assert time.monotonic() < until_s, "the run does not get on"
        time.sleep(0.02)


def done(folder: Path) -> int:
    ledger = folder / "ledger.sqlite"
    try:
        return states_of(ledger).get("done", 0) if ledger.is_file() else 0
    except sqlite3.OperationalError:  # being made at this moment
        return 0


def workers_of(process: subprocess.Popen[bytes]) -> list[psutil.Process]:
    """Spawned workers; Python's resource tracker is no worker."""
    children = psutil.Process(process.pid).children()
    return [child for child in children if "spawn_main" in " ".join(child.cmdline())]


def finish(folder: Path, workers: int) -> None:
    process = batch_process(folder, workers=workers)
    assert process.wait(PATIENCE_S) == 0, (folder.parent / "log").read_text(encoding="utf-8")
    spec = stand_in_spec()
    assert states_of(folder / "ledger.sqlite") == {"done": TASKS}
    assert [row["episode_id"] for row in read_rows(folder)] == list(spec.episodes)
    assert not list((folder / "traces").glob("*.part"))
    assert len(list((folder / "traces").glob("*.mcap"))) == TASKS


def kill_run(folder: Path, *, after: int, workers: int) -> None:
    """Kill the run at once after so many tasks, and see that its workers die with it."""
    process = batch_process(folder, workers=workers)
    wait_until(lambda: done(folder) >= after, process)
    if process.poll() is not None:
        return
    crew = workers_of(process)
    process.send_signal(signal.SIGKILL)
    process.wait()
    gone, left = psutil.wait_procs(crew, timeout=PATIENCE_S)
    assert not left and len(gone) == len(crew)


@pytest.mark.parametrize(("after", "workers"), [(2, 2), (5, 1)])
def test_a_killed_run_is_resumed_without_doing_anything_twice(
    tmp_path: Path, after: int, workers: int
) -> None:
    folder = tmp_path / "run"
    kill_run(folder, after=after, workers=workers)
    kept = done_names(folder)
    assert len(kept) >= after
    before = ends(folder)
    finish(folder, workers)
    assert {name: ends(folder)[name] for name in kept} == {name: before[name] for name in kept}


def test_killed_workers_cost_no_task_and_need_no_resume(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    process = batch_process(folder, workers=2)
    for after in (1, 4):
        wait_until(lambda least=after: done(folder) >= least and bool(workers_of(process)), process)
        workers_of(process)[0].kill()
    assert process.wait(PATIENCE_S) == 0
    assert states_of(folder / "ledger.sqlite") == {"done": TASKS}
    assert set(ends(folder)) == set(stand_in_spec().episodes)


def test_an_interrupt_keeps_what_is_finished_and_writes_the_tables(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    process = batch_process(folder, workers=2)
    wait_until(lambda: done(folder) >= 3, process)
    os.killpg(process.pid, signal.SIGINT)  # as Ctrl-C does: the whole group
    process.wait(PATIENCE_S)
    assert len(read_rows(folder)) == done(folder) >= 3
    finish(folder, 2)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_killed_at_a_random_moment(tmp_path: Path, seed: int) -> None:
    draw = random.Random(seed)
    folder = tmp_path / "run"
    process = batch_process(folder, workers=2)
    wait_until(lambda: folder.is_dir(), process)
    time.sleep(draw.uniform(0.0, 8.0))
    victims = [process.pid, *(worker.pid for worker in workers_of(process))]
    if process.poll() is None:
        os.kill(draw.choice(victims), signal.SIGKILL)
        if draw.random() < 0.5:
            process.kill()
    process.wait(PATIENCE_S)
    finish(folder, 2)
    assert set(ends(folder)) == set(stand_in_spec().episodes)
