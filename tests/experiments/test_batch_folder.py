"""A run folder: what is missing is run, what is done stays, and nobody else's run is touched."""

from __future__ import annotations

import csv
import json
from collections.abc import Generator, Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from filelock import FileLock

from c2nav_engine.errors import RankerStopped, UsageError
from c2nav_engine.experiments.batch import Standing, run_batch
from c2nav_engine.experiments.columns import COLUMNS, read_rows
from c2nav_engine.experiments.executors.conformance import obliging, tries
from c2nav_engine.experiments.executors.local import LocalExecutor
from c2nav_engine.experiments.executors.protocol import Started
from c2nav_engine.experiments.ledger import states_of
from c2nav_engine.experiments.spec import RunSpec, Setting, Task
from c2nav_engine.experiments.working import Finished, Stopping

SPEC = RunSpec(
    setting=Setting("builtin", ranker="scripted"),
    episodes=("4", "1", "3"),
    variants=("no-arriving", "full", "seeing-remembering"),
    seeds=(0,),
    scenes=("a", "b", "a"),
)
DISTINCT = 6


def executor() -> LocalExecutor:
    return LocalExecutor(work=obliging)


class Breaking:
    """Hands back a few results, then something happens."""

    def __init__(self, after: int, what: BaseException) -> None:
        self.after, self.what = after, what

    def run(self, tasks: Sequence[Task], folder: Path, *, started: Started) -> Generator[Finished]:
        running = LocalExecutor(work=obliging).run(tasks, folder, started=started)
        for place, finished in enumerate(running):
            if place == self.after:
                raise self.what
            yield finished


def ran(folder: Path, spec: RunSpec = SPEC) -> dict[str, int]:
    """Tries by episode, over all variants."""
    return {episode: tries(folder, task(spec, episode)) for episode in spec.episodes}


def task(spec: RunSpec, episode: str) -> Task:
    return next(each for each in spec.tasks() if each.episode_id == episode)


def test_rows_stand_in_the_order_of_the_spec_under_every_name(tmp_path: Path) -> None:
    result = run_batch(SPEC, tmp_path / "run", executor())
    expected = [(v, e) for v in SPEC.variants for e in SPEC.episodes]
    assert [(row["variant"], row["episode_id"]) for row in result.rows] == expected
    assert [(r["variant"], r["episode_id"]) for r in read_rows(tmp_path / "run")] == expected
    assert states_of(tmp_path / "run" / "ledger.sqlite") == {"done": DISTINCT}
    # Two configurations, one of them under two names: two tries an episode.
    assert set(ran(tmp_path / "run").values()) == {2}


