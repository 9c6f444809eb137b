"""Seeing: fan, vetting, election, bundle, glance and fallback, one test a rule."""

from __future__ import annotations

import math
from itertools import pairwise

from c2nav_engine.contract.outcome import Abstention, Cardinal, Invalid, Ordering, Tie
from c2nav_engine.contract.question import Orders, Slot
from c2nav_engine.navigator.requests import Action, Look, Rig
from c2nav_engine.navigator.state import Ending
from tests.helpers.open_floor import Floor, drive, each, prefer, small, task


def test_the_elected_view_is_turned_to_and_a_bundle_of_three_is_moved():
    tale = drive(task(), prefer(seeing="left"), asks=2)
    (first, *_) = tale.moves("elect")
    assert first.actions == (Action.LEFT,) * 3 + (Action.FORWARD,) * 3


def test_a_bundle_stays_short_of_the_free_space():
    tale = drive(task(), prefer(seeing="front"), Floor(free_m={"front": 0.75}), asks=2)
    assert tale.moves("elect")[0].actions == (Action.FORWARD,) * 2


def test_a_view_without_free_space_is_vetoed_before_the_query_with_its_reason():
    tale = drive(task(), prefer(seeing="front"), Floor(free_m={"left": 0.3}), asks=1)
    (ask,) = tale.asked(Slot.SEEING)
    assert ask.question.keys == ("front", "right")
    left = next(c for c in ask.facts.candidates if c.key == "left")
    assert not left.feasible
    assert left.veto == "free 0.3 m, needs 0.5 m"


def test_a_single_survivor_is_elected_without_a_question():
    tale = drive(task(), prefer(), Floor(free_m={"left": 0.1, "right": 0.1}), asks=4)
    assert [note.elected for note in tale.unasked[:2]] == ["front", "front"]
    assert tale.moves("elect")[0].actions == (Action.FORWARD,) * 3


def test_no_survivor_leads_to_a_glance_at_once():
    blocked = {"left": 0.1, "front": 0.1, "right": 0.1}
    tale = drive(task(), prefer(glance="sector1"), Floor(free_m=blocked), asks=1)
    assert tale.unasked[0].elected is None
    assert [r.rig for r in tale.requests if isinstance(r, Look)][:2] == [Rig.FAN, Rig.RING]
    (ask,) = tale.asked(Slot.GLANCE)
    assert ask.question.keys == tuple(f"sector{k}" for k in range(6))


def test_a_glance_only_reorients_towards_the_freer_of_the_winners_two_views():
    free = {"left": 0.1, "front": 0.1, "right": 0.1, "ring2": 1.0, "ring3": 4.0}
    tale = drive(task(), prefer(glance="sector1"), Floor(free_m=free), asks=1)
    assert tale.moves("elect") == []
    tale = drive(task(), prefer(glance="sector1"), Floor(free_m=free), asks=2)
    assert tale.moves("glance")[0].actions == (Action.LEFT,) * 6


def test_sectors_chosen_from_here_are_not_offered_again():
    blocked = {"left": 0.1, "front": 0.1, "right": 0.1}
    tale = drive(task(), prefer(glance="sector0"), Floor(free_m=blocked), asks=3)
    sizes = [len(ask.question.keys) for ask in tale.asked(Slot.GLANCE)]
    assert sizes[0] == 6
    assert sizes[1] < 6


def test_two_elections_without_an_ordering_lead_to_a_glance():
    tale = drive(task(), prefer(seeing=Abstention("cannot tell"), glance="sector3"), asks=3)
    assert [a.question.slot for a, _ in tale.answers] == [Slot.SEEING, Slot.SEEING, Slot.GLANCE]
    assert tale.moves("elect") == []


def test_alternating_elections_lead_to_a_glance():
    answers = each(seeing=["left", "right", "left", "right", "front"], glance=["sector0"])
    tale = drive(task(legs=("go",)), answers, asks=40)
    assert tale.events("glance")[0].detail == "elections alternate between left and right"


