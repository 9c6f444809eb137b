from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import av
import numpy as np
import pyarrow.parquet as pq
import pytest

from c2nav_engine.contract.outcome import Ordering, Tie
from c2nav_engine.errors import UsageError
from c2nav_engine.navigator.requests import Move
from c2nav_engine.runner.recorded import read_trace
from c2nav_engine.traces import TraceFile, check, first_difference
from c2nav_engine.traces.exports import (
    Review,
    VideoStyle,
    export_merged,
    export_ndjson,
    export_parquet,
    export_redacted,
    export_rrd,
    export_video,
    reviews_of,
)
from c2nav_engine.traces.moments import parsed, picture_table
from c2nav_engine.traces.topics import IMAGE_TOPICS
from c2nav_engine.world.scene import Material, Piece, scene_of
from tests.helpers.exchanges import FakeEpisode, write_episode, write_fake


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[TraceFile, FakeEpisode]:
    path = tmp_path_factory.mktemp("traces") / "a.mcap"
    episode = write_fake(path, cycles=8, side_px=24)
    return TraceFile(path), episode


@pytest.fixture
def trace(made: tuple[TraceFile, FakeEpisode]) -> TraceFile:
    return made[0]


@pytest.fixture
def episode(made: tuple[TraceFile, FakeEpisode]) -> FakeEpisode:
    return made[1]


# ---------------------------------------------------------------- ndjson


def test_every_line_is_json_and_every_message_a_line(trace: TraceFile, tmp_path: Path) -> None:
    count = export_ndjson(trace, tmp_path / "a.ndjson")
    lines = [json.loads(line) for line in (tmp_path / "a.ndjson").read_text("utf-8").splitlines()]
    assert len(lines) == count == 1 + sum(1 for _ in trace.messages())
    assert lines[0]["metadata"]["sha256"] == trace.sha256
    decisions = [line["message"] for line in lines[1:] if line["topic"] == "/decision"]
    assert [each.get("decision", 0) for each in decisions] == list(range(len(decisions)))
    assert decisions[0]["question"]["instruction"].startswith("Walk past the red sofa")


def test_pictures_in_lines_are_digests(trace: TraceFile, tmp_path: Path) -> None:
    export_ndjson(trace, tmp_path / "a.ndjson")
    held = {
        picture.sha256
        for stored in trace.messages("/decision")
        for picture in picture_table(parsed(stored))
    }
    named = re.findall(r'"sha256": "([0-9a-f]{64})"', (tmp_path / "a.ndjson").read_text("utf-8"))
    assert held <= set(named)


# ---------------------------------------------------------------- tables


def test_one_row_a_decision(trace: TraceFile, episode: FakeEpisode, tmp_path: Path) -> None:
    count = export_parquet([trace, trace], tmp_path / "d.parquet")
    rows = pq.read_table(tmp_path / "d.parquet").to_pylist()
    decisions = [each for each in episode.exchanges if each.decision is not None]
    assert len(rows) == count == 2 * len(decisions)
    for row, exchange in zip(rows, decisions, strict=False):
        winner = exchange.response.winner if isinstance(exchange.response, Ordering) else None
        if row["asked"]:
            assert row["winner"] == winner
        assert row["step"] == exchange.step
        assert set(row["offered"]) <= set(row["keys"])
        if exchange.ranked is not None:
            assert row["queries"] == len(exchange.ranked.queries)
            assert row["answers"][0] == exchange.ranked.queries[0].reply.text
            assert sorted(row["presented"]) == sorted(row["keys"])
    assert {row["by"] for row in rows} == {"ranker", "override", "rule"}


def test_one_row_a_step(trace: TraceFile, episode: FakeEpisode, tmp_path: Path) -> None:
    export_parquet([trace], tmp_path / "s.parquet", table="steps")
    rows = pq.read_table(tmp_path / "s.parquet").to_pylist()
    moves = [each for each in episode.exchanges if isinstance(each.request, Move)]
    taken = [(step.action.value, pose) for each in moves for step, pose in _steps(each)]
    assert [row["step"] for row in rows] == list(range(1, len(taken) + 1))
    assert [row["action"] for row in rows] == [action for action, _ in taken]
    assert [(row["x_m"], row["z_m"]) for row in rows] == [
        (pose.position_m[0], pose.position_m[2]) for _, pose in taken
    ]
    assert all(row["goal_distance_m"] > 0 for row in rows)


