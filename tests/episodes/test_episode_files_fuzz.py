"""Whatever a file holds, reading gives episodes or an `EpisodeError`, nothing else."""

import copy
import gzip
import json
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from c2nav_engine.episodes.files import (
    EpisodeFile,
    read_episodes,
    read_ground_truth,
    write_episodes,
)
from c2nav_engine.errors import EpisodeError

GOOD: dict[str, object] = {
    "episodes": [
        {
            "episode_id": k,
            "trajectory_id": 3,
            "scene_id": "mp3d/a/a.glb",
            "start_position": [1.0, 0.0, -2.0],
            "start_rotation": [0.0, 0.6, 0.0, 0.8],
            "info": {"geodesic_distance": 5.0},
            "goals": [{"position": [1.0, 0.0, 3.0], "radius": 3.0}],
            "instruction": {"instruction_text": "Walk to the pool.", "instruction_tokens": [1]},
            "reference_path": [[1.0, 0.0, -2.0], [1.0, 0.0, 3.0]],
            "leg_ends": [1],
        }
        for k in range(2)
    ],
    "instruction_vocab": {"word_list": []},
}
TRUTH: dict[str, object] = {"7": {"locations": [[0.0, 0.0, 0.0]], "forward_steps": 1}}
GOOD_BYTES = json.dumps(GOOD).encode()

anything = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text()
    | st.just(10**400)
    | st.just("\ud800"),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=8,
)
unhurried = settings(
    max_examples=60,
    derandomize=True,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


def places(value: object, path: tuple[object, ...] = ()) -> list[tuple[object, ...]]:
    """Every place in a JSON value."""
    found = [path]
    if isinstance(value, dict):
        for key, inner in value.items():
            found += places(inner, (*path, key))
    if isinstance(value, list):
        for index, inner in enumerate(value):
            found += places(inner, (*path, index))
    return found


def replaced(whole: object, path: tuple[object, ...], value: object) -> object:
    if not path:
        return value
    changed = copy.deepcopy(whole)
    inner = changed
    for key in path[:-1]:
        inner = inner[key]  # pyright: ignore[reportIndexIssue]
    inner[path[-1]] = value  # pyright: ignore[reportIndexIssue]
    return changed


def read_or_error(path: Path, data: bytes) -> EpisodeFile | None:
    path.write_bytes(data)
    try:
        return read_episodes(path)
    except EpisodeError as error:
        assert path.name in str(error)
        return None


@unhurried
@given(path=st.sampled_from(places(GOOD)), value=anything)
def test_any_value_anywhere(tmp_path: Path, path: tuple[object, ...], value: object):
    changed = json.dumps(replaced(GOOD, path, value)).encode()
    source = read_or_error(tmp_path / "fuzzed.json", changed)
    if source is not None:
        write_episodes(tmp_path / "again.json", source.episodes, extra=source.extra)
        assert len(read_episodes(tmp_path / "again.json").episodes) == len(source.episodes)


@unhurried
@given(path=st.sampled_from(places(TRUTH)), value=anything)
def test_any_value_anywhere_in_a_ground_truth(
    tmp_path: Path, path: tuple[object, ...], value: object
):
    (tmp_path / "gt.json").write_bytes(json.dumps(replaced(TRUTH, path, value)).encode())
    try:
        truth = read_ground_truth(tmp_path / "gt.json")
    except EpisodeError:
        return
    assert all(len(point) == 3 for points in truth.values() for point in points)


@unhurried
@given(cut=st.integers(0, len(GOOD_BYTES)), noise=st.binary(max_size=6))
def test_cut_and_scribbled_files(tmp_path: Path, cut: int, noise: bytes):
    read_or_error(tmp_path / "fuzzed.json", GOOD_BYTES[:cut] + noise)


@unhurried
@given(data=st.data())
def test_flipped_bytes_under_gzip(tmp_path: Path, data: st.DataObject):
    packed = bytearray(gzip.compress(GOOD_BYTES, mtime=0))
    at = data.draw(st.integers(0, len(packed) - 1))
    packed[at] ^= data.draw(st.integers(1, 255))
    read_or_error(tmp_path / "fuzzed.json.gz", bytes(packed))


@pytest.mark.parametrize("cut", range(0, 60, 7))
def test_truncated_gzip(tmp_path: Path, cut: int):
    packed = gzip.compress(GOOD_BYTES, mtime=0)
    assert read_or_error(tmp_path / "cut.json.gz", packed[: len(packed) - 1 - cut]) is None
