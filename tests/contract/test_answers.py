from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from c2nav_engine.contract.answers import parse
from c2nav_engine.contract.outcome import (
    Abstention,
    Cardinal,
    Empty,
    Invalid,
    Ordering,
    Refused,
    Tie,
)
from c2nav_engine.contract.presentation import labelled
from c2nav_engine.contract.question import Form, Slot
from c2nav_engine.contract.render import render_as
from c2nav_engine.contract.schemas import answer_schema, choices
from tests.helpers.questions import every_question, question

THREE = render_as(question(), labelled(("left", "front", "right")))
SIX = render_as(question(Slot.GLANCE), labelled(tuple(f"sector{i}" for i in range(6))))
PAIR = render_as(question(Slot.GROUND), labelled(("here", "ahead")))
DIRECT = render_as(question(Slot.DIRECT), labelled(("forward", "left", "right")))
HEADING = render_as(question(form=Form.DEGREES), labelled(("left", "front", "right")))
AROUND = render_as(question(Slot.GLANCE, form=Form.DEGREES), SIX.labels)
PROGRESS = render_as(question(Slot.TRANSITION, form=Form.PROGRESS), labelled(("stay", "next")))
ARRIVED = render_as(question(Slot.GROUND, form=Form.YES_NO), labelled(("here", "ahead")))
ALL = [THREE, SIX, PAIR, DIRECT, HEADING, AROUND, PROGRESS, ARRIVED]

B_A_C = Ordering.of("front", "left", "right")


@pytest.mark.parametrize(
    "text",
    [
        "B > A > C",
        "b>a>c",
        "B, A, C",
        "View B > View A > View C",
        "view b, view a, view c.",
        "Ｂ ＞ Ａ ＞ Ｃ",
        "**B > A > C**",
        "`B > A > C`",
        '{"ranking": "B > A > C"}',
        '{"ranking": ["B", "A", "C"]}',
        '```json\n{"ranking": ["View B", "View A", "View C"]}\n```',
        'Here it is:\n```json\n{"ranking": "B > A > C"}\n```\nGood luck',
        '{"reason": "the sofa", "order": "B > A > C"}',
        "Answer: B > A > C",
        "B > A > C\nThe hallway goes on towards the door.",
        "I looked closely. My ranking is B > A > C, because a sofa is there.",
        "```\nB > A > C\n```",
    ],
)
def test_an_ordering_is_read(text: str):
    assert parse(text, THREE) == B_A_C


@pytest.mark.parametrize("text", ["B", "b", "View B", "View B.", '{"winner": "B"}', "Option B"])
def test_a_single_label_is_a_winner(text: str):
    assert parse(text, THREE) == Ordering((("front",), ("left", "right")))


def test_ties_below_the_top_are_an_ordering_and_at_the_top_a_tie():
    assert parse("B > A = C", THREE) == Ordering((("front",), ("left", "right")))
    assert parse("A = B > C", THREE) == Tie((("left", "front"), ("right",)))
    assert parse("A = B", PAIR) == Tie((("here", "ahead"),))


@pytest.mark.parametrize(
    "text", ["none", "None.", "cannot tell", "I can't tell from these pictures.", "neither"]
)
def test_declining_to_choose_is_an_abstention(text: str):
    assert isinstance(parse(text, THREE), Abstention)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("A > A > C", "duplicate label"),
        ("A > B", "missing label C"),
        ("A > B > Q", "unoffered label Q"),
        ("Q", "unoffered label Q"),
        ('```json\n{"ranking": ["Q"]}\n```', "unoffered label Q"),
        ("A = B", "missing label C"),
        ("Turn 35 degrees left and move 2 m.", "degrees"),
        ("0.87", "a number"),
        ("A > B > C (90%)", "a percentage"),
        ("A > B > C with 90 percent", "a percentage"),
        ("B > A > C, confidence 0.9", "a number"),
        ("STOP", "no label"),
        ("A and also B, or maybe C > A", "two answers"),
        ("A > B > C or C > B > A", "two answers"),
        ("A > B > C, but C is close", "two answers"),
        ('{"ranking": "A > B > C", "answer": "C > B > A"}', "two answers"),
        ('{"ranking": "A", "ranking": "B"}', "two answers"),
        ('{"choice": "A"}', "no answer field"),
        ('{"ranking": {"A": "B"}}', "no answer field"),
        ('{"ranking": ["A", "B"', "broken JSON"),
        ("from worst to best it is C > B > A", "ambiguous prose"),
        ("it is not B > A > C", "ambiguous prose"),
        ("C < B < A", "two answers"),
        ("B" * 5000, "too long"),
        ("The best one is B", "prose without a ranking"),
    ],
)
def test_everything_else_is_rejected_with_its_reason(text: str, reason: str):
    assert parse(text, THREE) == Invalid(reason)


