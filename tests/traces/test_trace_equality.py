from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.navigator.requests import Move, Moved
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.traces import Difference, TraceFile, first_difference
from tests.helpers.exchanges import FakeEpisode, fake_episode, write_episode


def compared(
    folder: Path, change: Callable[[Exchange], Exchange], *, other: FakeEpisode | None = None
) -> Difference | None:
    episode = fake_episode(4, side_px=16)
    changed = other or replace(episode, exchanges=tuple(map(change, episode.exchanges)))
    write_episode(folder / "a.mcap", episode)
    write_episode(folder / "b.mcap", changed)
    return first_difference(TraceFile(folder / "a.mcap"), TraceFile(folder / "b.mcap"))


def later(exchange: Exchange) -> Exchange:
    """The same exchange on a slower day."""
    override = exchange.override and replace(exchange.override, when_s=99.0)
    ranked = exchange.ranked
    if ranked is not None:
        slow = {"latency_s": 9.0, "tokens_in": None, "cached": True, "retry_after_s": 3.0}
        queries = [replace(q, reply=replace(q.reply, **slow)) for q in ranked.queries]
        ranked = replace(ranked, queries=tuple(queries))
    return replace(exchange, override=override, ranked=ranked, wall_s={"render": 1.0})


def test_the_wall_clock_does_not_count(tmp_path: Path) -> None:
    assert compared(tmp_path, later) is None


def test_the_first_difference_is_named_with_field_and_values(tmp_path: Path) -> None:
    def change(exchange: Exchange) -> Exchange:
        if isinstance(exchange.response, Moved) and exchange.step > 0:
            steps = [replace(step, moved_m=0.125) for step in exchange.response.steps]
            return replace(exchange, response=replace(exchange.response, steps=tuple(steps)))
        return exchange

    found = compared(tmp_path, change)
    assert found is not None
    assert (found.topic, found.field) == ("/control", "move.steps[0].moved_m")
    assert (found.first, found.second) == ("0.0", "0.125")
    assert "exchange" in str(found) and "0.125" in str(found)


def test_another_answer_is_a_difference(tmp_path: Path) -> None:
    def change(exchange: Exchange) -> Exchange:
        if exchange.decision == 2:
            return replace(exchange, response=Ordering.of("next", "stay"))
        return exchange

    found = compared(tmp_path, change)
    assert found is not None
    assert found.topic == "/decision" and found.field.startswith("committed.")


def test_a_longer_trace_differs_where_the_shorter_ends(tmp_path: Path) -> None:
    episode = fake_episode(4, side_px=16)
    shorter = replace(episode, exchanges=episode.exchanges[:-1])
    found = compared(tmp_path, lambda each: each, other=shorter)
    assert found is not None
    assert (found.exchange, found.second) == (len(episode.exchanges) - 1, "nothing")


def test_another_pixel_is_a_difference(tmp_path: Path) -> None:
    other = fake_episode(4, seed=1, side_px=16)
    found = compared(tmp_path, lambda each: each, other=other)
    assert found is not None
    assert (found.topic, found.field) == ("/control", "look.views[0].picture")


@pytest.mark.parametrize("purpose", ["elect", "glance"])
def test_fields_of_requests_count(tmp_path: Path, purpose: str) -> None:
    def change(exchange: Exchange) -> Exchange:
        if isinstance(exchange.request, Move) and exchange.request.purpose == purpose:
            return replace(exchange, request=replace(exchange.request, purpose="other"))
        return exchange

    found = compared(tmp_path, change)
    assert found is not None
    assert (found.field, found.first) == ("move.purpose", repr(purpose))
