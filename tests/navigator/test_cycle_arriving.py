"""Arriving: gates, ladder, look-back, vetoes, re-evaluation, markers and Walk-Back."""

from __future__ import annotations

from c2nav_engine.contract.outcome import Abstention, Cardinal
from c2nav_engine.contract.question import Form, Orders, Slot
from c2nav_engine.navigator.requests import DepthStats, Look, Rig
from c2nav_engine.navigator.state import Ending
from tests.helpers.open_floor import Answers, Floor, Tale, drive, each, prefer, task

LAST = ("stop at the red chair",)
IMPLAUSIBLE = DepthStats(0.2, 0.0)


def at_last(variant: str = "full", **winners: object) -> Answers:
    return prefer(seeing="front", direct="forward", **winners)  # pyright: ignore


def last_leg(answers: Answers, variant: str = "full", floor: Floor | None = None) -> Tale:
    return drive(task(variant, legs=LAST), answers, floor, asks=80)


def test_arriving_waits_for_two_metres_in_the_episode():
    tale = last_leg(at_last(ground="here", journey="covered"))
    assert tale.asked(Slot.GROUND)[0].facts.travelled_m >= 2.0
    assert tale.asked(Slot.SEEING)[-1].facts.travelled_m < 2.0 <= 2.25


def test_arriving_waits_for_half_a_metre_in_the_leg_and_the_cycle_after_it_began():
    answers = prefer(seeing="front", transition="next", ground="ahead")
    tale = drive(task(legs=("go on", "go", "stop at the chair")), answers, asks=30)
    entered = [s.entry.cycle for s in tale.sketches if s.advanced][-1]
    first = tale.asked(Slot.GROUND)[0]
    assert first.facts.cycle > entered
    assert first.facts.leg_travelled_m >= 0.5
    assert first.facts.leg == 2


def test_ground_and_journey_in_favour_stop():
    tale = last_leg(at_last(ground="here", journey="covered"))
    assert tale.ending is Ending.STOPPED
    assert tale.stopped
    assert tale.asked(Slot.LOOKBACK) == []


def test_all_terminal_questions_are_asked_in_both_orders():
    tale = last_leg(at_last(ground="here", journey=Abstention("x"), lookback="back"))
    for slot in (Slot.GROUND, Slot.JOURNEY, Slot.LOOKBACK):
        assert tale.asked(slot)[0].question.orders is Orders.BOTH


def test_one_of_two_in_favour_looks_back_and_stops_when_now_fits_better():
    tale = last_leg(at_last(ground="here", journey=Abstention("x"), lookback="now"))
    assert tale.ending is Ending.STOPPED
    (ask,) = tale.asked(Slot.LOOKBACK)
    assert ask.question.keys == ("now", "back")
    assert (tale.ladders[-1].lookback, tale.ladders[-1].verdict) == (1, "stop")


def test_an_undecided_look_back_holds():
    tale = last_leg(at_last(ground="here", journey=Abstention("x"), lookback=Abstention("x")))
    assert not tale.stopped
    assert {ladder.verdict for ladder in tale.ladders} == {"hold"}


def test_the_look_back_frame_lies_at_least_two_metres_behind_on_the_path():
    tale = last_leg(at_last(ground="here", journey=Abstention("x"), lookback="back"))
    ask = tale.asked(Slot.LOOKBACK)[0]
    back = next(a.picture for a in ask.question.alternatives if a.key == "back")
    fronts = [a for a in tale.asked(Slot.SEEING) if a.facts.travelled_m <= 0.251]
    shown = {c.picture.sha256 for a in fronts for c in a.facts.candidates if c.picture}
    assert back is not None
    assert back.sha256 in shown


def test_the_look_back_budget_of_a_place_is_three():
    slow = Floor(free_m={"front": 0.5, "left": 0.1, "right": 0.1})
    tale = last_leg(at_last(ground="here", journey=Abstention("x"), lookback="back"), floor=slow)
    first = tale.asked(Slot.LOOKBACK)[0].facts.odometry.position_m
    near = [
        ask
        for ask in tale.asked(Slot.LOOKBACK)
        if abs(ask.facts.odometry.position_m[2] - first[2]) <= 1.5
    ]
    assert len(near) == 3


def test_implausible_depth_turns_a_stop_into_a_hold_and_is_evaluated_once_more_at_rest():
    floor = Floor(depth=IMPLAUSIBLE)
    tale = last_leg(at_last(ground="here", journey="covered"), floor=floor)
    assert tale.ladders[0].vetoes == ("depth median 0.20 m, plausible from 0.35 m",)
    assert tale.ladders[0].event == "stop vetoed"
    # The ring's freest view is plausible, so the second reading stops without a step between.
    assert tale.ending is Ending.STOPPED
    assert tale.ladders[1].cycle == tale.ladders[0].cycle + 1
    assert [r.rig for r in tale.requests if isinstance(r, Look)][-1] is Rig.RING


def test_a_second_veto_leaves_a_marker_and_moves_on():
    floor = Floor(depth=IMPLAUSIBLE, ring_depth=IMPLAUSIBLE)
    tale = last_leg(at_last(ground="here", journey="covered"), floor=floor)
    assert [ladder.event for ladder in tale.ladders[:2]] == ["stop vetoed", "marker left"]
    assert len(tale.ladders[1].markers) == 1
    assert tale.ladders[2].cycle > tale.ladders[1].cycle
    moved = tale.moves("elect")
    assert len(moved) > 3


def test_a_collision_in_the_last_forward_step_vetoes_a_stop():
    tale = last_leg(
        at_last(ground="here", journey="covered"), floor=Floor(collide_at=frozenset({9}))
    )
    assert tale.ladders[0].vetoes == ("the last forward step collided",)


