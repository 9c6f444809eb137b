from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from dataclasses import replace

import pytest

from app.session import commands as c
from app.session import moving
from app.session.branches import Origin
from app.session.opened import Choice, Opening
from app.session.snapshot import Snapshot
from app.session.state_json import state_json
from app.session.worker import Session, StaleCommand
from c2nav_engine.contract.outcome import Abstention, Ordering
from c2nav_engine.contract.prompt import Ranked
from c2nav_engine.contract.question import Question
from c2nav_engine.errors import UsageError
from c2nav_engine.geometry import Pose
from tests.helpers import stage
from tests.helpers.watched import Watched


@pytest.fixture
def live() -> Iterator[Watched]:
    session = Session(stage.opened_live())
    yield Watched(session)
    session.close()


@pytest.fixture
def recorded() -> Iterator[Watched]:
    session = Session(stage.opened_recording())
    yield Watched(session)
    session.close()


def proposed(number: int) -> Callable[[Snapshot], bool]:
    return lambda s: (
        s.proposal is not None and s.decision is not None and s.decision.number == number
    )


def test_it_stands_at_the_first_pending_decision_without_a_command(live: Watched):
    snapshot = live.until(proposed(0))
    assert snapshot.decision is not None
    assert snapshot.decision.pending
    assert len(snapshot.decision.facts.candidates) == 3


def test_a_step_commits_the_proposal(live: Watched):
    live.until(proposed(0))
    live.do(c.Step())
    snapshot = live.until(proposed(1))
    made = snapshot.story.decisions[0]
    assert made.ranked is not None
    assert made.override is None
    assert made.outcome == made.ranked.outcome


def test_an_override_is_recorded_with_the_original(live: Watched):
    live.until(proposed(0))
    live.do(c.Arrange(tiers=(("left",), ("front",))))
    live.until(lambda s: not s.draft.empty)
    live.do(c.Commit(why="the door is there"))
    snapshot = live.until(proposed(1))
    made = snapshot.story.decisions[0]
    assert made.override is not None
    assert made.override.why == "the door is there"
    assert made.outcome == Ordering.of("left", "front")
    assert made.ranked is not None
    assert made.ranked.outcome == Ordering.of("front", "left")


def test_a_fork_carries_who_and_why(recorded: Watched):
    recorded.do(c.Name(who="ada"))
    recorded.do(c.Go(decision=3))
    recorded.do(c.Press(key="left"))
    recorded.do(c.Why(text="the door is there"))
    recorded.do(c.Commit())
    recorded.do(c.Commit())
    snapshot = recorded.until(lambda s: s.branch.origin is Origin.FORK and s.proposal is not None)
    override = snapshot.story.decisions[3].override
    assert override is not None
    assert (override.who, override.why) == ("ada", "the door is there")
    assert snapshot.why == ""


def test_what_was_said_of_one_ranking_is_not_kept_for_another(recorded: Watched):
    recorded.do(c.Go(decision=3))
    recorded.do(c.Press(key="left"))
    recorded.do(c.Why(text="the door is there"))
    recorded.until(lambda s: bool(s.why))
    recorded.do(c.Go(decision=4))
    assert recorded.until(lambda s: s.here.decision == 4).why == ""


def test_at_the_end_a_step_says_that_it_is_one(recorded: Watched):
    recorded.do(c.Go())
    recorded.do(c.Step())
    snapshot = recorded.until(lambda s: s.notice.serial > 0)
    assert "This is the end" in snapshot.notice.text
    assert snapshot.stop + 1 == len(snapshot.story.stops)


def test_a_vetoed_view_cannot_be_ranked(live: Watched):
    live.until(proposed(0))
    live.do(c.Arrange(tiers=(("right",), ("left",))))
    snapshot = live.until(lambda s: not s.draft.empty)
    assert snapshot.draft.keys == ("left",)


def test_none_of_these_is_a_fallback_and_not_a_choice(live: Watched):
    live.until(proposed(0))
    live.do(c.NoneOfThese())
    live.until(lambda s: s.draft.none)
    live.do(c.Commit())
    snapshot = live.until(proposed(1))
    assert isinstance(snapshot.story.decisions[0].outcome, Abstention)
    assert snapshot.story.decisions[0].elected is None


def test_a_command_for_a_state_that_is_gone_is_refused(live: Watched):
    token = live.until(proposed(0)).token
    live.do(c.Step(id=token))
    live.until(proposed(1))
    with pytest.raises(StaleCommand, match="read /api/state again"):
        live.do(c.Commit(id=token))


def test_running_to_a_lane_stops_at_its_first_decision(live: Watched):
    live.until(proposed(0))
    live.do(c.RunTo(until="transition"))
    snapshot = live.until(lambda s: not s.playing and s.here.decision > 0)
    assert snapshot.decision is not None
    assert snapshot.decision.lane == 1
    assert all(d.lane == 0 for d in snapshot.story.decisions[:-1])


