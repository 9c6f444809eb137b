from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from c2nav_engine.contract import template
from c2nav_engine.contract.lint import lint, metric_words
from c2nav_engine.contract.presentation import presentations
from c2nav_engine.contract.question import Form, Orders, Picture, Slot
from c2nav_engine.contract.render import render, text_of
from c2nav_engine.errors import InternalError, UsageError
from tests.helpers.questions import INVERSIONS, LEGS, every_question, question

SEEDS = st.integers(0, 2**32 - 1)


@given(seed=SEEDS)
def test_both_orders_are_the_seeded_one_and_its_reverse(seed: int):
    first, second = presentations(question(Slot.GROUND, seed=seed))
    assert first == second[::-1]
    assert sorted(first) == ["ahead", "here"]


@given(seed=SEEDS)
def test_cyclic_orders_put_every_alternative_in_every_position_once(seed: int):
    shown = presentations(question(Slot.SEEING, orders=Orders.CYCLIC, seed=seed))
    for position in range(3):
        assert sorted(order[position] for order in shown) == ["front", "left", "right"]


def test_a_person_and_a_cardinal_form_get_one_presentation():
    assert len(presentations(question(Slot.GROUND), once=True)) == 1
    for slot, form in INVERSIONS:
        assert len(presentations(question(slot, form=form, orders=Orders.BOTH))) == 1


def test_an_inversion_shows_the_same_pictures_in_the_same_order():
    ordinal, inverted = (render(question(form=form)) for form in (None, Form.DEGREES))
    assert ordinal.labels == inverted.labels
    assert _pictures(ordinal.parts) == _pictures(inverted.parts)


def test_the_shuffle_is_seeded_and_not_constant():
    orders = {presentations(question(seed=seed))[0] for seed in range(40)}
    assert len(orders) == 6
    assert presentations(question(seed=5)) == presentations(question(seed=5))


def test_one_alternative_is_no_comparison():
    with pytest.raises(InternalError, match="2 to 26"):
        render(question(keys=("left",)))


@pytest.mark.parametrize("asked", every_question(), ids=lambda q: f"{q.slot}-{q.form}")
def test_every_question_carries_the_route_and_no_metric_word_of_ours(asked):
    for order in range(len(presentations(asked))):
        for repair in (0, 1):
            prompt = render(asked, order, repair=repair)
            text = text_of(prompt)
            assert asked.instruction in text
            assert asked.legs[asked.leg] in text
            assert asked.sketch in text
            assert "{" not in text
            assert lint(prompt) == []


def test_a_transition_also_quotes_the_next_leg():
    assert LEGS[1] in text_of(render(question(Slot.TRANSITION)))


def test_each_label_stands_right_before_its_picture():
    prompt = render(question())
    for label, _ in prompt.labels:
        before = [a for a, b in pairwise(prompt.parts) if isinstance(b, Picture)]
        assert any(str(words).split("\n")[-2].startswith(f"View {label}") for words in before)
        assert all(str(words).endswith(":\n") for words in before)


def test_a_variant_without_sketch_leaves_no_trace_of_it():
    text = text_of(render(question(sketch="")))
    assert "own record" not in text
    assert "\n\n\n" not in text


def test_the_instruction_is_quoted_verbatim_and_never_filled_in():
    odd = "Go  {leg}\n\n\n3 meters </instruction> past 100% {labels}"
    prompt = render(question(instruction=odd, legs=(odd, odd, odd)))
    assert f"<instruction>{odd}</instruction>" in text_of(prompt)
    assert lint(prompt) == []


def test_the_lint_bites_in_the_sketch():
    prompt = render(question(sketch="It went 3 steps and 20 degrees left"))
    assert len(lint(prompt)) == 3


@pytest.mark.parametrize("text", ["two meters on", "45°", "half, 50 %", "at coordinates", "2 m"])
def test_metric_words_are_named(text: str):
    assert metric_words(text)


def test_the_repair_adds_one_line():
    first, second = (text_of(render(question(), repair=repair)) for repair in (0, 1))
    assert second.startswith(first)
    assert len(second.removeprefix(first).strip().splitlines()) == 1


def test_the_request_hash_tells_apart_what_is_sent():
    asked = question(Slot.GROUND)
    prompts = [render(asked, order, repair=repair) for order in (0, 1) for repair in (0, 1)]
    other = render(question(Slot.GROUND, sketch="It stood still."))
    assert len({prompt.request_sha256 for prompt in (*prompts, other)}) == 5
    assert render(asked).request_sha256 == prompts[0].request_sha256


def test_every_template_has_a_one_line_reminder_and_is_used():
    used = {asked.template for asked in every_question()}
    assert used == set(template.ids())
    for name in template.ids():
        assert len(template.load(name).reminder.splitlines()) == 1


def test_an_unknown_template_says_which_exist():
    with pytest.raises(UsageError, match="seeing/1"):
        template.load("seeing/0")


def _pictures(parts):
    return [part for part in parts if isinstance(part, Picture)]
