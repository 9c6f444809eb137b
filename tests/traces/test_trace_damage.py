from __future__ import annotations

import os
import random
import signal
from pathlib import Path

import pytest
from mcap.writer import Writer

from c2nav_engine.errors import TraceError, UnfinishedTrace, UsageError
from c2nav_engine.runner.record import EpisodeOutcome, Footer
from c2nav_engine.runner.recorded import Trace, open_trace, read_trace
from c2nav_engine.runner.recording import TraceWriter
from c2nav_engine.traces import check, recover
from tests.helpers.exchanges import FakeEpisode, fake_episode, write_fake


@pytest.fixture
def trace(tmp_path: Path) -> Path:
    write_fake(tmp_path / "whole.mcap")
    return tmp_path / "whole.mcap"


def test_a_sound_trace_has_no_fault(trace: Path) -> None:
    assert check(trace) == []


def test_any_flipped_byte_is_found(trace: Path) -> None:
    data = trace.read_bytes()
    flipped = trace.with_name("flipped.mcap")
    # A prime stride meets every kind of record; the ends hold the magic, footer and index.
    places = {*range(0, len(data), 997), *range(60), *range(len(data) - 60, len(data))}
    for place in sorted(places):
        flipped.write_bytes(data[:place] + bytes([data[place] ^ 0x10]) + data[place + 1 :])
        assert check(flipped), f"the flip at byte {place} of {len(data)} went unseen"


def test_recovering_any_damage_gives_a_trace_or_says_why(trace: Path) -> None:
    data = trace.read_bytes()
    flipped, out = trace.with_name("flipped.mcap"), trace.with_name("out.mcap")
    index_at = len(data) - 17_000  # a stride through all of it, a finer one through the index
    for place in [*range(0, index_at, 9973), *range(index_at, len(data), 1511)]:
        flipped.write_bytes(data[:place] + bytes([data[place] ^ 0x81]) + data[place + 1 :])
        try:
            recover(flipped, out)
        except TraceError:
            continue
        read_trace(out)


