"""Remembering: the sketch's entries, the progress gate, the contrast, repeated support."""

from __future__ import annotations

from c2nav_engine.contract.outcome import ORDERS_DISAGREE, Abstention, Cardinal, Invalid
from c2nav_engine.contract.question import Form, Orders, Slot
from tests.helpers.open_floor import Floor, drive, each, prefer, task

THREE = ("Leave the room", "walk down the hall", "stop at the red chair")


def test_transition_waits_for_the_progress_gate():
    tale = drive(
        task(), prefer(seeing="front", transition="stay"), Floor(free_m={"front": 0.5}), asks=8
    )
    # One step of 0.25 m a cycle: the gate of 0.75 m opens in the third cycle.
    assert [s.gate_open for s in tale.sketches[:4]] == [False, False, True, True]
    assert tale.asked(Slot.TRANSITION)[0].facts.cycle == 2


def test_transition_is_asked_in_both_orders_on_the_current_view_and_the_thumbnails():
    tale = drive(task(), prefer(seeing="front", transition="stay"), asks=3)
    question = tale.asked(Slot.TRANSITION)[0].question
    assert question.orders is Orders.BOTH
    assert question.keys == ("stay", "next")
    assert question.context[-1][0] == "now"
    assert len(question.context) >= 2


def test_two_supports_in_a_row_advance_the_leg_and_one_does_not():
    tale = drive(task(legs=THREE), prefer(seeing="front", transition="next"), asks=12)
    advanced = [s.advanced for s in tale.sketches]
    assert advanced[:2] == [False, True]


def test_a_contrary_answer_resets_the_run():
    answers = each(seeing=["front"], transition=["next", "stay", "next", "stay"])
    tale = drive(task(legs=THREE), answers, asks=16)
    assert not any(s.advanced for s in tale.sketches)


def test_an_order_disagreement_resets_the_run():
    answers = each(
        seeing=["front"], transition=["next", Abstention(ORDERS_DISAGREE), "next", "stay"]
    )
    tale = drive(task(legs=THREE), answers, asks=16)
    assert not any(s.advanced for s in tale.sketches)


def test_any_other_non_answer_leaves_the_run():
    for nothing in (Abstention("cannot tell"), Invalid("prose")):
        answers = each(seeing=["front"], transition=["next", nothing, "next", "stay"])
        tale = drive(task(legs=THREE), answers, asks=16)
        assert [s.support for s in tale.sketches[:3]] == [1, 1, 2]
        assert tale.sketches[2].advanced


def test_the_cue_says_what_was_answered():
    answers = each(seeing=["front"], transition=["stay", Abstention("x"), "next"])
    tale = drive(task(legs=THREE), answers, asks=7)
    assert [s.entry.cue for s in tale.sketches[:3]] == ["current", "ambiguous", "next"]


def test_the_last_leg_has_no_transition():
    tale = drive(task(legs=("stop at the chair",)), prefer(seeing="front"), asks=30)
    assert tale.asked(Slot.TRANSITION) == []


def test_no_frame_is_counted_twice():
    answers = each(
        seeing=["front", Abstention("x"), Abstention("x"), "front"],
        transition=["next"],
        glance=["sector0"],
    )
    tale = drive(task(legs=THREE), answers, asks=8)
    cycles = [ask.facts.cycle for ask in tale.asked(Slot.TRANSITION)]
    assert cycles[0] == 0
    assert 1 not in cycles
    assert 2 not in cycles


def test_the_sketch_speaks_in_words_without_digits():
    answers = each(seeing=["left", "right", "front"], transition=["next", "stay"])
    tale = drive(task(legs=THREE), answers, asks=20)
    text = "\n".join(s.rendering for s in tale.sketches)
    assert "turned left" in text
    assert not any(character.isdigit() for character in text)


def test_displacement_is_in_the_leg_start_frame():
    tale = drive(task(), prefer(seeing="left", transition="stay"), asks=4)
    right_m, forward_m = tale.sketches[0].entry.displacement_m
    assert right_m < -0.4
    assert forward_m > 0.4


def test_without_transition_a_leg_ends_six_cycles_past_its_gate():
    tale = drive(task("no-transition", legs=THREE), prefer(seeing="front"), asks=30)
    assert tale.asked(Slot.TRANSITION) == []
    first = next(i for i, s in enumerate(tale.sketches) if s.advanced)
    opened = next(i for i, s in enumerate(tale.sketches) if s.gate_open)
    assert first - opened == 6
    assert all(s.entry.cue == "ambiguous" for s in tale.sketches)


def test_cardinal_progress_supports_from_eighty():
    answers = each(seeing=["front"], transition=[Cardinal(80.0), Cardinal(79.9), Cardinal(90.0)])
    tale = drive(task("transition-cardinal", legs=THREE), answers, asks=12)
    assert [s.support for s in tale.sketches[:4]] == [1, 0, 1, 2]


def test_the_transition_inversion_changes_the_answer_form_alone():
    ordinal = drive(task("full"), prefer(seeing="front"), asks=3)
    cardinal = drive(task("transition-cardinal"), prefer(seeing="front"), asks=3)
    first, second = (t.asked(Slot.TRANSITION)[0].question for t in (ordinal, cardinal))
    assert second.form is Form.PROGRESS
    assert first.context == second.context
    assert first.alternatives == second.alternatives
    assert first.sketch == second.sketch
    assert first.shuffle_seed == second.shuffle_seed


def test_without_sketch_prompts_carry_none_and_transition_sees_the_current_view_alone():
    tale = drive(task("no-sketch"), prefer(seeing="front", transition="stay"), asks=6)
    assert all(ask.question.sketch == "" for ask, _ in tale.answers)
    assert [name for name, _ in tale.asked(Slot.TRANSITION)[0].question.context] == ["now"]


def test_a_new_leg_starts_with_no_support_and_a_closed_gate():
    tale = drive(task(legs=THREE), prefer(seeing="front", transition="next"), asks=20)
    advanced = next(i for i, s in enumerate(tale.sketches) if s.advanced)
    assert tale.sketches[advanced].leg == 1
    assert tale.sketches[advanced + 1].support <= 1
