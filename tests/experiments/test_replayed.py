"""`replay`: the same answers to the same requests, and a named error for any other."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.contract.question import Slot
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.errors import RankerUnavailable, UsageError
from c2nav_engine.experiments.rankers import ranker_for, seats_for
from c2nav_engine.experiments.replayed import Recordings, answers_of
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.episode_run import EpisodeRun, run_to_end
from c2nav_engine.runner.exchange import Exchange, Override
from c2nav_engine.runner.opening import OpenSpec, Workbench
from c2nav_engine.runner.record import EpisodeOutcome
from c2nav_engine.runner.recorded import open_trace, read_trace
from c2nav_engine.runner.recording import TraceWriter
from c2nav_engine.runner.replaying import difference
from tests.helpers.benches import workbench
from tests.helpers.exchanges import fake_episode

SHORT = replace(VLNCE, max_steps=12)


@pytest.fixture(scope="module")
def bench() -> Workbench:
    return workbench(profile=SHORT)


@pytest.fixture(scope="module")
def run_folder(bench: Workbench, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two seeds of one episode."""
    folder = tmp_path_factory.mktemp("recorded")
    for seed in (0, 1):
        run_to_end(bench.open(OpenSpec("1", seed=seed, trace=trace_of(folder, seed))))
    return folder


def trace_of(folder: Path, seed: int) -> Path:
    return folder / "traces" / f"1.full.{seed}.mcap"


def replaying(bench: Workbench, folder: Path) -> Workbench:
    return replace(bench, seat_for=seats_for("replay", {"trace": str(folder)}))


def told(run: EpisodeRun) -> tuple[Exchange, ...]:
    """Exchanges without the clock and without who answered."""
    return tuple(replace(exchange, wall_s={}, ranked=None) for exchange in run.exchanges)


@pytest.mark.parametrize("seed", [0, 1])
def test_a_replayed_run_is_the_recorded_one(bench: Workbench, run_folder: Path, seed: int):
    again = replaying(bench, run_folder).open(OpenSpec("1", seed=seed))
    run_to_end(again)
    recorded = read_trace(trace_of(run_folder, seed))
    before = tuple(replace(exchange, wall_s={}, ranked=None) for exchange in recorded.exchanges)
    assert difference(before, told(again)) is None
    assert again.header.ranker == "replay:random"


def test_what_was_never_asked_ends_the_episode_and_is_named(bench: Workbench, run_folder: Path):
    other = replaying(bench, run_folder).open(OpenSpec("2"))
    with pytest.raises(RankerUnavailable, match=r"not in the record: request [0-9a-f]{12}"):
        run_to_end(other)
    assert other.footer is not None
    assert other.footer.outcome is EpisodeOutcome.ERROR
    assert "not in the record" in other.footer.error


def test_a_person_s_answer_is_what_was_committed(bench: Workbench):
    run = bench.open(OpenSpec("1"))
    while not isinstance(run.pending, Ask):
        run.advance()
    asked = run.pending.question
    run.propose()
    said = Ordering.winner_only(asked.keys[-1], asked.keys)
    run.commit(Override(said, "p1"))
    run.close()
    answers = answers_of(run.exchanges)
    assert {reply.outcome for (reply,) in answers.values()} == {said}
    assert asked.slot is Slot.SEEING


def test_recorded_questions_are_answered_from_the_record(run_folder: Path):
    ranker = ranker_for("replay", {"trace": str(trace_of(run_folder, 0))})
    with open_trace(trace_of(run_folder, 0)) as trace:
        first = next(e for e in trace.decisions() if isinstance(e.request, Ask))
    assert isinstance(first.request, Ask)
    assert ranker.rank(first.request.question).outcome == first.response


@pytest.mark.parametrize("options", [{}, {"trace": "/nowhere"}, {"trace": "x", "seed": "1"}])
def test_a_missing_record_is_a_usage_error(options: dict[str, str]):
    with pytest.raises(UsageError, match="replay"):
        seats_for("replay", options)


def test_the_answers_of_one_who_knows_the_truth_are_not_replayed(tmp_path: Path):
    episode = fake_episode(1, side_px=16)
    path = tmp_path / "told.mcap"
    with TraceWriter(path, replace(episode.header, privileged=True)) as writer:
        for exchange in episode.exchanges:
            writer.write(exchange)
        writer.finish(episode.footer)
    with pytest.raises(UsageError, match="does not know the truth"):
        Recordings({"trace": str(path)})