def test_silence_and_refusal_have_their_own_names():
    assert parse("  \n", THREE) == Empty()
    assert parse("I am sorry, I cannot help with driving robots.", THREE) == Refused()
    assert parse("I can’t assist with that.", THREE) == Refused()


def test_direct_action_takes_one_label():
    assert parse("C", DIRECT) == Ordering((("right",), ("forward", "left")))
    assert parse("forward", DIRECT) == Invalid("no label")


@pytest.mark.parametrize(
    ("text", "prompt", "value"),
    [
        ("45", HEADING, 45.0),
        ("-30 degrees", HEADING, -30.0),
        ("−30°", HEADING, -30.0),
        ("30 degrees to the right", HEADING, -30.0),
        ("The heading is 12.5 deg.", HEADING, 12.5),
        ('{"degrees": -90}', HEADING, -90.0),
        ("-170", AROUND, -170.0),
        ("80", PROGRESS, 80.0),
        ("80%", PROGRESS, 80.0),
        ('{"progress": 0}', PROGRESS, 0.0),
        ("yes", ARRIVED, 1.0),
        ("No, the robot has not arrived.", ARRIVED, 0.0),
        ('{"answer": "yes"}', ARRIVED, 1.0),
    ],
)
def test_a_cardinal_answer_is_read(text, prompt, value):
    assert parse(text, prompt) == Cardinal(value)


@pytest.mark.parametrize(
    ("text", "prompt", "reason"),
    [
        ("91", HEADING, "out of range"),
        ("-181", AROUND, "out of range"),
        ("101", PROGRESS, "out of range"),
        ("30 or 40", HEADING, "two answers"),
        ("-30 degrees right", HEADING, "a sign and a side"),
        ("1e3", HEADING, "no number"),
        ("left", HEADING, "no number"),
        ("9" * 400, HEADING, "out of range"),
        ('{"degrees": NaN}', HEADING, "no number"),
        ("yes and no", ARRIVED, "two answers"),
        ("maybe", ARRIVED, "neither yes nor no"),
        ("B > A", ARRIVED, "neither yes nor no"),
    ],
)
def test_a_bad_cardinal_answer_is_rejected(text, prompt, reason):
    assert parse(text, prompt) == Invalid(reason)


PIECES = st.lists(
    st.sampled_from(
        ["A", "B", "C", "a", "View ", " > ", ">", ",", "=", " ", "\n", "{", '"ranking"', ":", "[",
         "]", "}", "```", "json", "none", "yes", "no", "-", "3", "°", "%", "not", "the best", "."]
    ),
    max_size=14,
).map("".join)  # fmt: skip


@given(text=st.one_of(st.text(max_size=300), PIECES), prompt=st.sampled_from(ALL))
@example("[" * 1900, THREE)
@example('{"a":' * 380, THREE)
@example("٣", HEADING)
def test_any_text_is_a_permutation_of_the_offered_or_a_named_non_answer(text, prompt):
    outcome = parse(text, prompt)
    if isinstance(outcome, Ordering | Tie):
        assert prompt.form in {Form.ORDINAL, Form.ACTION}
        named = [key for tier in outcome.tiers for key in tier]
        assert sorted(named) == sorted(key for _, key in prompt.labels)
    elif isinstance(outcome, Cardinal):
        assert prompt.form not in {Form.ORDINAL, Form.ACTION}
        assert -180.0 <= outcome.value <= 180.0
    elif isinstance(outcome, Invalid | Abstention):
        assert outcome.reason
    else:
        assert isinstance(outcome, Empty | Refused)


@pytest.mark.parametrize("asked", every_question(), ids=lambda q: f"{q.slot}-{q.form}")
def test_every_listed_choice_parses(asked):
    prompt = render_as(asked, labelled(asked.keys))
    for choice in choices(prompt):
        assert isinstance(parse(choice, prompt), Ordering | Cardinal)
    (field,) = answer_schema(prompt)["required"]  # pyright: ignore
    assert field in {"ranking", "answer", "degrees", "progress"}


def test_permutations_are_listed_up_to_four_alternatives():
    assert len(choices(THREE)) == 6
    assert choices(SIX) == ()
    assert answer_schema(SIX)["properties"]["ranking"]["minItems"] == 6  # pyright: ignore
