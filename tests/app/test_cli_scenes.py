"""Scans from the command line: what is missing, what is prepared, a whole run on ten of them."""

from __future__ import annotations

import csv
import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from app.cli import main
from c2nav_engine.episodes.files import read_episodes, write_episodes
from c2nav_engine.episodes.profile import PROFILES, VLNCE
from c2nav_engine.geometry import Pinhole
from c2nav_engine.runner.recorded import read_trace
from tests.helpers.scans import NAMES, write_scans

OPENNAV = "data/OpenNav_R2R-CE_100_bertidx.json.gz"
EYES = Pinhole(48, 48, math.radians(90.0))


def told(capsys, *words: str, code: int = 0) -> str:
    """Standard output, or standard error where the command refuses."""
    with pytest.raises(SystemExit) as stopped:
        main(list(words))
    out, error = capsys.readouterr()
    assert stopped.value.code == code, error
    assert "Traceback" not in error
    return error if code == 2 else out


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("C2NAV_CACHE", str(tmp_path / "cache"))


@pytest.fixture(scope="module")
def ten(tmp_path_factory) -> tuple[str, str]:
    """An episode file and its scenes folder."""
    folder = tmp_path_factory.mktemp("ten")
    return str(write_scans(folder)), str(folder)


def test_what_is_missing_fits_one_screen(capsys, shared, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    text = told(capsys, "episodes", "check", str(shared / OPENNAV), code=1)
    assert len(text.splitlines()) <= 24
    assert max(map(len, text.splitlines())) <= 80
    for word in ("10 scenes are missing", "zsNo4HB9uLZ", "v1-2", "--scenes", "builtin", "license"):
        assert word in text
    episodes = read_episodes(shared / OPENNAV).episodes
    words = text.replace(",", " ").split()
    assert all(episode.episode_id in words for episode in episodes)


def test_what_is_missing_reads_as_json(capsys, shared):
    text = told(capsys, "episodes", "check", str(shared / OPENNAV), "--json", code=1)
    found = json.loads(text)
    assert not found["ok"]
    assert sum(map(len, found["missing_scenes"].values())) == found["episodes"] == 100
    assert found["headings"].startswith("v1-2")
    assert found["ground_truth"] == "R2R_VLNCE_v1-2_val_unseen_gt.json.gz"


def test_without_scans_episodes_are_held_against_connectivity_graphs(capsys, shared, tmp_path):
    graphs = ("--connectivity", str(shared / "data/connectivity"))
    words = ("episodes", "check", str(shared / OPENNAV), "--json", *graphs)
    found = json.loads(told(capsys, *words, code=1))
    assert found["on_graph"] == 100
    assert found["findings"] == []
    words = (*words[:-1], str(tmp_path / "nowhere"))
    assert "--connectivity" in told(capsys, *words, code=2)


def test_recordings_keep_their_headings(capsys, shared, tmp_path):
    (tmp_path / "traces").mkdir()
    (tmp_path / "traces" / "1.full.0.mcap").touch()
    words = ("inspect", str(tmp_path), "--headings", str(shared / OPENNAV))
    assert "recordings keep theirs" in told(capsys, *words, code=2)


def test_a_run_without_its_scans_is_refused_at_once(capsys, shared, tmp_path):
    words = ("run", str(shared / OPENNAV), "--out", str(tmp_path / "run"))
    error = told(capsys, *words, "--scenes", str(tmp_path), code=2)
    assert error.count("mp3d/") >= 10
    assert "100 of 100" in error
    assert not (tmp_path / "run").exists()


def test_ten_scans_hold(capsys, ten):
    file, scenes = ten
    found = json.loads(told(capsys, "episodes", "check", file, "--scenes", scenes, "--json"))
    assert found["ok"]
    assert sorted(found["surfaces"].values()) == ["built"] * 5 + ["navmesh"] * 5
    assert found["headings"].startswith("v1-3")


def test_one_scan_short_blocks_its_own_episode_only(capsys, ten, tmp_path):
    file, scenes = ten
    (tmp_path / "mp3d").mkdir()
    for name in NAMES[:9]:
        (tmp_path / "mp3d" / name).symlink_to(f"{scenes}/mp3d/{name}")
    words = ("episodes", "check", file, "--scenes", str(tmp_path), "--episodes", "1,3,10")
    text = told(capsys, *words, code=1)
    assert f"{NAMES[9]}  1: 10" in text
    assert "2 of 3 episodes hold" in text


def test_an_episode_that_does_not_fit_its_scan_is_found(capsys, ten, tmp_path):
    file, scenes = ten
    episodes = read_episodes(Path(file)).episodes
    spoilt = [
        replace(episodes[0], geodesic_m=3.0),
        replace(episodes[1], start=replace(episodes[1].start, position_m=(50.0, 0.0, 1.0))),
    ]
    path = tmp_path / "spoilt.json"
    write_episodes(path, spoilt)
    text = told(capsys, "episodes", "check", str(path), "--scenes", scenes, "--json", code=1)
    findings = [(row["episode_id"], row["finding"]) for row in json.loads(text)["findings"]]
    assert any(e == "1" and said.startswith("geodesic_distance: ") for e, said in findings)
    assert any(e == "2" and said.startswith("start: expected a place") for e, said in findings)


def test_ten_scans_run_end_to_end(capsys, ten, tmp_path, monkeypatch):
    small = replace(VLNCE, name="small", rgb=EYES, depth=EYES)
    monkeypatch.setitem(PROFILES, "small", small)
    (file, scenes), run = ten, tmp_path / "run"
    seat = ("--ranker", "simulated", "--ranker-opt", "d_prime=8", "--profile", "small")
    told(capsys, "run", file, "--scenes", scenes, "--out", str(run), *seat, "--json")
    with (run / "episodes.csv").open(encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    assert [row["episode_id"] for row in rows] == [str(number) for number in range(1, 11)]
    assert all(row["outcome"] in {"stopped", "step_limit", "stalled"} for row in rows)
    # The observer hardly errs: whoever walks through the doorway finds the goal.
    assert sum(int(row["success"]) for row in rows) >= 8
    traces = [read_trace(path) for path in sorted((run / "traces").glob("*.mcap"))]
    floors = {trace.header.episode.episode_id: trace.header.surface for trace in traces}
    assert floors["1"] == "navmesh"
    assert floors["2"] == "built"
    # Episode 7's scan has stairs and a navigation mesh: its body must have climbed them.
    climbed = next(trace for trace in traces if trace.header.episode.episode_id == "7")
    truths = [exchange.truth for exchange in climbed.exchanges if exchange.truth is not None]
    heights = [pose.position_m[1] for truth in truths for pose in truth.poses]
    assert max(heights) > 0.5


def test_episodes_made_on_a_mesh_hold(capsys, ten, tmp_path):
    _, scenes = ten
    out = str(tmp_path / "made.json.gz")
    words = ("episodes", "make", NAMES[0], "--scenes", scenes, "--count", "3", "--out", out)
    made = json.loads(told(capsys, *words, "--seed", "5", "--json"))
    assert made["episodes"] == 3
    assert made["surface"] == "navmesh"
    assert json.loads(told(capsys, "episodes", "check", out, "--scenes", scenes, "--json"))["ok"]
    first = read_episodes(tmp_path / "made.json.gz").sha256
    told(capsys, *words, "--seed", "5", "--json")
    assert read_episodes(tmp_path / "made.json.gz").sha256 == first


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--count", "0", "--out", "x.json"), "--count 0"),
        (("--out", "x.txt"), ".json"),
    ],
)
def test_bad_wishes_for_episodes_are_refused(capsys, ten, words, said):
    refused = ("episodes", "make", NAMES[0], "--scenes", ten[1], *words)
    assert said in told(capsys, *refused, code=2)