def test_reading_a_damaged_trace_says_so(trace: Path) -> None:
    data = bytearray(trace.read_bytes())
    data[len(data) // 2] ^= 0x10
    trace.write_bytes(data)
    with pytest.raises(TraceError, match="damaged trace"):
        read_trace(trace)


def test_an_unfinished_trace_says_what_is_there_and_what_to_do(tmp_path: Path) -> None:
    episode = fake_episode(3, side_px=16)
    part = write_part(tmp_path / "run.mcap", episode)
    with pytest.raises(UnfinishedTrace) as caught:
        open_trace(part)
    text = str(caught.value)
    decisions = sum(each.decision is not None for each in episode.exchanges)
    steps = episode.footer.metrics["steps"]
    assert "unfinished trace" in text
    assert f"{decisions} decisions and {len(episode.exchanges) - decisions} other" in text
    assert f"up to step {steps} " in text
    assert f"c2nav trace recover {part} --out run.recovered.mcap" in text


@pytest.mark.parametrize("content", [b"", b"\x89MCAP0\r\n", b"not a trace at all" * 9])
def test_what_is_no_trace_is_refused_in_words(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "x.mcap"
    path.write_bytes(content)
    with pytest.raises(TraceError):
        open_trace(path)
    with pytest.raises(TraceError, match="nothing to recover"):
        recover(path, tmp_path / "y.mcap")
    assert [file.name for file in tmp_path.iterdir()] == ["x.mcap"]


@pytest.mark.parametrize("topic", ["/decision", "/eval", "/view/front"])
def test_another_program_behind_our_name_is_a_fault(tmp_path: Path, topic: str) -> None:
    path = tmp_path / "foreign.mcap"
    writer = Writer(str(path))
    writer.start()
    schema = writer.register_schema("a", "jsonschema", b"{}")
    channel = writer.register_channel(topic, "json", schema)
    writer.add_message(channel, 0, b"{}", 0)
    writer.add_metadata("c2nav", {"schema_version": "1"})
    writer.finish()
    assert any("is no message" in str(fault) for fault in check(path))


def test_a_missing_file_is_no_fault_of_a_trace(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match=r"none at .*gone\.mcap"):
        check(tmp_path / "gone.mcap")


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match=r"none at .*gone\.mcap"):
        open_trace(tmp_path / "gone.mcap")


def test_recovering_onto_itself_is_refused(trace: Path) -> None:
    with pytest.raises(UsageError, match="another file"):
        recover(trace, trace)


def assert_beginning(found: Trace, episode: FakeEpisode, *, at_least: int) -> None:
    count = len(found.exchanges)
    assert count >= at_least
    for came, written in zip(found.exchanges, episode.exchanges, strict=False):
        assert (came.index, came.step) == (written.index, written.step)
        assert type(came.request) is type(written.request)
    assert found.header == episode.header
    assert not found.complete
    assert found.footer.outcome is EpisodeOutcome.INTERRUPTED


def write_part(path: Path, episode: FakeEpisode) -> Path:
    """As a run leaves it that ends in the middle."""
    with TraceWriter(path, episode.header) as writer:
        for exchange in episode.exchanges:
            writer.write(exchange)
    return path.with_name(f"{path.name}.part")


def test_leaving_without_finishing_leaves_a_part_with_everything(tmp_path: Path) -> None:
    episode = fake_episode(3, side_px=16)
    part = write_part(tmp_path / "a.mcap", episode)
    assert list(tmp_path.iterdir()) == [part]
    found = recover(part, tmp_path / "out.mcap")
    assert not found.complete and found.lost_bytes == 0
    assert_beginning(read_trace(found.path), episode, at_least=len(episode.exchanges))


def test_every_beginning_of_an_unfinished_trace_recovers(tmp_path: Path) -> None:
    episode = fake_episode(2, side_px=16)
    data = write_part(tmp_path / "whole.mcap", episode).read_bytes()
    cut, out = tmp_path / "cut.mcap.part", tmp_path / "out.mcap"
    kept = 0
    for length in range(20_000, len(data), 2999):
        cut.write_bytes(data[:length])
        recover(cut, out)
        assert check(out) == []
        found = read_trace(out)
        assert_beginning(found, episode, at_least=kept)
        kept = len(found.exchanges)
    assert kept > len(episode.exchanges) // 2


def test_every_beginning_of_a_finished_trace_recovers(tmp_path: Path) -> None:
    episode = write_fake(tmp_path / "whole.mcap", cycles=2)
    data = (tmp_path / "whole.mcap").read_bytes()
    cut, out = tmp_path / "cut.mcap", tmp_path / "out.mcap"
    kept = 0
    lost: list[int] = []
    for length in range(20_000, len(data) - 8, 1999):
        cut.write_bytes(data[:length])
        lost.append(recover(cut, out).lost_pictures)
        found = read_trace(out)
        kept, before = len(found.exchanges), kept
        assert kept >= before
        if not found.complete:  # else only the index was missing
            assert_beginning(found, episode, at_least=before)
    # Words lie before pictures: long before the end, every exchange is there, without its pictures.
    assert kept == len(episode.exchanges)
    assert max(lost) > 0 and lost[-1] == 0


def test_a_damaged_chunk_costs_only_itself(tmp_path: Path) -> None:
    write_fake(tmp_path / "whole.mcap")
    data = bytearray((tmp_path / "whole.mcap").read_bytes())
    data[len(data) // 2] ^= 0x10
    (tmp_path / "bad.mcap").write_bytes(data)
    found = recover(tmp_path / "bad.mcap", tmp_path / "good.mcap")
    whole = recover(tmp_path / "whole.mcap", tmp_path / "copy.mcap")
    assert found.damaged == 1
    assert 0 < whole.messages - found.messages < 20
    assert not found.complete and whole.complete
    # What hit the chunk may have hit the closing record too, which nothing else vouches for.
    assert "metrics" in found.unverified and not whole.unverified
    assert whole.lost_pictures == 0


def closing_damage(whole: Path, old: bytes, new: bytes) -> Path:
    """A copy in which the closing record, which has no checksum of its own, reads otherwise."""
    data = whole.read_bytes()
    place = data.rfind(old)
    assert place > 0 and len(old) == len(new)
    damaged = whole.with_name("damaged.mcap")
    damaged.write_bytes(data[:place] + new + data[place + len(old) :])
    return damaged


DAMAGE = {
    "another result": (b'"success": 1', b'"success": 0'),
    "no JSON": (b'"success": 1', b'"success"x 1'),
    "no number": (b'"success": 1', b'"success": Q'),
    "no outcome": (b"stopped", b"stopqed"),
    "another name": (b"metrics", b"metricq"),
}


@pytest.fixture
def reached(tmp_path: Path) -> Path:
    episode = fake_episode(2, side_px=16)
    footer = Footer(EpisodeOutcome.STOPPED, {**episode.footer.metrics, "success": 1})
    with TraceWriter(tmp_path / "reached.mcap", episode.header) as writer:
        for exchange in episode.exchanges:
            writer.write(exchange)
        writer.finish(footer)
    return tmp_path / "reached.mcap"


@pytest.mark.parametrize("name", DAMAGE)
def test_recovery_vouches_for_no_closing_record_that_may_be_damaged(reached: Path, name: str):
    damaged, out = closing_damage(reached, *DAMAGE[name]), reached.with_name("out.mcap")
    with pytest.raises(TraceError, match="damaged trace"):
        read_trace(damaged)
    found = recover(damaged, out)
    assert not found.complete and "outcome" in found.unverified
    assert "nothing missing" not in str(found) and "may be wrong" in str(found)
    recovered = read_trace(out)
    assert not recovered.complete
    assert recovered.footer == Footer(EpisodeOutcome.INTERRUPTED, {}, "")
    assert len(recovered.exchanges) == len(read_trace(reached).exchanges)
    with open_trace(out) as opened:
        kept = opened.file.facts["unverified_outcome"]
    assert kept == ("stopqed" if name == "no outcome" else "stopped")


@pytest.mark.parametrize("name", ["no JSON", "no number", "no outcome"])
def test_a_footer_that_makes_no_sense_is_an_error_of_ours(reached: Path, name: str):
    with (
        open_trace(closing_damage(reached, *DAMAGE[name])) as opened,
        pytest.raises(TraceError, match="in its closing record"),
    ):
        _ = opened.footer


def kill_and_recover(folder: Path, *, seed: int) -> None:
    """Kill a process that writes a trace, at a random moment, and look at what is left."""
    episode = fake_episode(4, seed=1, side_px=32)
    path = folder / "killed.mcap"
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:  # pragma: no cover - it ends by SIGKILL
        with TraceWriter(path, episode.header) as writer:
            for exchange in episode.exchanges:
                writer.write(exchange)
                os.write(writing, b".")
        signal.pause()
    wanted = random.Random(seed).randrange(1, len(episode.exchanges))
    finished = 0
    while finished < wanted:
        finished += len(os.read(reading, wanted - finished))
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    os.close(writing)
    finished += len(os.read(reading, 4096))
    os.close(reading)
    assert not path.exists()
    recover(path.with_name("killed.mcap.part"), folder / "out.mcap")
    assert_beginning(read_trace(folder / "out.mcap"), episode, at_least=finished)


@pytest.mark.parametrize("seed", range(6))
def test_a_kill_loses_no_finished_exchange(tmp_path: Path, seed: int) -> None:
    kill_and_recover(tmp_path, seed=seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(100, 150))
def test_fifty_kills_lose_no_finished_exchange(tmp_path: Path, seed: int) -> None:
    kill_and_recover(tmp_path, seed=seed)
