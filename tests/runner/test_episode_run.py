"""A built-in episode for real: determinism, replay with and without the scene, overrides, forks."""

from __future__ import annotations

from dataclasses import replace

import pytest

from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.contract.question import Slot
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.errors import StartError, UsageError
from c2nav_engine.geometry import Pose
from c2nav_engine.navigator.requests import Ask, Look, Move, Moved, Seen
from c2nav_engine.runner.episode_run import EpisodeRun, run_to_end
from c2nav_engine.runner.exchange import Exchange, Override
from c2nav_engine.runner.opening import OpenSpec, Workbench, start_on
from c2nav_engine.runner.record import EpisodeOutcome
from c2nav_engine.runner.recorded import read_trace
from c2nav_engine.runner.replaying import difference, replay
from c2nav_engine.runner.reshell import shell_of
from c2nav_engine.sensing.noise import NoiseConfig
from tests.helpers.audit import faults_of
from tests.helpers.benches import workbench

SHORT = replace(VLNCE, max_steps=24)


@pytest.fixture(scope="module")
def bench() -> Workbench:
    return workbench(profile=SHORT)


@pytest.fixture(scope="module")
def recorded(bench, tmp_path_factory):
    path = tmp_path_factory.mktemp("run") / "1.mcap"
    run = bench.open(OpenSpec("1", trace=path))
    run_to_end(run)
    return run, path


def still(exchanges: list[Exchange]) -> list[Exchange]:
    """Exchanges without wall-clock facts."""
    return [replace(exchange, wall_s={}, ranked=None) for exchange in exchanges]


def ask_of(exchange: Exchange) -> Ask:
    assert isinstance(exchange.request, Ask)
    return exchange.request


def number_of(exchange: Exchange) -> int:
    assert exchange.decision is not None
    return exchange.decision


def at_question(run: EpisodeRun, slot: Slot = Slot.SEEING) -> Ask:
    while not (isinstance(run.pending, Ask) and run.pending.question.slot is slot):
        run.advance()
    return run.pending


def test_the_same_episode_and_seed_give_the_same_exchanges(bench, recorded):
    run, _ = recorded
    again = bench.open(OpenSpec("1"))
    run_to_end(again)
    assert difference(tuple(still(run.exchanges)), tuple(still(again.exchanges))) is None


def test_the_step_budget_counts_every_action_and_ends_without_a_stop(recorded):
    run, _ = recorded
    assert run.footer.outcome is EpisodeOutcome.STEP_LIMIT
    assert run.footer.metrics["steps"] == SHORT.max_steps
    assert run.footer.metrics["success"] == 0


def test_a_replay_reproduces_its_trace_without_the_scene(recorded):
    _, path = recorded
    trace = read_trace(path)
    assert replay(trace.header, trace.exchanges, trace.footer) is None


def test_a_replay_with_the_scene_renders_the_same_bytes(recorded):
    _, path = recorded
    trace = read_trace(path)
    shell = shell_of(trace.header, scenes=None)
    assert replay(trace.header, trace.exchanges, trace.footer, shell=shell) is None


def test_a_changed_answer_is_named_as_the_first_divergence(recorded):
    _, path = recorded
    trace = read_trace(path)
    asked = [e for e in trace.exchanges if isinstance(e.request, Ask)][1]
    keys = ask_of(asked).question.keys
    other = next(k for k in keys if k != getattr(asked.response, "winner", None))
    changed = replace(asked, response=Ordering.winner_only(other, keys))
    exchanges = tuple(changed if e.index == asked.index else e for e in trace.exchanges)
    found = replay(trace.header, exchanges, trace.footer)
    assert found is not None
    assert found.decision == asked.decision
    assert found.part == "request"
    assert found.recorded != found.replayed


def test_an_end_is_compared_unless_the_record_was_cut_off(recorded):
    _, path = recorded
    trace = read_trace(path)
    cut = replace(trace.footer, outcome=EpisodeOutcome.INTERRUPTED)
    for count in (len(trace.exchanges), len(trace.exchanges) - 1, 3):
        assert replay(trace.header, trace.exchanges[:count], cut) is None
    early = replay(trace.header, trace.exchanges[:-1], trace.footer)
    assert early is not None and (early.part, early.replayed) == ("end", "the core goes on")
    other = replay(trace.header, trace.exchanges, replace(cut, outcome=EpisodeOutcome.STALLED))
    assert other is not None and (other.recorded, other.replayed) == ("stalled", "step_limit")
    longer = (*trace.exchanges, replace(trace.exchanges[-1], index=len(trace.exchanges)))
    past = replay(trace.header, longer, trace.footer)
    assert past is not None and past.recorded == f"exchange {len(trace.exchanges)}"


