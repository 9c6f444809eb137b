"""Bad input gets one clear message and exit code 2, never a stack trace."""

from __future__ import annotations

import gzip
import json

import pytest

from app.cli import main
from tests.helpers.exchanges import write_fake


def refused(capsys, *words: str) -> str:
    with pytest.raises(SystemExit) as stopped:
        main(list(words))
    assert stopped.value.code == 2
    error = capsys.readouterr().err
    assert "Traceback" not in error
    return error


@pytest.fixture
def episodes(tmp_path, shared):
    """The furnished house's first episode, to be spoilt."""
    whole = json.loads(gzip.decompress((shared / "data/furnished_house_8.json.gz").read_bytes()))

    def write(**changes: object) -> str:
        episode = {**whole["episodes"][0], **changes}
        path = tmp_path / "spoilt.json"
        path.write_text(json.dumps({"episodes": [episode]}), encoding="utf-8")
        return str(path)

    return write


def test_a_missing_scene_is_named_with_what_was_tried(capsys, episodes, shared, tmp_path):
    error = refused(
        capsys,
        "run",
        episodes(scene_id="house/gone.glb"),
        "--scenes",
        str(shared / "scenes"),
        "--out",
        str(tmp_path / "run"),
    )
    assert "house/gone.glb" in error
    assert "--scenes" in error


def test_a_truncated_gzip_is_named(capsys, shared, tmp_path):
    data = (shared / "data/furnished_house_8.json.gz").read_bytes()
    cut = tmp_path / "cut.json.gz"
    cut.write_bytes(data[: len(data) // 2])
    error = refused(capsys, "episodes", "list", str(cut))
    assert "cut.json.gz" in error


@pytest.mark.parametrize("text", ["", "{}", "[1, 2]", '{"episodes": 3}', "not json"])
def test_a_file_that_is_no_episode_file_is_refused(capsys, tmp_path, text):
    path = tmp_path / "other.json"
    path.write_text(text, encoding="utf-8")
    assert "other.json" in refused(capsys, "episodes", "list", str(path))


def test_a_start_off_the_walkable_surface_is_an_error_of_its_episode(
    capsys, episodes, shared, tmp_path
):
    with pytest.raises(SystemExit) as stopped:
        main(
            [
                "run",
                episodes(start_position=[400.0, 0.0, 0.0]),
                "--scenes",
                str(shared / "scenes"),
                "--out",
                str(tmp_path / "run"),
            ]
        )
    assert stopped.value.code == 2
    assert "expected a start on the walkable surface" in capsys.readouterr().err


def test_an_unknown_ranker_variant_or_profile_names_those_that_exist(capsys, tmp_path):
    out = str(tmp_path / "run")
    assert "reference-cv" in refused(capsys, "run", "builtin", "--out", out, "--ranker", "x")
    assert "terminal-absolute" in refused(
        capsys, "run", "builtin", "--out", out, "--variants", "fulll"
    )
    assert "lavira" in refused(capsys, "run", "builtin", "--out", out, "--profile", "x")


def test_a_person_cannot_rank_a_batch(capsys, tmp_path):
    error = refused(capsys, "run", "builtin", "--out", str(tmp_path / "run"), "--ranker", "human")
    assert "c2nav inspect" in error


def test_a_person_cannot_go_on_with_a_fork(capsys, tmp_path):
    write_fake(tmp_path / "a.mcap", side_px=16)
    words = ("--at", "0", "--ranking", "A", "--out", str(tmp_path / "b.mcap"), "--ranker", "human")
    assert "c2nav inspect" in refused(capsys, "fork", str(tmp_path / "a.mcap"), *words)


@pytest.mark.parametrize("option", ["--odometry-noise", "--depth-noise"])
@pytest.mark.parametrize("size", ["nan", "inf", "-0.1"])
def test_noise_is_a_finite_deviation(capsys, tmp_path, option, size):
    error = refused(capsys, "run", "builtin", "--out", str(tmp_path), "--dry-run", option, size)
    assert "finite" in error


def test_an_option_of_a_ranker_is_a_finite_number(capsys, tmp_path):
    options = ("--ranker", "reference-cv", "--ranker-opt", "max_cost_usd=nan")
    assert "max_cost_usd" in refused(
        capsys, "run", "builtin", "--out", str(tmp_path / "r"), *options
    )


@pytest.mark.parametrize(
    ("option", "value", "named"),
    [
        ("--out", "", "after --out"),
        ("--variants", "", "variants"),
        ("--episodes", ",", "episode ids"),
        ("--seeds", "", "seeds"),
    ],
)
def test_nothing_does_not_stand_for_everything(capsys, tmp_path, monkeypatch, option, value, named):
    monkeypatch.chdir(tmp_path)
    words = () if option == "--out" else ("--out", "run")
    assert named in refused(capsys, "run", "builtin", *words, option, value)
    assert named in refused(capsys, "run", "builtin", *words, f"{option}={value}")
    assert not [*tmp_path.iterdir()]


def test_traces_are_named_and_there(capsys, tmp_path):
    for command in ("info", "check"):
        assert "expected one or more traces" in refused(capsys, "trace", command)
        assert "gone.mcap" in refused(capsys, "trace", command, str(tmp_path / "gone.mcap"))


def test_a_port_out_of_range_or_a_host_that_is_not_ours_is_named(capsys):
    for port in ("99999", "-1"):
        assert port in refused(capsys, "inspect", "--no-browser", "--port", port)
    error = refused(capsys, "inspect", "--no-browser", "--host", "nosuch.invalid")
    assert "nosuch.invalid, which does not resolve" in error and "--port" not in error
    assert "--host" in refused(capsys, "inspect", "--no-browser", "--host", "")
    assert "--host" in refused(capsys, "inspect", "--no-browser", "--host", "192.0.2.1")


def test_an_unknown_episode_id_is_named(capsys, tmp_path):
    error = refused(capsys, "run", "builtin", "--out", str(tmp_path / "run"), "--episodes", "99999")
    assert "'99999'" in error


def test_a_wrong_ranker_option_is_named(capsys, tmp_path):
    error = refused(
        capsys, "run", "builtin", "--out", str(tmp_path / "r"), "--ranker-opt", "colour"
    )
    assert "KEY=VALUE" in error


def test_a_trace_that_is_none_is_refused(capsys, tmp_path):
    path = tmp_path / "none.mcap"
    path.write_bytes(b"not an mcap file at all")
    assert "none.mcap" in refused(capsys, "replay", str(path))
    assert "missing.mcap" in refused(capsys, "replay", str(tmp_path / "missing.mcap"))


def test_bad_usage_exits_with_two(capsys):
    with pytest.raises(SystemExit) as stopped:
        main(["run"])
    assert stopped.value.code == 2
    assert "Traceback" not in capsys.readouterr().err