def _walked_back(variant: str = "full", **more: object) -> Tale:
    """In favour once without a stop, then against: what calls the robot back."""
    answers = each(
        seeing=["front"],
        ground=["here", "ahead", "ahead", "here"],
        journey=["missing", "missing", "missing", "covered"],
        **more,  # pyright: ignore
    )
    return last_leg(answers, variant)


def test_two_contrary_cycles_after_further_travel_call_the_robot_back_and_it_may_stop():
    tale = _walked_back()
    (event,) = tale.events("walk-back")
    assert event.detail.startswith("to where cycle")
    assert tale.moves("walk-back")
    assert tale.ending is Ending.STOPPED
    assert [s.entry.words for s in tale.sketches].count("went back") == 1


def test_the_robot_comes_back_to_within_half_a_metre_and_the_markers_heading():
    tale = _walked_back()
    marked = next(ladder for ladder in tale.ladders if ladder.event == "marker left")
    (marker,) = marked.markers
    end = tale.asked(Slot.GROUND)[-1].facts.odometry
    assert abs(end.position_m[2] - marker.odometry.position_m[2]) <= 0.5
    assert abs(end.yaw_rad - marker.odometry.yaw_rad) < 1e-6


def test_without_walk_back_no_marker_is_left():
    tale = _walked_back("no-walkback")
    assert tale.events("walk-back") == []
    assert all(ladder.markers == () for ladder in tale.ladders)


def test_a_place_is_walked_back_to_once_and_an_episode_at_most_twice():
    answers = each(
        seeing=["front"],
        ground=["here", "ahead", "ahead", "ahead"],
        journey=["missing"],
    )
    tale = drive(task(legs=LAST), answers, asks=200)
    assert len(tale.events("walk-back")) == 1
    often = each(seeing=["front"], ground=["here", "ahead", "ahead"] * 20, journey=["missing"])
    tale = drive(task(legs=LAST), often, asks=400)
    assert len(tale.events("walk-back")) == 2


def test_a_return_that_keeps_colliding_is_given_up_and_its_marker_dropped():
    floor = Floor(collide_at=frozenset(range(18, 300)))
    answers = each(
        seeing=["front"], ground=["here", "ahead", "ahead", "ahead"], journey=["missing"]
    )
    tale = drive(task(legs=LAST), answers, floor, asks=60)
    assert tale.events("gave up")[0].detail == "3 collisions on the way back"
    assert all(not ladder.markers for ladder in tale.ladders[4:])


def test_evidence_is_cleared_every_cycle():
    answers = each(seeing=["front"], ground=["here", "ahead"], journey=["missing", "covered"])
    tale = last_leg(answers)
    assert (tale.ladders[0].ground, tale.ladders[0].journey) == (1, -1)
    assert (tale.ladders[1].ground, tale.ladders[1].journey) == (-1, 1)


def test_the_terminal_inversion_asks_one_view_once_and_yes_stops():
    tale = last_leg(at_last(ground=Cardinal(1.0)), "terminal-absolute")
    (ask,) = tale.asked(Slot.GROUND)
    assert ask.question.form is Form.YES_NO
    assert ask.question.orders is Orders.ONCE
    assert tale.ending is Ending.STOPPED
    assert tale.asked(Slot.JOURNEY) == tale.asked(Slot.LOOKBACK) == []


def test_no_of_the_terminal_inversion_is_evidence_against():
    tale = last_leg(at_last(ground=Cardinal(0.0)), "terminal-absolute")
    assert not tale.stopped
    assert tale.ladders[0].ground == -1


def test_the_basic_stop_needs_two_cycles_in_a_row_and_asks_ground_alone():
    answers = each(seeing=["front"], ground=["here", "ahead", "here", "here"])
    tale = last_leg(answers, "no-arriving")
    assert tale.ending is Ending.STOPPED
    assert len(tale.asked(Slot.GROUND)) == 4
    assert tale.asked(Slot.JOURNEY) == []


def test_the_basic_stop_keeps_the_vetoes():
    floor = Floor(depth=IMPLAUSIBLE)
    tale = last_leg(at_last(ground="here"), "seeing", floor)
    assert not tale.stopped
    assert any(ladder.vetoes for ladder in tale.ladders)


def test_without_remembering_the_journey_is_not_asked_and_is_undecided():
    tale = last_leg(at_last(ground="here", lookback="now"), "no-remembering")
    assert tale.asked(Slot.JOURNEY) == []
    assert tale.ladders[0].journey == 0
    assert tale.ending is Ending.STOPPED


def test_without_legs_the_whole_instruction_is_the_only_leg():
    for variant in ("base", "seeing", "no-remembering"):
        tale = drive(task(variant), prefer(seeing="front", direct="forward"), asks=1)
        assert tale.answers[0][0].question.legs == (task().instruction,)


def test_no_evidence_without_a_forward_step_since_it_was_last_asked():
    answers = each(
        seeing=["front", "front", "front", Abstention("x"), Abstention("x"), "front"],
        ground=["ahead"],
        glance=["sector0"],
    )
    tale = last_leg(answers)
    positions = [ask.facts.odometry.position_m for ask in tale.asked(Slot.GROUND)]
    assert len(set(positions)) == len(positions)


def test_the_walk_back_reading_uses_the_frame_stored_with_the_marker():
    answers = each(
        seeing=["front"],
        ground=["here", "ahead", "ahead", "here"],
        journey=[Abstention("x")],
        lookback=["back", "now"],
    )
    tale = last_leg(answers)
    first, second = tale.asked(Slot.LOOKBACK)[0], tale.asked(Slot.LOOKBACK)[-1]

    def back(ask):
        return next(a.picture for a in ask.question.alternatives if a.key == "back")

    assert back(first) == back(second)
    assert tale.ending is Ending.STOPPED
