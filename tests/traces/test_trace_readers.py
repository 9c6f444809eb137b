"""Readers that know nothing of us: the mcap library, foxglove's schemas, rerun's checker."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path

import cv2
import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.geometry import Pose, world_from_camera
from c2nav_engine.traces.generate import PACKAGE, ROOT, generate
from c2nav_engine.traces.topics import IMAGE_TOPICS, TOPICS
from c2nav_engine.traces.viewer_messages import camera_transforms, viewer_pose
from tests.helpers.exchanges import write_fake


@pytest.fixture(scope="module")
def trace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("traces") / "a.mcap"
    write_fake(path, cycles=8, side_px=32)
    return path


def test_the_plain_library_decodes_every_topic(trace: Path) -> None:
    counts: Counter[str] = Counter()
    with trace.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for schema, channel, _, message in reader.iter_decoded_messages():
            assert schema is not None
            assert schema.name == TOPICS[channel.topic].message.DESCRIPTOR.full_name
            assert message.ByteSize() > 0
            counts[channel.topic] += 1
    assert set(TOPICS) - set(counts) == {"/review"}
    assert counts["/decision"] > 8


def test_images_open_in_an_image_library(trace: Path) -> None:
    with trace.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        for _, channel, _, message in reader.iter_decoded_messages(topics=list(IMAGE_TOPICS)):
            data = np.frombuffer(message.data, np.uint8)
            image = cv2.imdecode(data, cv2.IMREAD_UNCHANGED)
            assert image is not None, channel.topic
            assert image.dtype == (np.uint16 if message.format == "png" else np.uint8)


def test_log_times_grow_within_each_topic(trace: Path) -> None:
    last: dict[str, int] = {}
    with trace.open("rb") as stream:
        for _, channel, message in make_reader(stream).iter_messages(log_time_order=False):
            assert message.log_time >= last.get(channel.topic, 0)
            last[channel.topic] = message.log_time


def test_metadata_and_attachments_tell_the_run(trace: Path) -> None:
    with trace.open("rb") as stream:
        reader = make_reader(stream)
        facts = {record.name: record.metadata for record in reader.iter_metadata()}["c2nav"]
        files = {record.name: record.data for record in reader.iter_attachments()}
    wanted = {
        "schema_version": "1",
        "run": "fake",
        "episode": "7",
        "variant": "full",
        "profile": "vlnce",
        "complete": "yes",
        "outcome": "stopped",
        "licence": "CC0-1.0",
        "privileged": "no",
    }
    assert wanted.items() <= facts.items()
    assert json.loads(facts["metrics"])["ne_m"] == 1.25
    assert json.loads(files["episode.json"])["episode_id"] == "7"
    assert json.loads(files["config.json"])["on"] is True
    assert b"{instruction}" in files["templates/seeing/1"]
    panels = json.loads(files["foxglove-layout.json"])["configById"]
    shown = {panel.get("imageMode", {}).get("imageTopic") for panel in panels.values()}
    shown |= {panel.get("topicPath") for panel in panels.values()}
    assert shown - {None} <= set(TOPICS)


def test_rerun_finds_nothing_wrong(trace: Path) -> None:
    rerun = shutil.which("rerun", path=str(Path(sys.executable).parent))
    if rerun is None:
        pytest.skip("rerun is not installed (extra `rerun`)")
    for options in ([], ["--full"]):
        done = subprocess.run(
            [rerun, "mcap", "check", *options, str(trace)], capture_output=True, text=True
        )
        assert done.returncode == 0, done.stdout + done.stderr
        rows = [line for line in done.stdout.splitlines() if "/" in line and "mcap" not in line]
        assert rows and all(line.startswith("ok") for line in rows), done.stdout


def test_the_generated_schema_is_fresh(tmp_path: Path) -> None:
    pytest.importorskip("grpc_tools")
    fresh = generate(tmp_path)
    assert fresh
    for path in fresh:
        assert path.read_bytes() == (ROOT / PACKAGE / path.name).read_bytes(), (
            f"{path.name} is stale: run `python -m c2nav_engine.traces.generate`"
        )


# ------------------------------------------------ the viewer's frame against geometry's


def rotation(x: float, y: float, z: float, w: float) -> np.ndarray:
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


VIEWER_FROM_OURS = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
OURS_FROM_OPTICAL = np.diag([1.0, -1.0, -1.0])


@pytest.mark.parametrize("yaw_rad", [0.0, 0.7, -2.0, 3.1])
@pytest.mark.parametrize("place", [0, 1, 2])
def test_a_viewers_cameras_stand_where_ours_do(yaw_rad: float, place: int) -> None:
    pose = Pose((1.0, 2.0, 3.0), yaw_rad)
    offset_rad = (VLNCE.fan_offset_rad, 0.0, -VLNCE.fan_offset_rad)[place]
    ours = world_from_camera(pose, height_m=VLNCE.camera_height_m, offset_rad=offset_rad)
    body = viewer_pose(pose)
    camera = camera_transforms(VLNCE, 0).transforms[place]
    q, t = body.orientation, body.position
    body_rotation = rotation(q.x, q.y, q.z, q.w)
    r, s = camera.rotation, camera.translation
    position = np.array([t.x, t.y, t.z]) + body_rotation @ np.array([s.x, s.y, s.z])
    np.testing.assert_allclose(position, VIEWER_FROM_OURS @ ours[:3, 3], atol=1e-12)
    np.testing.assert_allclose(
        body_rotation @ rotation(r.x, r.y, r.z, r.w),
        VIEWER_FROM_OURS @ ours[:3, :3] @ OURS_FROM_OPTICAL,
        atol=1e-12,
    )