def _steps(exchange):
    return zip(exchange.response.steps, exchange.truth.poses, strict=True)


def test_an_unknown_table_is_refused(trace: TraceFile, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="decisions, steps"):
        export_parquet([trace], tmp_path / "x.parquet", table="frames")


# ---------------------------------------------------------------- redacted


def test_a_redacted_trace_holds_no_picture_and_is_sound(trace: TraceFile, tmp_path: Path) -> None:
    export_redacted(trace, tmp_path / "r.mcap")
    redacted = TraceFile(tmp_path / "r.mcap")
    assert not set(redacted.topics) & set(IMAGE_TOPICS)
    assert b"\xff\xd8\xff" not in b"".join(stored.data for stored in redacted.messages())
    assert check(tmp_path / "r.mcap") == []
    assert redacted.facts["redacted_from"] == trace.sha256
    assert redacted.facts["licence"] == "CC0-1.0"


def test_a_redacted_trace_tells_the_same_story(trace: TraceFile, tmp_path: Path) -> None:
    export_redacted(trace, tmp_path / "r.mcap")
    whole, redacted = read_trace(trace.path), read_trace(tmp_path / "r.mcap")
    assert redacted.header == whole.header
    assert [each.response for each in redacted.exchanges if each.decision is not None] == [
        each.response for each in whole.exchanges if each.decision is not None
    ]
    difference = first_difference(trace, TraceFile(tmp_path / "r.mcap"))
    assert difference is not None and difference.topic in IMAGE_TOPICS


def test_a_child_of_a_redacted_trace_names_pictures_without_making_any_up(
    trace: TraceFile, tmp_path: Path
) -> None:
    export_redacted(trace, tmp_path / "r.mcap")
    redacted = read_trace(tmp_path / "r.mcap")
    child = FakeEpisode(redacted.header, redacted.exchanges, redacted.footer)
    write_episode(tmp_path / "c.mcap", child)
    assert check(tmp_path / "c.mcap") == []
    assert not set(TraceFile(tmp_path / "c.mcap").topics) & set(IMAGE_TOPICS)
    assert read_trace(tmp_path / "c.mcap").exchanges == redacted.exchanges


# ---------------------------------------------------------------- merged


def review(trace: TraceFile, number: int) -> Review:
    return Review(
        id=f"e{number}",
        trace_sha256=trace.sha256,
        decision=number,
        author="P1",
        kind="ranking",
        outcome=Tie((("left", "front"),)) if number % 2 else Ordering.of("left", "front"),
        reason="the door",
        blind=False,
        model_seen=True,
        target="e0",
        when_s=12.5,
        extra={"queue": "seeing"},
    )


def test_merging_adds_reviews_and_changes_nothing_else(trace: TraceFile, tmp_path: Path) -> None:
    reviews = [review(trace, 3), review(trace, 0), replace(review(trace, 1), outcome=None)]
    export_merged(trace, tmp_path / "m.mcap", reviews=reviews)
    merged = TraceFile(tmp_path / "m.mcap")
    assert reviews_of(merged) == [reviews[1], reviews[2], reviews[0]]
    assert check(tmp_path / "m.mcap") == []
    assert read_trace(merged.path).exchanges == read_trace(trace.path).exchanges
    assert merged.facts["merged_from"] == trace.sha256
    assert reviews_of(trace) == []


def test_a_review_of_another_trace_is_refused(trace: TraceFile, tmp_path: Path) -> None:
    foreign = replace(review(trace, 0), trace_sha256="0" * 64)
    with pytest.raises(UsageError, match="review e0 is of 000000000000"):
        export_merged(trace, tmp_path / "m.mcap", reviews=[foreign])
    with pytest.raises(UsageError, match="decision 999"):
        export_merged(trace, tmp_path / "m.mcap", reviews=[replace(review(trace, 0), decision=999)])
    assert list(tmp_path.iterdir()) == []


# ---------------------------------------------------------------- video


