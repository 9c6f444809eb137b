"""Turning points: one planted wrong answer is named, an unstable ranker is not a turning point.

The observer is noiseless, so nothing else goes wrong; the step budget is exactly what the flawless
episode needs, so a detour cannot be made up for.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.contract.question import Slot
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.experiments.rankers import seats_for
from c2nav_engine.experiments.turning.flips import TURNING, UNSTABLE, Budget, Flip, flips_of
from c2nav_engine.experiments.turning.moments import Recording, going_on, recording_of
from c2nav_engine.experiments.turning.recoverable import NOISELESS, last_recoverable
from c2nav_engine.experiments.turning.regrets import regrets_of
from c2nav_engine.experiments.turning.table import flip_row, read_table, verdict_of, write_table
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.episode_run import EpisodeRun, run_to_end
from c2nav_engine.runner.exchange import Override
from c2nav_engine.runner.opening import OpenSpec, Workbench
from c2nav_engine.runner.recorded import read_trace
from c2nav_engine.runner.recording import TraceWriter
from c2nav_engine.runner.source import open_source
from c2nav_engine.runner.worlds import Worlds, WorldsConfig

ONCE = Budget(repeats=1)


def bench(max_steps: int) -> Workbench:
    source = open_source("builtin")
    profile = replace(VLNCE, max_steps=max_steps)
    return Workbench(
        source=source,
        worlds=Worlds(source, WorldsConfig(profile)),
        profile=profile,
        seat_for=seats_for("simulated", NOISELESS),
        recorder_for=TraceWriter,
    )


def planted(episode_id: str, folder: Path) -> tuple[Recording, int]:
    """An episode that fails by one wrong election, and that election's number."""
    flawless = bench(500).open(OpenSpec(episode_id))
    metrics = run_to_end(flawless).metrics
    assert metrics["success"] == 1
    short = bench(int(metrics["steps"] or 0))
    # A detour next to the goal may still end within its radius, so elections are tried in turn.
    for nth in range(2, 12):
        path = folder / f"{episode_id}.{nth}.mcap"
        run = short.open(OpenSpec(episode_id, trace=path))
        wrong = _plant(run, nth)
        if run_to_end(run).metrics["success"] == 0:
            return recording_of(read_trace(path), scenes=None), wrong
    message = f"no election of episode {episode_id} spoils it alone"
    raise AssertionError(message)


def _plant(run: EpisodeRun, nth: int) -> int:
    """Turn away from the right view once, at the first chance from the nth election on."""
    seen = 0
    while run.footer is None:
        ask = run.pending
        if isinstance(ask, Ask) and ask.question.slot is Slot.SEEING:
            right = run.propose().outcome
            keys = ask.question.keys
            seen += 1
            if seen >= nth and isinstance(right, Ordering) and right.winner == "front":
                other = next(key for key in keys if key != "front")
                exchange = run.commit(Override(Ordering.winner_only(other, keys), "test"))
                assert exchange.decision is not None
                return exchange.decision
        run.advance()
    message = "the episode offered no election to spoil"
    raise AssertionError(message)


@pytest.fixture(scope="module")
def spoilt(tmp_path_factory) -> tuple[Recording, int]:
    return planted("1", tmp_path_factory.mktemp("turning"))


@pytest.mark.slow
def test_regret_names_the_planted_answer_first(spoilt):
    recording, wrong = spoilt
    worst = min(regrets_of(recording), key=lambda regret: regret.weight)
    assert worst.decision == wrong
    assert worst.regret_m is not None
    assert worst.regret_m > 0.3


@pytest.mark.slow
def test_changing_the_planted_answer_alone_succeeds_beside_a_failing_control(spoilt):
    recording, wrong = spoilt
    seats = seats_for("simulated", NOISELESS)
    flips = list(
        flips_of(recording, [wrong], seats, budget=ONCE, known=lambda _decision, _answer: False)
    )
    front = next(flip for flip in flips if flip.answer == "front")
    assert (front.changed, front.control, front.verdict) == (1, 0, TURNING)


@pytest.mark.slow
def test_what_was_tried_is_not_tried_again(spoilt):
    recording, wrong = spoilt
    seats = seats_for("simulated", NOISELESS)
    known = list(
        flips_of(recording, [wrong], seats, budget=ONCE, known=lambda _decision, _answer: True)
    )
    assert known == []


@pytest.mark.slow
def test_no_further_answer_is_tried_once_the_queries_are_spent(spoilt):
    recording, wrong = spoilt
    budget = Budget(repeats=1, max_queries=0)
    seats = seats_for("simulated", NOISELESS)
    tried = flips_of(recording, [wrong], seats, budget=budget, known=lambda _d, _a: False)
    assert list(tried) == []


@pytest.mark.slow
def test_the_last_recoverable_decision_is_not_past_the_planted_one(spoilt):
    recording, wrong = spoilt
    found = last_recoverable(recording)
    assert found.decision is not None
    assert found.decision <= wrong
    assert found.tried[found.decision]


@pytest.mark.slow
def test_going_on_without_a_change_reproduces_the_record(spoilt):
    recording, wrong = spoilt
    after = next(e for e in recording.questions if (e.decision or 0) > wrong)
    assert after.decision is not None
    again = going_on(recording, after.decision, seats_for("simulated", NOISELESS))
    run_to_end(again)
    assert again.footer is not None
    assert again.footer.outcome is recording.footer.outcome
    assert [type(e.request) for e in again.exchanges] == [
        type(e.request) for e in recording.exchanges
    ]


def test_a_flip_counts_only_beside_its_control():
    base = Flip(3, Slot.SEEING, "left", changed=3, control=0, repeats=3, queries=9)
    assert base.verdict == TURNING
    assert replace(base, control=1).verdict == UNSTABLE
    assert replace(base, changed=2).verdict == UNSTABLE
    assert replace(base, changed=0).verdict == "no success"


@pytest.mark.slow
def test_the_table_is_read_back_and_says_what_the_episode_was(spoilt, tmp_path):
    recording, wrong = spoilt
    flip = Flip(wrong, Slot.SEEING, "front", changed=1, control=0, repeats=1, queries=4)
    rows = [flip_row(recording, flip)]
    write_table(rows, tmp_path / "turning.parquet")
    assert read_table(tmp_path / "turning.parquet") == rows
    assert verdict_of(rows) == TURNING


@pytest.mark.slow
@pytest.mark.parametrize("episode_id", [str(number) for number in range(2, 21)])
def test_the_planted_answer_is_named_in_nineteen_more(episode_id, tmp_path):
    recording, wrong = planted(episode_id, tmp_path)
    assert min(regrets_of(recording), key=lambda regret: regret.weight).decision == wrong
    seats = seats_for("simulated", NOISELESS)
    flips = flips_of(recording, [wrong], seats, budget=ONCE, known=lambda _d, _a: False)
    assert any(flip.verdict == TURNING for flip in flips)