def test_running_to_the_end_ends_with_a_footer(live: Watched):
    live.until(proposed(0))
    live.do(c.RunTo(until="end"))
    snapshot = live.until(lambda s: s.branch.footer is not None and not s.playing)
    assert snapshot.story.pending is None


def test_a_past_override_first_names_its_cost_then_forks(recorded: Watched):
    recorded.do(c.Go(decision=3))
    recorded.until(lambda s: s.here.decision == 3)
    recorded.do(c.Press(key="left"))
    recorded.until(lambda s: not s.draft.empty)
    recorded.do(c.Commit())
    offer = recorded.until(lambda s: s.offer is not None).offer
    assert offer is not None
    assert offer.decisions == 14
    recorded.do(c.Commit())
    snapshot = recorded.until(lambda s: s.branch.origin is Origin.FORK and s.proposal is not None)
    assert snapshot.branch.parent == "b0"
    assert snapshot.branch.fork_decision == 3
    assert snapshot.story.decisions[3].override is not None
    root = snapshot.branches[0]
    assert root.origin is Origin.RECORDED
    assert (
        root.exchanges[: snapshot.story.decisions[3].exchange]
        == (snapshot.branch.exchanges[: snapshot.story.decisions[3].exchange])
    )


def test_without_the_scene_a_fork_is_refused_before_it_is_offered():
    recording = stage.opened_recording()
    opened = replace(
        recording, open=lambda choice: replace(recording.open(choice), no_scene="no scene here")
    )
    session = Session(opened)
    recorded = Watched(session)
    try:
        recorded.do(c.Go(decision=3))
        recorded.do(c.Press(key="left"))
        recorded.do(c.Commit())
        snapshot = recorded.until(lambda s: s.notice.fault)
        assert "--scenes" in snapshot.notice.text
        assert snapshot.offer is None
        assert snapshot.draft.keys == ("left",)
        assert "--scenes" in snapshot.no_suspects
    finally:
        session.close()


def test_answers_can_be_covered_in_a_fork(recorded: Watched):
    recorded.do(c.Go(decision=3))
    recorded.do(c.Press(key="left"))
    recorded.do(c.Commit())
    recorded.do(c.Commit())
    recorded.until(lambda s: s.branch.origin is Origin.FORK and s.proposal is not None)
    recorded.do(c.Cover(on=True))
    recorded.do(c.Go(decision=2))
    snapshot = recorded.until(lambda s: s.covered and s.here.decision == 2)
    assert state_json(snapshot)["decision"]["number"] == 2
    assert snapshot.reasked_at(2) == ()


def test_what_cannot_be_opened_leaves_the_live_episode_as_it_was():
    known = stage.opened_live()

    def only_scripted(choice: Choice) -> Opening:
        if choice.ranker != "scripted":
            message = f"expected a ranker that is to be had, came {choice.ranker}"
            raise UsageError(message)
        return known.open(choice)

    session = Session(replace(known, open=only_scripted))
    live = Watched(session)
    try:
        live.until(proposed(0))
        live.do(c.Step())
        live.until(proposed(1))
        live.do(c.Open(ranker="openai-chat"))
        snapshot = live.until(lambda s: s.notice.fault)
        assert "openai-chat" in snapshot.notice.text
        assert snapshot.chooser.choice.ranker == "scripted"
        live.do(c.RunTo(until="end"))
        assert len(live.until(lambda s: s.branch.footer is not None).story.decisions) > 2
    finally:
        session.close()


def test_a_fault_ends_playing(monkeypatch: pytest.MonkeyPatch, live: Watched):
    live.until(proposed(0))
    told: list[Snapshot] = []
    live.session.subscribe(told.append)

    def broken(*_: object) -> None:
        message = "nobody foresaw this"
        raise ZeroDivisionError(message)

    monkeypatch.setattr(moving.driving, "commit_proposal", broken)
    live.do(c.RunTo(until="end"))
    assert not live.until(lambda s: s.notice.fault).playing
    live.do(c.Camera(mode="top"))
    snapshot = live.until(lambda s: s.view.camera == "top")
    assert snapshot.notice.serial == 1


def test_stepping_back_never_changes_what_happened(recorded: Watched):
    before = recorded.session.snapshot.branches
    for count in (5, -2, 3, -6):
        recorded.do(c.Move(by="decision", count=count))
    recorded.do(c.Go(step=7))
    assert recorded.until(lambda s: s.here.step == 7).branches == before


def test_moving_by_steps_visits_every_step(recorded: Watched):
    for step in range(1, 6):
        recorded.do(c.Move(by="step", count=1))
        recorded.until(lambda s, step=step: s.here.step == step)