def test_the_film_is_plain_h264_that_grows_with_the_episode(
    trace: TraceFile, tmp_path: Path
) -> None:
    style = VideoStyle(width_px=640, height_px=360, frames_per_s=4)
    frames = export_video(trace, tmp_path / "a.mp4", style=style)
    with av.open(str(tmp_path / "a.mp4")) as film:
        stream = film.streams.video[0]
        assert (stream.codec_context.name, stream.pix_fmt) == ("h264", "yuv420p")
        assert (stream.width, stream.height, stream.frames) == (640, 360, frames)
        pictures = [frame.to_ndarray(format="rgb24") for frame in film.decode(stream)]
    assert len(pictures) == frames
    assert len({picture.tobytes() for picture in pictures}) > frames // 4


def test_a_film_of_a_redacted_trace_has_words_and_map(trace: TraceFile, tmp_path: Path) -> None:
    export_redacted(trace, tmp_path / "r.mcap")
    style = VideoStyle(width_px=640, height_px=360)
    assert export_video(TraceFile(tmp_path / "r.mcap"), tmp_path / "r.mp4", style=style) > 0


@pytest.mark.parametrize("size", [(641, 360), (320, 180)])
def test_a_film_too_small_to_read_is_refused(
    trace: TraceFile, tmp_path: Path, size: tuple[int, int]
) -> None:
    style = VideoStyle(width_px=size[0], height_px=size[1])
    with pytest.raises(UsageError, match="at least 640 × 360"):
        export_video(trace, tmp_path / "a.mp4", style=style)


# ---------------------------------------------------------------- rerun


RERUN = shutil.which("rerun", path=str(Path(sys.executable).parent))
needs_rerun = pytest.mark.skipif(RERUN is None, reason="rerun is not installed (extra `rerun`)")


def rerun(*words: str) -> str:
    assert RERUN is not None
    done = subprocess.run([RERUN, "rrd", *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


def entities(path: Path) -> set[str]:
    return set(re.findall(r"^(/[\w/ ]+): \d+", rerun("stats", str(path)), re.MULTILINE))


def house():
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1]], np.float32)
    triangle = np.array([[0, 1, 2]], np.int32)
    texture = np.full((4, 4, 4), 200, np.uint8)
    uvs = np.zeros((1, 3, 2), np.float32)
    plain, papered = Material("floor", (0.5, 0.5, 0.5, 1.0)), Material("paper", texture=texture)
    return scene_of(
        "house",
        [Piece("floor", plain, corners, triangle), Piece("wall", papered, corners, triangle, uvs)],
    )


@needs_rerun
def test_a_recording_holds_views_depth_trail_mesh_ladder_and_words(
    trace: TraceFile, tmp_path: Path
) -> None:
    export_rrd(trace, tmp_path / "a.rrd", scene=house())
    wanted = {
        *(f"/world/camera/{key}/image" for key in ("left", "front", "right")),
        *(f"/glance/{sector}" for sector in range(6)),
        "/world/depth/front/image",
        "/world/trail",
        "/world/candidates",
        "/world/goal",
        "/world/mesh/0",
        "/world/mesh/1",
        "/lookback/now",
        "/lookback/back",
        "/ladder/ground",
        "/ladder/verdict",
        "/decision",
        "/sketch",
        "/goal_distance_m",
        "/log",
    }
    assert wanted <= entities(tmp_path / "a.rrd")
    assert "verified without error" in rerun("verify", str(tmp_path / "a.rrd"))
    timelines = rerun("print", "-vv", str(tmp_path / "a.rrd"))
    assert "step" in timelines and "exchange" in timelines


@needs_rerun
def test_two_runs_lie_side_by_side(trace: TraceFile, tmp_path: Path) -> None:
    write_fake(tmp_path / "b.mcap", cycles=4, seed=1)
    export_rrd(trace, tmp_path / "ab.rrd", other=TraceFile(tmp_path / "b.mcap"))
    found = entities(tmp_path / "ab.rrd")
    for root in ("/run_a", "/run_b"):
        assert {f"{root}/world/trail", f"{root}/decision", f"{root}/ladder/ground"} <= found
    assert "/decision" not in found