def test_a_changed_motion_is_noticed_with_the_scene_alone(recorded):
    _, path = recorded
    trace = read_trace(path)
    last = [e for e in trace.exchanges if isinstance(e.request, Move)][-1]
    assert isinstance(last.response, Moved)
    step = replace(last.response.steps[-1], moved_m=0.123)
    moved = replace(last.response, steps=(*last.response.steps[:-1], step))
    exchanges = tuple(
        replace(e, response=moved) if e.index == last.index else e for e in trace.exchanges
    )
    shell = shell_of(trace.header, scenes=None)
    found = replay(trace.header, exchanges, trace.footer, shell=shell)
    assert found is not None
    assert (found.part, found.field) == ("response", f"steps[{len(moved.steps) - 1}].moved_m")


def test_an_override_is_committed_and_recorded_beside_the_original(bench):
    run = bench.open(OpenSpec("1"))
    ask = at_question(run)
    proposal = run.propose()
    wanted = Ordering.winner_only(ask.question.keys[-1], ask.question.keys)
    exchange = run.commit(Override(wanted, "ada", "looks like a door"))
    assert exchange.response == wanted
    assert exchange.ranked == proposal
    assert exchange.override is not None
    assert exchange.override.who == "ada"


def test_a_fork_shares_its_parents_past_and_takes_the_other_answer(bench, recorded, tmp_path):
    parent, path = recorded
    trace = read_trace(path)
    asked = [e for e in trace.exchanges if isinstance(e.request, Ask)][2]
    keys = ask_of(asked).question.keys
    other = next(k for k in keys if k != getattr(asked.response, "winner", None))
    spec = OpenSpec(
        "1",
        trace=tmp_path / "fork.mcap",
        parent_sha256=trace.sha256,
        fork_decision=number_of(asked),
    )
    override = Override(Ordering.winner_only(other, keys), "ada")
    child = bench.fork(spec, trace.exchanges, override)
    before, after = still(parent.exchanges)[: asked.index], still(child.exchanges)[: asked.index]
    assert difference(tuple(before), tuple(after)) is None
    left = child.exchanges[asked.index]
    assert left.response == override.outcome
    # What the ranker said to the same question stays beside the other answer.
    assert left.ranked is not None
    assert left.ranked == asked.ranked
    assert child.header.parent_sha256 == trace.sha256
    run_to_end(child)
    assert read_trace(tmp_path / "fork.mcap").header.fork_decision == asked.decision


def test_a_fork_at_a_decision_that_asked_nothing_is_refused(bench, recorded):
    parent, _ = recorded
    with pytest.raises(UsageError, match="expected a decision that put a question, came 9999"):
        bench.fork(
            OpenSpec("1", fork_decision=9999), parent.exchanges, Override(Ordering.of("left"), "x")
        )


def test_the_core_is_told_nothing_of_the_goal(recorded):
    run, _ = recorded
    for exchange in run.exchanges:
        if isinstance(exchange.request, Look):
            assert isinstance(exchange.response, Seen)
            assert exchange.truth is not None
            assert not hasattr(exchange.response, "truth")


def test_odometry_noise_is_seeded_and_replays(bench, tmp_path):
    noisy = replace(bench, noise=NoiseConfig(translation=0.05, rotation=0.05, depth=0.02))
    one = noisy.open(OpenSpec("1", trace=tmp_path / "noisy.mcap"))
    run_to_end(one)
    believed = [e.response.odometry for e in one.exchanges if isinstance(e.response, Seen)]
    true = [e.truth.poses[0] for e in one.exchanges if isinstance(e.request, Look) and e.truth]
    assert believed[-1] != true[-1]
    trace = read_trace(tmp_path / "noisy.mcap")
    shell = shell_of(trace.header, scenes=None)
    assert replay(trace.header, trace.exchanges, trace.footer, shell=shell) is None


def test_a_start_off_the_walkable_surface_is_named(bench):
    episode = bench.source.episode("1")
    astray = replace(episode, start=Pose((500.0, 0.0, 500.0), 0.0))
    world = bench.worlds.of(episode.scene_id)
    with pytest.raises(StartError, match=r"episode 1: expected a start on the walkable surface"):
        start_on(world, astray)


def test_no_step_is_one_that_a_robot_could_not_make(recorded):
    run, _ = recorded
    assert faults_of(run.header, run.exchanges) == []


def test_the_audit_notices_a_teleport_and_a_faculty_out_of_turn(recorded):
    run, _ = recorded
    moved = next(e for e in run.exchanges if isinstance(e.request, Move))
    assert moved.truth is not None
    far = Pose((9.0, 0.0, 9.0), 0.0)
    jump = replace(moved, truth=replace(moved.truth, poses=(*moved.truth.poses[:-1], far)))
    asked = next(e for e in run.exchanges if isinstance(e.request, Ask))
    early = replace(ask_of(asked), question=replace(ask_of(asked).question, slot=Slot.GROUND))
    spoilt = [
        jump if e is moved else replace(e, request=early) if e is asked else e
        for e in run.exchanges
    ]
    faults = faults_of(run.header, spoilt)
    assert any("moved" in fault for fault in faults)
    assert any("ground in cycle" in fault for fault in faults)
