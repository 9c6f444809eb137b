from __future__ import annotations

import pytest

from c2nav_engine.contract.route import parse_english
from c2nav_engine.contract.route_model import ROUTE_TEMPLATE, parse_with_model
from c2nav_engine.errors import RankerStopped, RankerUnavailable

TEXT = "Exit the bedroom, turn left and walk to the rug. Wait by the lamp."
CUT = ("Exit the bedroom", "turn left and walk to the rug", "Wait by the lamp")


@pytest.mark.parametrize(
    "answer",
    [
        "\n".join(CUT),
        "1. Exit the bedroom,\n2. turn left and walk to the rug.\n3) Wait by the lamp.",
        "- exit the bedroom\n\n- Turn left and walk to the rug\n- wait by the lamp",
        '```json\n["Exit the bedroom", "turn left and walk to the rug", "Wait by the lamp"]\n```',
    ],
)
def test_a_cut_of_the_very_words_is_taken_verbatim(answer: str) -> None:
    ladder = parse_with_model(TEXT, lambda _: answer)
    assert ladder.legs == CUT
    assert ladder.parser == "model"
    assert tuple(TEXT[a:b] for a, b in ladder.spans) == ladder.legs


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        ("", "14 words are missing"),
        ("Exit the bedroom\nturn left and walk to the rug", "4 words are missing"),
        ("Exit the room\nturn left", "leg 1 is not the instruction's next words"),
        ("turn left and walk to the rug\nExit the bedroom\nWait by the lamp", "leg 1 is not"),
        (f"{TEXT}\nThen rest.", "leg 2 is not"),
        ("Exit the bedroom, turn left and walk to\nthe\nrug. Wait by the lamp.", "leg 2 holds"),
        ("[1, 2", "leg 1 is not"),
    ],
)
def test_anything_else_falls_back_and_says_why(answer: str, why: str) -> None:
    ladder = parse_with_model(TEXT, lambda _: answer)
    assert ladder.legs == parse_english(TEXT).legs
    assert ladder.parser.startswith("english (fallback: ")
    assert why in ladder.parser


def test_a_server_that_gives_up_on_one_text_is_a_fallback() -> None:
    def complete(text: str) -> str:
        raise RankerUnavailable("no answer after 3 attempts")

    ladder = parse_with_model(TEXT, complete)
    assert ladder.parser == "english (fallback: no answer: no answer after 3 attempts)"


def test_a_server_that_stops_the_run_is_no_fallback() -> None:
    def complete(text: str) -> str:
        raise RankerStopped("quota used up")

    with pytest.raises(RankerStopped):
        parse_with_model(TEXT, complete)


def test_the_model_is_asked_once_with_the_verbatim_text() -> None:
    asked: list[str] = []
    parse_with_model(TEXT, lambda text: asked.append(text) or TEXT)
    assert asked == [ROUTE_TEMPLATE.format(instruction=TEXT)]
    assert f"<instruction>{TEXT}</instruction>" in asked[0]


def test_braces_in_an_instruction_are_only_characters() -> None:
    text = "Walk to the {sofa} and stop"
    assert parse_with_model(text, lambda _: text).legs == (text,)
