from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from c2nav_engine.contract.route import leg_spans, parse_english, whole
from c2nav_engine.contract.route_clauses import words_of
from c2nav_engine.errors import EpisodeError

VOCABULARY = [
    *("walk", "turn", "left", "right", "stop", "wait", "and", "then", "after", "once", "you"),
    *("the", "a", "couch", "stairs", "door", "kitchen", "past", "into", ",", ".", ";", "\n"),
    *("go", "straight", "it", "there", "enter", "2.5", "first", "exit", "before", "stopping"),
]


def texts(text: str) -> list[str]:
    return [word.text for word in words_of(text)]


@given(st.lists(st.sampled_from(VOCABULARY), min_size=1, max_size=40))
def test_every_word_is_kept_once_and_in_order(parts: list[str]) -> None:
    text = " ".join(parts)
    if not texts(text):
        return
    for ladder in (parse_english(text), whole(text)):
        assert [word for leg in ladder.legs for word in texts(leg)] == texts(text)
        assert tuple(text[a:b] for a, b in ladder.spans) == ladder.legs
        assert all(a < b for a, b in ladder.spans)
        ends = [b for _, b in ladder.spans]
        assert all(b <= a for b, (a, _) in zip(ends, ladder.spans[1:], strict=False))


@given(st.lists(st.sampled_from(VOCABULARY), min_size=1, max_size=40))
def test_spans_come_back_from_the_legs_alone(parts: list[str]) -> None:
    text = " ".join(parts)
    if texts(text):
        ladder = parse_english(text)
        assert leg_spans(text, ladder.legs) == ladder.spans


CASES = {
    "Exit the bedroom and turn left. Walk on passing the gray couch and stop near the rug. ": (
        "Exit the bedroom",
        "and turn left. Walk on passing the gray couch",
        "and stop near the rug",
    ),
    "Walk past the couch, then go up the stairs and wait at the top.": (
        "Walk past the couch",
        "then go up the stairs and wait at the top",
    ),
    "After passing the couch, turn left and enter the kitchen.": (
        "After passing the couch",
        "turn left and enter the kitchen",
    ),
    "After the couch, turn left. Walk to the table.": (
        "After the couch, turn left",
        "Walk to the table",
    ),
    "Walk past the table and the chairs, and then stop.": (
        "Walk past the table and the chairs, and then stop",
    ),
    "Go to the clock. Stop there.": ("Go to the clock. Stop there",),
    "Go through the door on the right.Turn left and stop in the closet": (
        "Go through the door on the right",
        "Turn left and stop in the closet",
    ),
    "walk past the couch turn left go into the hall": (
        "walk past the couch",
        "turn left go into the hall",
    ),
    "Enter the walk in closet": ("Enter the walk in closet",),
    "Take the exit, turn left to enter the hall": ("Take the exit", "turn left to enter the hall"),
    "Turn left": ("Turn left",),
    "Walk 2.5 meters past the couch": ("Walk 2.5 meters past the couch",),
    "Walk to the sofa. You will see a lamp. Turn right and stop by the bed": (
        "Walk to the sofa. You will see a lamp",
        "Turn right and stop by the bed",
    ),
    "Go down the hall stopping just inside the door": (
        "Go down the hall",
        "stopping just inside the door",
    ),
}


@pytest.mark.parametrize("text", CASES)
def test_clauses_become_legs(text: str) -> None:
    assert parse_english(text).legs == CASES[text]


def test_a_text_without_words_is_refused() -> None:
    with pytest.raises(EpisodeError, match="expected an instruction with words"):
        parse_english(" .\n")


def test_a_leg_from_elsewhere_has_no_span() -> None:
    with pytest.raises(EpisodeError, match="came 'Walk on'"):
        leg_spans("Turn left", ("Walk on",))


def test_the_whole_instruction_is_one_leg() -> None:
    assert whole(" Exit. Turn left. ").legs == ("Exit. Turn left",)
