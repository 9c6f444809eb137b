from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest

from app.cli import main
from app.reviews.audit import WHOLE, AuditBook, store_beside
from app.reviews.events import Event, Kind
from app.reviews.store import store_of
from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.runner.recorded import read_trace
from c2nav_engine.traces import TraceFile, first_difference
from c2nav_engine.traces.exports import reviews_of
from tests.helpers.exchanges import write_fake


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """A run folder with two traces."""
    folder = tmp_path / "run"
    (folder / "traces").mkdir(parents=True)
    for name, cycles in (("a", 4), ("b", 5)):
        write_fake(folder / "traces" / f"{name}.mcap", cycles=cycles, side_px=16)
    return folder


def export(*words: object) -> int:
    with pytest.raises(SystemExit) as stopped:
        main(["trace", "export", *map(str, words)])
    assert isinstance(stopped.value.code, int)
    return stopped.value.code


@pytest.mark.parametrize(
    ("form", "suffix"),
    [("html", ".html"), ("ndjson", ".ndjson"), ("parquet", ".parquet"), ("video", ".mp4")],
)
def test_a_file_stands_beside_its_trace(form: str, suffix: str, run: Path):
    trace = run / "traces" / "a.mcap"
    assert export(trace, "--to", form) == 0
    assert trace.with_suffix(suffix).stat().st_size > 0


def test_a_redacted_trace_reads_as_the_same_run(run: Path, tmp_path: Path):
    trace, out = run / "traces" / "a.mcap", tmp_path / "r.mcap"
    assert export(trace, "--to", "redacted", "--out", out) == 0
    assert out.stat().st_size < trace.stat().st_size
    assert len(read_trace(out).exchanges) == len(read_trace(trace).exchanges)


def test_several_traces_make_one_table(run: Path, tmp_path: Path):
    traces, out = sorted((run / "traces").glob("*.mcap")), tmp_path / "all.parquet"
    assert export(*traces, "--to", "parquet", "--out", out) == 0
    assert len(set(pq.read_table(out)["trace_sha256"].to_pylist())) == 2
    assert export(*traces, "--to", "parquet", "--table", "steps", "--out", out) == 0
    assert "yaw_rad" in pq.read_table(out).column_names


def test_several_traces_go_into_a_folder(
    run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    traces = sorted((run / "traces").glob("*.mcap"))
    assert export(*traces, "--to", "ndjson", "--out", tmp_path / "lines", "--json") == 0
    said: dict[str, Any] = json.loads(capsys.readouterr().out)
    assert [Path(each["file"]).name for each in said["exports"]] == ["a.ndjson", "b.ndjson"]
    assert all(Path(each["file"]).stat().st_size == each["bytes"] for each in said["exports"])


def review(trace_sha256: str, **changes: Any) -> Event:
    plain: dict[str, Any] = {
        "id": "e1",
        "kind": Kind.RANKING,
        "author": "Ann Example",
        "trace_sha256": trace_sha256,
        "decision": 0,
        "said": Ordering.of("left", "front"),
        "when_s": 12.0,
    }
    return Event(**(plain | changes))


def test_a_merged_trace_carries_the_reviews_of_its_run_under_pseudonyms(run: Path, tmp_path: Path):
    trace, out = run / "traces" / "a.mcap", tmp_path / "m.mcap"
    sha256 = read_trace(trace).sha256
    with store_of(run) as store:
        store.append([review(sha256), review("f" * 64, id="e2")])
    assert export(trace, "--to", "merged", "--out", out) == 0
    with TraceFile(out) as merged:
        (found,) = reviews_of(merged)
    assert (found.id, found.decision, found.outcome) == ("e1", 0, Ordering.of("left", "front"))
    assert found.author == "P1"
    with TraceFile(trace) as a, TraceFile(out) as b:
        difference = first_difference(a, b)
    assert difference is not None
    assert "review" in str(difference)


def test_everything_that_can_be_said_in_the_inspector_can_be_merged(run: Path, tmp_path: Path):
    trace, out = run / "traces" / "a.mcap", tmp_path / "m.mcap"
    book = AuditBook(store_beside(trace), read_trace(trace).sha256)
    for kind, decision in ((Kind.REVEAL, 0), (Kind.WRONG, 1), (Kind.NOTE, 1), (Kind.TAG, 1)):
        book.add(kind, decision, who="ann", seen=True, words="dark", extra={"tag": "dark"})
    book.add(Kind.BETTER, 1, who="ann", seen=True, said=Ordering.of("left"))
    book.add(Kind.LEG_END, WHOLE, who="ann", seen=True, extra={"leg": "0", "at_m": "1.5"})
    assert book.undo("ann") == WHOLE
    assert book.redo("ann") == WHOLE
    assert book.opinions()["ann", WHOLE].leg_ends_m == {0: 1.5}
    assert export(trace, "--to", "merged", "--out", out) == 0
    with TraceFile(out) as merged:
        kinds = [found.kind for found in reviews_of(merged)]
    assert sorted(kinds) == sorted(
        ["reveal", "wrong", "note", "tag", "better", "leg-end", "undo", "redo"]
    )


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("a.mcap", "--to", "merged"), "expected reviews at"),
        (("a.mcap", "--to", "html", "--with", "b.mcap"), "--with for rrd or merged"),
        (("a.mcap", "b.mcap", "--to", "video", "--out", "one.mp4"), "expected a folder"),
        (("a.mcap", "b.mcap", "--to", "html"), "one family"),
        (("a.mcap", "--to", "parquet", "--table", "chairs"), "decisions, steps"),
    ],
)
def test_what_cannot_be_exported_is_refused_with_words(
    words: tuple[str, ...], said: str, run: Path, capsys: pytest.CaptureFixture[str]
):
    given = [run / "traces" / word if word.endswith(".mcap") else word for word in words]
    assert export(*given) == 2
    assert said in capsys.readouterr().err