def test_too_little_displacement_over_four_cycles_leads_to_a_glance():
    tale = drive(
        task(legs=("go",)),
        prefer(seeing="front", glance="sector1", ground="ahead"),
        Floor(collide_at=frozenset(range(1, 200))),
        asks=30,
    )
    details = [event.detail for event in tale.events("glance")]
    assert "too little displacement over the last cycles" in details


def test_no_second_glance_within_two_cycles_unless_nothing_survives():
    tale = drive(task(), prefer(seeing=Abstention("cannot tell"), glance="sector0"), asks=12)
    cycles = [event.cycle for event in tale.events("glance")]
    assert min(b - a for a, b in pairwise(cycles)) > 2


def test_a_collision_blocks_its_heading_until_half_a_metre_is_travelled():
    tale = drive(task(), prefer(seeing="front"), Floor(collide_at=frozenset({1})), asks=4)
    second = tale.asked(Slot.SEEING)[1]
    assert second.question.keys == ("left", "right")
    front = next(c for c in second.facts.candidates if c.key == "front")
    assert front.veto == "collided this way just now"
    third = tale.asked(Slot.SEEING)[2]
    assert "front" in third.question.keys


def test_the_first_election_of_a_leg_and_one_after_no_ordering_are_contested():
    answers = each(seeing=["front", "front", Abstention("x"), "front", "front"])
    tale = drive(task(legs=("go",)), answers, asks=16)
    orders = [ask.question.orders for ask in tale.asked(Slot.SEEING)]
    assert orders[:5] == [Orders.CYCLIC, Orders.ONCE, Orders.ONCE, Orders.CYCLIC, Orders.ONCE]


def test_an_election_after_a_change_of_sides_is_contested():
    tale = drive(task(legs=("go",)), each(seeing=["left", "right", "front"]), asks=3)
    third = tale.asked(Slot.SEEING)[2]
    assert third.facts.contested == "the previous election changed sides"


def test_the_presentation_seed_changes_from_cycle_to_cycle():
    tale = drive(task(), prefer(seeing=Abstention("x")), asks=2)
    first, second = tale.asked(Slot.SEEING)
    assert first.question.shuffle_seed != second.question.shuffle_seed


def test_nothing_but_an_ordering_moves_the_body():
    for outcome in (Abstention("x"), Invalid("prose"), Tie((("left", "front"), ("right",)))):
        tale = drive(task(), prefer(seeing=outcome), asks=2)
        assert tale.moves("elect") == []
        assert len(tale.events("fallback")) >= 1


def test_twelve_fallbacks_in_a_row_stall_without_a_stop():
    tale = drive(task(), prefer(), asks=100)
    assert tale.ending is Ending.STALLED
    assert not tale.stopped
    assert len(tale.events("fallback")) == 12


def test_a_forward_step_after_an_ordering_resets_the_fallbacks():
    script: list[str | Abstention] = []
    for _ in range(8):
        script += [Abstention("x"), "front"]
    tale = drive(task(legs=("go",)), each(seeing=script), asks=60)
    assert tale.ending is None
    assert len(tale.events("fallback")) >= 8


def test_the_step_limit_ends_the_episode_without_a_stop():
    tale = drive(
        task(profile=small(max_steps=20)), prefer(seeing="front", transition="stay"), asks=100
    )
    assert tale.ending is Ending.STEP_LIMIT
    assert not tale.stopped


def test_direct_action_moves_forward_and_turns_by_the_fan_offset():
    tale = drive(task("no-seeing"), each(direct=["forward", "right"]), asks=6)
    moves = tale.moves("direct")
    assert moves[0].actions == (Action.FORWARD,) * 3
    assert moves[1].actions == (Action.RIGHT,) * 3 + (Action.FORWARD,) * 3


