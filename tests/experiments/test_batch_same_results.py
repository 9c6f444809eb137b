"""The same specs give the same rows wherever they run, but for what the wall clock says."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from c2nav_engine.experiments.batch import run_batch
from c2nav_engine.experiments.columns import COLUMNS, WALL_COLUMNS, read_rows
from c2nav_engine.experiments.executors.conformance import (
    check_closing,
    check_lost_workers,
    obliging,
)
from c2nav_engine.experiments.executors.local import LocalExecutor
from c2nav_engine.experiments.executors.protocol import Executor
from c2nav_engine.experiments.executors.ray_cluster import RayExecutor
from c2nav_engine.experiments.executors.slurm import SlurmExecutor
from c2nav_engine.experiments.spec import RunSpec, Setting
from c2nav_engine.runner.recorded import open_trace
from c2nav_engine.world.builtin.source import builtin_source
from tests.helpers.runs import Row


def spec() -> RunSpec:
    """An episode in each of two built-in houses, the second one first."""
    by_scene: dict[str, list[str]] = {}
    for episode in builtin_source().episodes:
        by_scene.setdefault(episode.scene_id, []).append(episode.episode_id)
    scenes = tuple(by_scene)[1::-1]
    ids = tuple(by_scene[scene][0] for scene in scenes)
    return RunSpec(Setting("builtin"), ids, ("full",), (0,), scenes)


def without_wall(folder: Path) -> list[Row]:
    return [{n: row[n] for n in COLUMNS if n not in WALL_COLUMNS} for row in read_rows(folder)]


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> list[Row]:
    """One worker in this process, two episodes at once."""
    folder = tmp_path_factory.mktemp("local") / "run"
    run_batch(spec(), folder, LocalExecutor(1, lanes=2))
    rows = without_wall(folder)
    assert all(row["outcome"] != "error" and row["steps"] for row in rows)
    assert len({str(row["ne_m"]) for row in rows}) == len(rows)
    return rows


@pytest.mark.parametrize(
    "make",
    [
        pytest.param(lambda: LocalExecutor(2), id="two-workers"),
        pytest.param(lambda: SlurmExecutor(2, cluster="local", tasks_a_job=1), id="slurm-local"),
    ],
)
def test_rows_do_not_depend_on_where_they_come_from(
    expected: list[Row], make: Callable[[], Executor], tmp_path: Path
) -> None:
    result = run_batch(spec(), tmp_path / "run", make())
    assert without_wall(tmp_path / "run") == expected
    for row in result.rows:
        path = tmp_path / "run" / "traces" / f"{row['episode_id']}.full.0.mcap"
        with open_trace(path) as trace:
            assert trace.complete and trace.sha256 == row["trace_sha256"]


@pytest.fixture(scope="module")
def cluster() -> Any:
    """A local Ray for all of these tests: it takes ten seconds to start."""
    ray: Any = pytest.importorskip("ray")
    RayExecutor(2)._connect(ray)
    yield ray
    ray.shutdown()


# Ray leaves sockets and files of its own for the collector.
@pytest.mark.filterwarnings("ignore::ResourceWarning")
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.filterwarnings("ignore::FutureWarning")
class TestRay:
    def test_it_conforms(self, cluster: Any, tmp_path: Path) -> None:
        for place, check in enumerate((check_lost_workers, check_closing)):
            check(RayExecutor(2, work=obliging), tmp_path / str(place))

    def test_rows_do_not_depend_on_where_they_come_from(
        self, cluster: Any, expected: list[Row], tmp_path: Path
    ) -> None:
        run_batch(spec(), tmp_path / "run", RayExecutor(2))
        assert without_wall(tmp_path / "run") == expected
