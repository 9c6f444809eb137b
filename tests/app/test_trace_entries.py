"""The small picture that stands for a trace in a list."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from app.commands import sources
from app.commands.sources import opened_traces
from c2nav_engine.contract.question import Picture
from c2nav_engine.experiments.spec import Setting
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.recorded import open_trace
from tests.helpers.gallery import copy_of

GOLDEN = Path(__file__).resolve().parents[1] / "golden" / "trace-v1.mcap"


@dataclass
class Decisions:
    """A trace of the given decisions."""

    exchanges: list[Exchange]

    @property
    def decision_count(self) -> int:
        return len(self.exchanges)

    def decision(self, number: int) -> Exchange:
        return self.exchanges[number]


def pictured() -> Exchange:
    with open_trace(GOLDEN) as trace:
        return trace.decision(0)


def without_pictures(exchange: Exchange) -> Exchange:
    assert isinstance(exchange.request, Ask)
    facts = exchange.request.facts
    bare = tuple(replace(candidate, picture=None) for candidate in facts.candidates)
    facts = replace(facts, candidates=bare)
    return replace(exchange, request=replace(exchange.request, facts=facts))


def thumbnail(
    exchanges: list[Exchange], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Picture | None:
    opened = opened_traces([copy_of(GOLDEN, tmp_path)], Setting(source="builtin"))
    (entry,) = opened.entries
    assert entry.thumbnail is not None
    with monkeypatch.context() as patch:
        patch.setattr(sources, "open_trace", lambda _: nullcontext(Decisions(exchanges)))
        return entry.thumbnail()


def test_the_first_decision_that_has_pictures_stands_for_a_trace(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
):
    full = pictured()
    bare = without_pictures(full)
    shown = thumbnail([bare, bare, full], monkeypatch, tmp_path)
    assert shown is not None
    assert shown.jpeg
    assert shown == thumbnail([full], monkeypatch, tmp_path)


def test_a_trace_without_pictures_is_not_read_to_its_end(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
):
    full = pictured()
    assert thumbnail([], monkeypatch, tmp_path) is None
    assert thumbnail([*[without_pictures(full)] * 300, full], monkeypatch, tmp_path) is None