def test_a_folder_is_prepared_and_a_damaged_scan_named(capsys, ten, tmp_path):
    _, scenes = ten
    for name in NAMES[:2]:
        (tmp_path / "mp3d").mkdir(exist_ok=True)
        (tmp_path / "mp3d" / name).symlink_to(f"{scenes}/mp3d/{name}", target_is_directory=True)
    damaged = tmp_path / "mp3d" / "cut" / "cut.glb"
    damaged.parent.mkdir()
    damaged.write_bytes(b"glTF cut short")
    found = json.loads(told(capsys, "scene", "prepare", str(tmp_path), "--json", code=1))
    rows = {row["scene_id"]: row for row in found["scenes"]}
    assert "cut" in rows["mp3d/cut/cut.glb"]["problem"]
    assert sum(not row["problem"] for row in rows.values()) == 2
    floors = {row["floor"] for row in rows.values() if not row["problem"]}
    assert floors == {"navmesh", "built"}
    assert list((tmp_path / "cache" / "surfaces").glob("*.npz"))


def test_a_scene_and_its_floor_are_described(capsys, ten):
    _, scenes = ten
    mesh = json.loads(told(capsys, "scene", "info", NAMES[0], "--scenes", scenes, "--json"))
    assert mesh["parts"] == 3
    assert mesh["navmesh"].endswith(f"{NAMES[0]}.navmesh")
    floor = json.loads(
        told(capsys, "scene", "info", mesh["navmesh"], "--profile", "lavira", "--json")
    )
    assert floor["islands"][0]["polygons"] == floor["polygons"] == 5
    assert floor["body"] == {"height_m": 1.5, "radius_m": 0.1, "climb_m": 0.2}
    assert "recompute" in floor["profile_note"]


@pytest.mark.parametrize("command", ["info", "prepare"])
def test_a_scene_that_is_not_there_is_refused(capsys, command):
    assert "nowhere.glb" in told(capsys, "scene", command, "nowhere.glb", code=2)