def test_direct_action_that_cannot_move_a_step_turns_and_is_a_fallback():
    tale = drive(task("no-seeing"), prefer(direct="left"), Floor(free_m={"left": 0.3}), asks=2)
    assert tale.moves("direct")[0].actions == (Action.LEFT,) * 3
    assert tale.events("fallback")[0].detail == "free 0.3 m left, no step fits"


def test_direct_action_removes_nothing_and_never_glances():
    blocked = {"left": 0.1, "front": 0.1, "right": 0.1}
    tale = drive(task("no-seeing"), prefer(direct="forward"), Floor(free_m=blocked), asks=60)
    assert all(ask.question.keys == ("forward", "left", "right") for ask, _ in tale.answers)
    assert tale.events("glance") == []
    assert tale.ending is Ending.STALLED


def test_the_spatial_inversion_turns_to_the_named_heading_rounded_to_the_turn():
    tale = drive(task("spatial-cardinal"), prefer(seeing=Cardinal(-38.0)), asks=2)
    assert tale.moves("elect")[0].actions == (Action.RIGHT,) * 3
    assert tale.moves("elect")[1].actions == (Action.FORWARD,) * 3


def test_the_spatial_inversion_shows_the_same_pictures_in_the_same_seeded_order():
    ordinal = drive(task("full"), prefer(), asks=1).asked(Slot.SEEING)[0].question
    cardinal = drive(task("spatial-cardinal"), prefer(), asks=1).asked(Slot.SEEING)[0].question
    assert [a.picture for a in ordinal.alternatives] == [a.picture for a in cardinal.alternatives]
    assert ordinal.shuffle_seed == cardinal.shuffle_seed
    assert [a.caption for a in cardinal.alternatives] == [
        "heading +45 degrees",
        "heading 0 degrees",
        "heading -45 degrees",
    ]


def test_the_spatial_inversion_without_room_turns_does_not_move_and_falls_back():
    def free(key: str, yaw_rad: float) -> float:
        return 0.2 if key == "front" and abs(yaw_rad) > 0.1 else 5.0

    tale = drive(task("spatial-cardinal"), prefer(seeing=Cardinal(30.0)), Floor(free=free), asks=2)
    assert tale.moves("elect")[0].actions == (Action.LEFT,) * 2
    assert all(Action.FORWARD not in move.actions for move in tale.moves("elect")[:1])
    assert tale.events("fallback")[0].detail.startswith("free 0.2 m")


def test_the_cardinal_glance_only_reorients():
    blocked = {"left": 0.1, "front": 0.1, "right": 0.1}
    tale = drive(
        task("spatial-cardinal"), prefer(glance=Cardinal(-120.0)), Floor(free_m=blocked), asks=2
    )
    assert tale.moves("glance")[0].actions == (Action.RIGHT,) * 8


def test_a_glance_that_names_the_present_heading_cannot_go_on_for_ever():
    blocked = {"left": 0.1, "front": 0.1, "right": 0.1}
    tale = drive(
        task("spatial-cardinal"), prefer(glance=Cardinal(4.0)), Floor(free_m=blocked), asks=60
    )
    assert tale.ending is Ending.STALLED
    assert len(tale.answers) == 12


def test_an_ordering_over_unoffered_keys_is_a_broken_promise():
    import pytest

    from c2nav_engine.errors import InternalError

    with pytest.raises(InternalError, match="expected keys among"):
        drive(task(), lambda _ask: Ordering.of("sector9"), asks=1)


def test_a_glance_forgets_collisions_and_histories():
    answers = each(seeing=["front", Abstention("x"), Abstention("x"), "front"], glance=["sector0"])
    tale = drive(task(), answers, Floor(collide_at=frozenset({1})), asks=6)
    after = [a for a, _ in tale.answers if a.question.slot is Slot.SEEING][-1]
    assert after.question.keys == ("left", "front", "right")
    assert math.isclose(after.facts.travelled_m, 0.0)
