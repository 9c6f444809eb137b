"""`c2nav question`: what was asked, what was said, what it meant, and what was committed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.commands.question import question
from c2nav_engine.contract.prompt import Prompt
from c2nav_engine.contract.question import Picture
from c2nav_engine.contract.render import text_of
from c2nav_engine.errors import TraceError, UsageError
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.recorded import read_trace
from c2nav_engine.traces.words import outcome_words
from tests.helpers.exchanges import write_fake


@pytest.fixture(scope="module")
def trace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("asked") / "a.mcap"
    write_fake(path, cycles=8, side_px=16)
    return path


def asked(trace: Path) -> list[Exchange]:
    return [e for e in read_trace(trace).exchanges if isinstance(e.request, Ask)]


def number_of(exchange: Exchange) -> int:
    assert exchange.decision is not None
    return exchange.decision


def prompts_of(exchange: Exchange) -> list[Prompt]:
    return [query.prompt for query in exchange.ranked.queries] if exchange.ranked else []


def test_every_query_stands_as_it_was_sent_with_what_it_meant(
    trace: Path, capsys: pytest.CaptureFixture[str]
):
    for exchange in asked(trace):
        assert question(trace, number_of(exchange)) == 0
        said = capsys.readouterr().out
        for query in exchange.ranked.queries if exchange.ranked else ():
            assert text_of(query.prompt) in said
            assert f"read as: {outcome_words(query.outcome)}" in said
        assert "--- committed: " in said


def test_the_json_names_each_request_and_the_pictures_are_written_as_sent(
    trace: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    exchange = next(e for e in asked(trace) if len(prompts_of(e)) > 1)
    assert question(trace, number_of(exchange), pictures=tmp_path, json=True) == 0
    told = json.loads(capsys.readouterr().out)
    prompts = prompts_of(exchange)
    assert [q["request_sha256"] for q in told["queries"]] == [p.request_sha256 for p in prompts]
    pictures = {
        part.sha256: part.jpeg for p in prompts for part in p.parts if isinstance(part, Picture)
    }
    for sha256, jpeg in pictures.items():
        assert (tmp_path / f"{sha256}.jpg").read_bytes() == jpeg


def test_what_was_settled_without_a_question_and_what_does_not_exist_are_refused(trace: Path):
    settled = next(
        e
        for e in read_trace(trace).exchanges
        if e.decision is not None and not isinstance(e.request, Ask)
    )
    with pytest.raises(UsageError, match="without a question"):
        question(trace, number_of(settled))
    with pytest.raises(TraceError, match="came 9999"):
        question(trace, 9999)