def test_judgements_can_be_undone_and_redone(recorded: Watched):
    recorded.do(c.Go(decision=2))
    recorded.do(c.Verdict(value="wrong"))
    assert recorded.until(lambda s: bool(s.judgements)).judgements[2].verdict == "wrong"
    recorded.do(c.Undo())
    recorded.until(lambda s: not s.judgements)
    recorded.do(c.Redo())
    assert recorded.until(lambda s: bool(s.judgements)).judgements[2].verdict == "wrong"


def test_the_worker_is_never_held_up_by_a_model():
    gate = threading.Event()
    session = Session(stage.opened_live(gate=gate))
    watched = Watched(session)
    try:
        watched.until(lambda s: s.asking is not None)
        watched.do(c.Camera(mode="top"))
        assert watched.until(lambda s: s.view.camera == "top").asking is not None
        gate.set()
        watched.until(proposed(0))
    finally:
        gate.set()
        session.close()


def test_after_a_cancel_a_person_answers_at_once_and_the_late_answer_is_dropped():
    gate = threading.Event()
    session = Session(stage.opened_live(gate=gate))
    watched = Watched(session)
    try:
        watched.until(lambda s: s.asking is not None)
        watched.do(c.Cancel())
        watched.until(lambda s: s.asking is None)
        watched.do(c.Arrange(tiers=(("left",), ("front",))))
        watched.do(c.Commit())
        snapshot = watched.until(lambda s: len(s.story.decisions) == 2)
        made = snapshot.story.decisions[0]
        assert made.override is not None
        assert made.ranked is None
        gate.set()
        ranked = watched.until(proposed(1)).proposal
        assert ranked is not None
        assert ranked.queries[0].prompt.question == snapshot.story.decisions[1].question
    finally:
        gate.set()
        session.close()


def test_pictures_leave_the_machine_only_after_a_yes():
    session = Session(stage.opened_live(sends_to="models.example"))
    watched = Watched(session)
    try:
        assert watched.until(lambda s: bool(s.consent_to)).consent_to == "models.example"
        assert watched.session.snapshot.asking is None
        watched.do(c.Consent(allow=True))
        watched.until(proposed(0))
    finally:
        session.close()


def test_every_picture_of_the_state_is_in_the_album(recorded: Watched):
    for decision in recorded.session.snapshot.story.decisions:
        for candidate in decision.facts.candidates:
            if candidate.picture is not None:
                found = recorded.session.album.get(candidate.picture.sha256)
                assert found == candidate.picture


def test_a_ranker_that_breaks_unforeseen_can_be_asked_again():
    broken = [True]

    def answer(question: Question, _: Pose) -> Ranked:
        if broken:
            broken.clear()
            raise ZeroDivisionError("nobody foresaw this")
        return stage.scripted_answer(question)

    recorded = stage.opened_live()
    opened = replace(
        recorded,
        open=lambda choice: replace(recorded.open(choice), run=stage.live_run(answer=answer)),
    )
    session = Session(opened)
    watched = Watched(session)
    try:
        stumbled = watched.until(lambda s: s.notice.fault)
        assert "nobody foresaw this" in stumbled.notice.text
        assert stumbled.asking is None
        watched.do(c.AskAgain())
        watched.until(proposed(0))
    finally:
        session.close()


def test_a_question_that_was_let_go_says_so_until_it_is_asked_again():
    gate = threading.Event()
    session = Session(stage.opened_live(gate=gate))
    watched = Watched(session)
    try:
        watched.until(lambda s: s.asking is not None)
        assert state_json(session.snapshot)["let_go"] == ""
        watched.do(c.Cancel())
        assert state_json(watched.until(lambda s: s.asking is None))["let_go"] == "Cancelled"
        watched.do(c.AskAgain())
        assert state_json(watched.until(lambda s: s.asking is not None))["let_go"] == ""
        watched.do(c.Cancel())
        watched.until(lambda s: s.asking is None)
        gate.set()  # A late answer counts while none was committed.
        assert state_json(watched.until(proposed(0)))["let_go"] == ""
    finally:
        gate.set()
        session.close()


def test_how_far_a_question_is_comes_from_its_ranker():
    gate = threading.Event()
    opened, run = stage.opened_live(), stage.live_run(gate=gate)
    begin = opened.open
    session = Session(replace(opened, open=lambda choice: replace(begin(choice), run=run)))
    watched = Watched(session)
    try:
        asking = watched.until(lambda s: s.asking is not None and run.told is not None).asking
        assert asking is not None
        assert (asking.answered, asking.usual_s) == (0, None)
        assert run.told is not None
        run.told(1, 3)
        told = watched.until(lambda s: s.asking is not None and s.asking.answered == 1)
        assert state_json(told)["asking"]["queries"] == 3
        watched.do(c.Cancel())
        watched.until(lambda s: s.asking is None)
        watched.do(c.AskAgain())
        # It is the same question that is still out.
        again = watched.until(lambda s: s.asking is not None).asking
        assert again == told.asking
    finally:
        gate.set()
        session.close()
