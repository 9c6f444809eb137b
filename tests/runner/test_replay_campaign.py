"""Every built-in episode is reproduced by its trace, without the scene and with it."""

from __future__ import annotations

from pathlib import Path

import pytest

from c2nav_engine.experiments.spec import Setting, Task
from c2nav_engine.experiments.working import Simulating
from c2nav_engine.runner.recorded import read_trace
from c2nav_engine.runner.replaying import replay
from c2nav_engine.runner.reshell import shell_of
from c2nav_engine.traces import check, first_difference
from c2nav_engine.traces.reader import TraceFile
from c2nav_engine.world.builtin.source import builtin_source
from tests.helpers.exchanges import FakeEpisode, write_episode

EPISODES = [episode.episode_id for episode in builtin_source().episodes]
SETTING = Setting("builtin", ranker="random")
"""Guesses visit more of the method than good answers do: refusals, glances, walks back."""


def differences(path: Path, rewritten: Path) -> list[str]:
    """What of a trace is not reproduced; nothing is expected.

    The core, driven by the recorded answers, asks and notes the same; the scene gives back the
    same pictures, depth and motion; and these exchanges make the same messages.
    """
    trace = read_trace(path)
    shell = shell_of(trace.header, scenes=None)
    write_episode(rewritten, FakeEpisode(trace.header, trace.exchanges, trace.footer))
    with TraceFile(path) as first, TraceFile(rewritten) as second:
        apart = first_difference(first, second)
    found = (
        *check(path),
        replay(trace.header, trace.exchanges, trace.footer),
        replay(trace.header, trace.exchanges, trace.footer, shell=shell),
        apart,
    )
    return [str(difference) for difference in found if difference is not None]


@pytest.fixture(scope="module")
def simulating() -> Simulating:
    """Keeps each house for the episodes after the first in it."""
    return Simulating()


def test_a_hundred_episodes_are_built_in() -> None:
    assert len(EPISODES) == len(set(EPISODES)) == 100


@pytest.mark.slow
@pytest.mark.parametrize("episode", EPISODES)
def test_an_episode_is_reproduced(simulating: Simulating, tmp_path: Path, episode: str) -> None:
    task = Task(SETTING, episode, "full", 0)
    finished = simulating.work(task, tmp_path)
    assert finished is not None and not finished.error
    assert differences(task.trace(tmp_path), tmp_path / "again.mcap") == []
