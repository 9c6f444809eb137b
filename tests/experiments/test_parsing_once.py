"""A model parses each instruction once a run; what it says is kept and shared."""

from __future__ import annotations

import pytest

from c2nav_engine.contract.route import parse_english
from c2nav_engine.errors import RankerStopped, UsageError
from c2nav_engine.experiments.parsing import parse_for, parser_named

TEXT = "Leave the bedroom and walk to the sofa. Stop at the lamp."


def test_the_english_parser_needs_no_server(tmp_path):
    def never():
        raise AssertionError

    assert parse_for("english", never, tmp_path)(TEXT) == parse_english(TEXT)


def test_a_model_is_asked_once_for_all_workers_of_a_run(tmp_path):
    asked: list[str] = []

    def complete(text: str) -> str:
        asked.append(text)
        return "Leave the bedroom and walk to the sofa.\nStop at the lamp."

    first = parse_for("model", lambda: complete, tmp_path)(TEXT)
    second = parse_for("model", lambda: complete, tmp_path)(TEXT)
    assert first == second
    assert first.parser == "model"
    assert [leg.split()[0] for leg in first.legs] == ["Leave", "Stop"]
    assert len(asked) == 1


def test_a_fallback_is_kept_with_its_reason(tmp_path):
    ladder = parse_for("model", lambda: lambda _text: "Dance!", tmp_path)(TEXT)
    assert ladder.legs == parse_english(TEXT).legs
    assert ladder.parser.startswith("english (fallback: ")


def test_a_server_that_is_gone_stops_the_run(tmp_path):
    def complete(text: str) -> str:
        raise RankerStopped("no")

    with pytest.raises(RankerStopped):
        parse_for("model", lambda: complete, tmp_path)(TEXT)
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_parser_is_named():
    with pytest.raises(UsageError, match=r"english, model.*came 'french'"):
        parser_named("french")