def test_the_csv_has_the_agreed_columns_and_one_line_a_row(tmp_path: Path) -> None:
    run_batch(SPEC, tmp_path / "run", executor())
    lines = (tmp_path / "run" / "episodes.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == ",".join(COLUMNS)
    assert len(lines) == 1 + len(SPEC.variants) * len(SPEC.episodes)
    assert next(csv.DictReader(lines))["ne_m"] == ""


@pytest.mark.parametrize("after", [0, 1, 4])
@pytest.mark.parametrize("what", [KeyboardInterrupt(), RuntimeError("a bug")])
def test_whatever_breaks_the_run_the_rest_is_finished_later(
    tmp_path: Path, after: int, what: BaseException
) -> None:
    folder = tmp_path / "run"
    with pytest.raises(type(what)):
        run_batch(SPEC, folder, Breaking(after, what))
    assert states_of(folder / "ledger.sqlite").get("done", 0) == after
    rows = read_rows(folder)
    assert all(row["outcome"] == "stopped" for row in rows)
    result = run_batch(SPEC, folder, executor(), resume=True)
    assert len(result.rows) == 9
    assert states_of(folder / "ledger.sqlite") == {"done": DISTINCT}
    # The one that was under way when it broke is run again; nothing that was done is.
    assert sum(ran(folder).values()) == DISTINCT + 1


def test_an_exhausted_ranker_stops_the_run_and_is_resumed_with_a_larger_budget(
    tmp_path: Path,
) -> None:
    def stops(task: Task, folder: Path, stop: Stopping) -> Finished | None:
        if task.episode_id == "3":
            return replace(Finished.failed(task, "the budget is used up"), stops=True)
        return obliging(task, folder, stop)

    folder = tmp_path / "run"
    spec = replace(SPEC, setting=replace(SPEC.setting, ranker_options={"max_queries": "5"}))
    with pytest.raises(RankerStopped, match="budget"):
        run_batch(spec, folder, LocalExecutor(work=stops))
    more = replace(spec, setting=replace(spec.setting, ranker_options={"max_queries": "500"}))
    result = run_batch(more, folder, executor(), resume=True)
    assert len(result.rows) == 9 and not result.errors


def test_failed_tasks_are_taken_up_again(tmp_path: Path) -> None:
    def fails(task: Task, folder: Path, stop: Stopping) -> Finished | None:
        return (
            Finished.failed(task, "no answer")
            if task.episode_id == "1"
            else obliging(task, folder, stop)
        )

    folder = tmp_path / "run"
    result = run_batch(SPEC, folder, LocalExecutor(work=fails))
    assert set(result.errors.values()) == {"no answer"} and len(result.errors) == 2
    assert sum(row["outcome"] == "error" for row in result.rows) == 3
    again = run_batch(SPEC, folder, executor(), resume=True)
    assert not again.errors
    assert ran(folder) == {"4": 2, "1": 2, "3": 2}


def test_a_folder_is_not_shared_by_accident(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    run_batch(SPEC, folder, executor())
    with pytest.raises(UsageError, match="--resume"):
        run_batch(SPEC, folder, executor())
    with pytest.raises(UsageError, match="another run"):
        run_batch(replace(SPEC, seeds=(1,)), folder, executor(), resume=True)
    with FileLock(folder / ".lock"), pytest.raises(UsageError, match="in use"):
        run_batch(SPEC, folder, executor(), resume=True)


def test_episodes_that_changed_under_a_run_are_noticed(tmp_path: Path, shared: Path) -> None:
    source = tmp_path / "episodes.json.gz"
    source.write_bytes((shared / "data/furnished_house_8.json.gz").read_bytes())
    spec = replace(SPEC, setting=replace(SPEC.setting, source=str(source)))
    run_batch(spec, tmp_path / "run", executor())
    source.write_bytes((shared / "data/OpenNav_R2R-CE_100_bertidx.json.gz").read_bytes())
    with pytest.raises(UsageError, match="other episodes"):
        run_batch(spec, tmp_path / "run", executor(), resume=True)


def test_progress_starts_where_the_last_sitting_ended(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    with pytest.raises(KeyboardInterrupt):
        run_batch(SPEC, folder, Breaking(4, KeyboardInterrupt()))
    heard: list[Standing] = []
    run_batch(SPEC, folder, executor(), resume=True, progress=heard.append)
    assert [standing.done for standing in heard] == [4, 5, 6]
    assert heard[-1].successes == heard[-1].total == DISTINCT


def test_the_manifest_says_what_decides_the_run(tmp_path: Path) -> None:
    run_batch(SPEC, tmp_path / "run", executor())
    manifest = json.loads((tmp_path / "run" / "manifest.json").read_text(encoding="utf-8"))
    hashes = {name: facts["sha256"] for name, facts in manifest["variants"].items()}
    assert hashes["no-arriving"] == hashes["seeing-remembering"] != hashes["full"]
    assert manifest["source"] == "builtin" and len(manifest["source_sha256"]) == 64
    assert manifest["privileged"] is False
    assert manifest["profile"]["name"] == "vlnce"


def test_a_bug_in_one_episode_is_that_episodes_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from c2nav_engine.experiments import working

    def broken(setting: Setting, run: Path) -> object:
        raise ZeroDivisionError("a bug")

    monkeypatch.setattr(working, "workbench_of", broken)
    finished = working.Simulating().work(SPEC.tasks()[0], tmp_path)
    assert finished is not None
    assert finished.error.startswith("unexpected ZeroDivisionError: a bug")
    assert finished.row["outcome"] == "error"
