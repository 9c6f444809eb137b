"""Turning points in the inspector: measured, tried, cancelled, taken up again, opened as forks."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from app.commands.sources import INSPECTED, host_of, opened_traces
from app.session import commands as c
from app.session import searching
from app.session.branches import succeeded
from app.session.snapshot import Snapshot
from app.session.timeline import timeline_of
from app.session.turning_state import Turning
from app.session.worker import Session
from c2nav_engine.experiments.spec import Setting
from c2nav_engine.experiments.turning.flips import TURNING, Budget, Flip
from tests.helpers import stage
from tests.helpers.planted import SHORT, decision_of, flawless

PATIENCE_S = 120.0


def until(session: Session, holds: Callable[[Snapshot], bool]) -> Snapshot:
    """The first published state for which something holds."""
    give_up = time.monotonic() + PATIENCE_S
    while not holds(session.snapshot):
        assert time.monotonic() < give_up, session.snapshot.notice.text
        time.sleep(0.02)
    return session.snapshot


@pytest.fixture(scope="module")
def failure(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, int]:
    """A trace with one planted mistake, and that decision's number."""
    path = tmp_path_factory.mktemp("turning") / "failure.mcap"
    whole = flawless(SHORT)
    recording = whole.with_mistakes(whole.mistakes[0], trace=path)
    return path, decision_of(recording, whole.mistakes[0])


@pytest.fixture
def session(failure, monkeypatch, tmp_path) -> Iterator[Session]:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(searching, "SUSPECTS", 1)
    monkeypatch.setattr(searching, "BUDGET", Budget(repeats=1))
    opened = opened_traces([failure[0]], Setting(source="builtin", ranker="random"))
    session = Session(opened)
    session.start()
    yield session
    session.close()


def here(snapshot: Snapshot) -> Turning:
    state = snapshot.turning_here
    assert state is not None
    return state


def test_a_failure_is_measured_tried_cancelled_taken_up_again_and_opened(session, failure):
    wrong = failure[1]
    session.dispatch(c.MeasureTurning())
    ready = here(until(session, lambda s: s.turning_here is not None and s.turning_here.left != ()))
    assert ready.regrets[0].decision == wrong
    assert ready.recoverable is not None
    assert ready.recoverable.decision == wrong
    assert {decision for decision, _ in ready.left} == {wrong}
    assert ready.cost.queries > 0

    stages: list[str] = []
    unsubscribe = session.subscribe(lambda s: stages.append(here(s).stage))
    session.dispatch(c.TryAnswers())
    session.dispatch(c.CancelTrying())
    stopped = here(until(session, lambda _: stages[-2:] == ["stopping", "ready"]))
    unsubscribe()
    assert len(stopped.flips) < len(ready.to_try)
    session.dispatch(c.TryAnswers())
    done = here(until(session, lambda s: not here(s).left and here(s).stage == "ready"))
    assert {(flip.decision, flip.answer) for flip in done.flips} == set(ready.to_try)
    assert len(done.flips) == len(ready.to_try)
    turning = next(flip for flip in done.flips if flip.verdict == TURNING)
    assert (turning.decision, turning.changed, turning.control) == (wrong, 1, 0)
    assert done.verdict == TURNING

    marks = timeline_of(session.snapshot)["events"]
    star = next(mark for mark in marks if mark["sign"] == "★")
    assert star["opens"] == {"decision": wrong, "answer": turning.answer}
    assert any(mark["sign"] == "⇥" and "privileged" in mark["words"] for mark in marks)

    session.dispatch(c.OpenFlip(decision=wrong, answer=turning.answer))
    branch = until(session, lambda s: s.branch.parent != "" and s.branch.footer is not None).branch
    assert succeeded(branch)
    assert branch.fork_decision == wrong
    # The ranker of the recording went on, not the one that the page would choose.
    assert branch.header.ranker == "simulated"
    assert list(INSPECTED.glob("*.mcap"))

    session.dispatch(c.Go(branch="b0"))
    session.dispatch(c.OpenFlip(decision=wrong, answer=turning.answer))
    again = until(session, lambda s: s.branch.parent != "")
    assert again.branch.branch_id == branch.branch_id
    assert len(again.branches) == 2


def test_a_search_that_breaks_unforeseen_can_be_taken_up_again(session, monkeypatch):
    session.dispatch(c.MeasureTurning())
    ready = here(until(session, lambda s: s.turning_here is not None and s.turning_here.left != ()))

    def broken(*_: object, **__: object) -> Iterator[Flip]:
        raise ZeroDivisionError("nobody foresaw this")
        yield

    with monkeypatch.context() as patch:
        patch.setattr(searching, "flips_of", broken)
        session.dispatch(c.TryAnswers())
        stumbled = until(session, lambda s: s.notice.fault)
    assert "nobody foresaw this" in stumbled.notice.text
    assert here(stumbled) == ready
    session.dispatch(c.TryAnswers())
    until(session, lambda s: here(s).flips != ())
    session.dispatch(c.CancelTrying())
    until(session, lambda s: here(s).stage == "ready")


def test_nothing_is_shown_to_who_judges_blind(session):
    session.dispatch(c.MeasureTurning())
    until(session, lambda s: s.turning_here is not None)
    session.dispatch(c.Cover(on=True))
    assert until(session, lambda s: s.view.blind).turning_here is None


def test_only_a_finished_failure_with_a_scene_has_turning_points():
    for opened, words in (
        (stage.opened_live(), "finished branch that failed"),
        (stage.opened_recording(), ""),
    ):
        session = Session(opened)
        session.start()
        session.dispatch(c.MeasureTurning())
        told = until(session, lambda s: s.notice.fault)
        assert words in told.notice.text
        assert told.turning == {}
        session.close()


@pytest.mark.parametrize(
    ("ranker", "options", "host"),
    [
        ("reference-cv", {}, ""),
        ("openai-chat", {"base_url": "http://127.0.0.1:8000/v1"}, ""),
        ("openai-chat", {"base_url": "https://models.example/v1"}, "models.example"),
        ("gpt-5.5", {}, "api.openai.com"),
        ("qwen3-vl-8b", {}, ""),
    ],
)
def test_where_a_ranker_sends_pictures_is_known_before(ranker, options, host):
    assert host_of(ranker, options) == host
