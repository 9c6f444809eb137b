from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from c2nav_engine.contract.question import Picture
from c2nav_engine.errors import InternalError
from c2nav_engine.navigator.requests import Look, Rig, Seen
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.recorded import open_trace, read_trace
from c2nav_engine.runner.recording import TraceWriter
from tests.helpers.exchanges import FakeEpisode, fake_episode, write_episode


def without_ring_bytes(exchange: Exchange) -> Exchange:
    """As a trace keeps it: of the ring's twelve views only the digests."""
    if isinstance(exchange.request, Look) and exchange.request.rig is Rig.RING:
        assert isinstance(exchange.response, Seen)
        views = tuple(
            replace(view, picture=replace(view.picture, jpeg=b""))
            for view in exchange.response.views
        )
        return replace(exchange, response=replace(exchange.response, views=views))
    return exchange


def test_a_trace_reads_back_as_what_was_written(tmp_path: Path) -> None:
    episode = fake_episode(9)
    digest = write_episode(tmp_path / "a.mcap", episode)
    trace = read_trace(tmp_path / "a.mcap")
    assert trace.exchanges == tuple(map(without_ring_bytes, episode.exchanges))
    assert trace.header == episode.header
    assert trace.footer == episode.footer
    assert trace.sha256 == digest
    assert trace.complete


def test_writing_twice_gives_the_same_bytes(tmp_path: Path) -> None:
    assert write_episode(tmp_path / "a.mcap", fake_episode(4)) == write_episode(
        tmp_path / "b.mcap", fake_episode(4)
    )


def test_what_was_read_can_be_written_again(tmp_path: Path) -> None:
    write_episode(tmp_path / "a.mcap", fake_episode(5))
    first = read_trace(tmp_path / "a.mcap")
    again = FakeEpisode(first.header, first.exchanges, first.footer)
    write_episode(tmp_path / "b.mcap", again)
    assert read_trace(tmp_path / "b.mcap").exchanges == first.exchanges


def test_a_decision_alone_comes_with_all_its_pictures(tmp_path: Path) -> None:
    episode = fake_episode(6)
    write_episode(tmp_path / "a.mcap", episode)
    decisions = [each for each in episode.exchanges if each.decision is not None]
    with open_trace(tmp_path / "a.mcap") as trace:
        assert trace.decision_count == len(decisions)
        assert [trace.decision(number) for number in range(len(decisions))] == decisions


def test_decisions_without_pictures_differ_in_nothing_else(tmp_path: Path) -> None:
    write_episode(tmp_path / "a.mcap", fake_episode(6))
    with open_trace(tmp_path / "a.mcap") as trace:
        for light in trace.decisions():
            assert light.decision is not None
            full = trace.decision(light.decision)
            assert light.response == full.response and light.step == full.step
            assert light.ranked == full.ranked or light.ranked is not None


def test_any_picture_is_found_by_its_digest(tmp_path: Path) -> None:
    episode = fake_episode(4)
    write_episode(tmp_path / "a.mcap", episode)
    seen = next(each for each in episode.exchanges if isinstance(each.response, Seen)).response
    assert isinstance(seen, Seen)
    picture = seen.views[0].picture
    with open_trace(tmp_path / "a.mcap") as trace:
        assert Picture.of(trace.picture(picture.sha256), width_px=64, height_px=64) == picture


def test_an_exchange_out_of_order_is_refused(tmp_path: Path) -> None:
    episode = fake_episode(1)
    expected = pytest.raises(InternalError, match="expected exchange 0, came 3")
    with TraceWriter(tmp_path / "a.mcap", episode.header) as writer, expected:
        writer.write(episode.exchanges[3])
    assert not (tmp_path / "a.mcap").exists()
