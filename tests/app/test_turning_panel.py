"""The panel of turning points and its marks on the timeline, drawn from made-up states."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.inspector.panels.turning import content
from app.session.branches import Cost
from app.session.snapshot import Snapshot
from app.session.timeline import timeline_of
from app.session.turning_state import Turning
from app.session.worker import Session
from c2nav_engine.contract.question import Slot
from c2nav_engine.experiments.turning.flips import Flip
from c2nav_engine.experiments.turning.recoverable import Recoverable
from c2nav_engine.experiments.turning.regrets import WRONG, Regret
from tests.helpers import stage


@pytest.fixture(scope="module")
def failed() -> Snapshot:
    """A recorded branch that stopped too far from the goal."""
    snapshot = Session(stage.opened_recording()).snapshot
    branch = snapshot.branch
    assert branch.footer is not None
    footer = replace(branch.footer, metrics={**branch.footer.metrics, "success": 0})
    return replace(snapshot, branch=replace(branch, footer=footer))


def flip(decision: int, answer: str, changed: int, control: int) -> Flip:
    return Flip(decision, Slot.SEEING, answer, changed, control, repeats=3, queries=9)


MEASURED = Turning(
    "ready",
    ranker="scripted",
    regrets=(Regret(2, Slot.SEEING, "front", "left", 1.25, WRONG),),
    recoverable=Recoverable(4, {2: True, 4: True, 6: False}),
    repeats=3,
    to_try=((2, "left"), (2, "right"), (4, "left")),
    cost=Cost(queries=270, seconds=190.0),
)


def seen(snapshot: Snapshot, state: Turning) -> Snapshot:
    return replace(snapshot, turning={snapshot.branch.branch_id: state})


def test_before_anything_is_measured_only_a_failure_offers_it(failed):
    assert "measure_turning" in content(failed)
    assert failed.branch.footer is not None
    metrics = {**failed.branch.footer.metrics, "success": 1}
    footer = replace(failed.branch.footer, metrics=metrics)
    saved = replace(failed, branch=replace(failed.branch, footer=footer))
    assert "measure_turning" not in content(saved)


def test_the_cost_is_said_before_anything_is_asked(failed):
    words = content(seen(failed, MEASURED))
    assert "3 answers left to try at 2 decisions" in words
    assert "270 queries" in words
    assert "try_answers" in words
    assert "privileged" in words
    assert "+1.25 m" in words


def test_both_counts_are_shown_and_a_tried_answer_can_be_opened(failed):
    words = content(seen(failed, replace(MEASURED, stage="trying", flips=(flip(2, "left", 3, 0),))))
    assert words.index("3 of 3") < words.index("0 of 3")
    assert "open_flip" in words
    assert "cancel_trying" in words
    assert "1 of 3 tried" in words


def test_nothing_is_ruled_out_while_answers_are_left(failed):
    one = flip(2, "left", 0, 0)
    assert "not one answer away" not in content(seen(failed, replace(MEASURED, flips=(one,))))
    rest = (one, flip(2, "right", 0, 0), flip(4, "left", 0, 0))
    words = content(seen(failed, replace(MEASURED, flips=rest)))
    assert "not one answer away, among the decisions tried" in words
    assert "try_answers" not in words


def test_where_nothing_could_be_recovered_it_says_so(failed):
    nothing = Recoverable(None, {0: False, 1: False})
    words = content(seen(failed, replace(MEASURED, recoverable=nothing)))
    assert "even a noiseless observer fails" in words


def test_the_timeline_marks_each_decision_once_and_a_turning_point_before_an_unstable_one(failed):
    flips = (flip(2, "left", 2, 0), flip(2, "right", 3, 0), flip(4, "left", 3, 3))
    events = timeline_of(seen(failed, replace(MEASURED, flips=flips)))["events"]
    marks = {event["sign"]: event for event in events if event["sign"] in "★☆⇥"}
    assert marks["★"]["opens"] == {"decision": 2, "answer": "right"}
    assert marks["☆"]["opens"] == {"decision": 4, "answer": "left"}
    assert "unchanged in 3 of 3" in marks["☆"]["words"]
    assert marks["⇥"]["step"] == failed.story.decisions[4].step
    assert len([event for event in events if event["sign"] in "★☆"]) == 2


def test_who_judges_blind_sees_none_of_it(failed):
    state = seen(failed, replace(MEASURED, flips=(flip(2, "left", 3, 0),)))
    covered = replace(state, view=replace(state.view, blind=True))
    assert "★" not in content(covered)
    assert "+1.25 m" not in content(covered)
    assert all(event["sign"] not in "★⇥" for event in timeline_of(covered)["events"])
