"""R2R-CE files: what is read, what is kept, and what a wrong file is told."""

import gzip
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.fields import parse_object
from c2nav_engine.episodes.files import (
    ground_truth_beside,
    read_episodes,
    read_ground_truth,
    read_headings,
    with_headings,
    write_episodes,
)
from c2nav_engine.episodes.schema import episode_as_json, episode_from_json
from c2nav_engine.errors import EpisodeError
from c2nav_engine.geometry import Pose

OPEN_NAV = "OpenNav_R2R-CE_100_bertidx.json.gz"
V1_3 = "R2R_VLNCE_v1-3_val_unseen.json.gz"


def entry(**changes: object) -> dict[str, object]:
    """A complete episode as it stands in a file."""
    plain: dict[str, object] = {
        "episode_id": 7,
        "trajectory_id": 42,
        "scene_id": "mp3d/x8/x8.glb",
        "start_position": [1.0, 0.0, -2.0],
        "start_rotation": [0, 1.0, 0, 0.0],
        "info": {"geodesic_distance": 5.0},
        "goals": [{"position": [1.0, 0.0, 3.0], "radius": 3.0}],
        "instruction": {"instruction_text": "Walk to the pool. ", "instruction_tokens": [1, 2]},
        "reference_path": [[1.0, 0.0, -2.0], [1.0, 0.0, 3.0]],
    }
    return plain | changes


def file_of(tmp_path: Path, *entries: object, name: str = "val.json") -> Path:
    path = tmp_path / name
    path.write_text(json.dumps({"episodes": list(entries)}), encoding="utf-8")
    return path


def one(tmp_path: Path, **changes: object) -> Episode:
    return read_episodes(file_of(tmp_path, entry(**changes))).episodes[0]


coordinates = st.floats(-1e3, 1e3)
points = st.tuples(coordinates, coordinates, coordinates)
identifiers = st.from_regex(r"[A-Za-z0-9_][A-Za-z0-9_.\-]{0,20}", fullmatch=True)
texts = st.text(st.characters(exclude_categories=("Cs",)), min_size=1).filter(str.strip)
plain_json = st.none() | st.booleans() | st.integers() | texts


@st.composite
def fields(draw: st.DrawFn) -> dict[str, Any]:
    """An episode's fields; built in the test, where run-time type checks may draw numbers."""
    path = tuple(draw(st.lists(points, min_size=2, max_size=6)))
    ends = draw(st.sets(st.integers(1, len(path) - 1))) | {len(path) - 1}
    has_goal = draw(st.booleans())
    return {
        "episode_id": draw(identifiers),
        "trajectory_id": draw(identifiers | st.just("")),
        "scene_id": draw(texts),
        "start": (draw(points), draw(st.floats(-3.1, 3.1))),
        "instruction": draw(texts),
        "goal_m": draw(points) if has_goal else None,
        "goal_radius_m": draw(st.floats(0.1, 10.0)) if has_goal else 3.0,
        "geodesic_m": draw(st.none() | st.floats(0.0, 100.0)),
        "reference_path_m": path,
        "leg_ends": tuple(sorted(ends)),
        "extra": draw(st.dictionaries(st.sampled_from(("split", "note")), plain_json)),
    }


@settings(derandomize=True, deadline=None)
@given(fields())
def test_an_episode_survives_its_json_form(drawn: dict[str, Any]):
    drawn["start"] = Pose(*drawn["start"])
    episode = Episode(**drawn)
    again = episode_from_json("file", 0, json.loads(json.dumps(episode_as_json(episode))))
    assert math.remainder(again.start.yaw_rad - episode.start.yaw_rad, math.tau) == pytest.approx(0)
    assert replace(again, start=episode.start) == episode


def test_gzip_is_told_by_content_not_by_name(tmp_path: Path):
    plain = file_of(tmp_path, entry())
    named_plain = tmp_path / "zipped.json"
    named_plain.write_bytes(gzip.compress(plain.read_bytes()))
    assert read_episodes(named_plain).episodes == read_episodes(plain).episodes


def test_writing_twice_gives_the_same_bytes(tmp_path: Path):
    source = read_episodes(file_of(tmp_path, entry(), entry(episode_id=8)))
    write_episodes(tmp_path / "a.json.gz", source.episodes)
    write_episodes(tmp_path / "b.json.gz", source.episodes)
    assert (tmp_path / "a.json.gz").read_bytes() == (tmp_path / "b.json.gz").read_bytes()
    assert read_episodes(tmp_path / "a.json.gz").episodes == source.episodes


def test_ids_become_text_and_unknown_fields_are_kept(tmp_path: Path):
    episode = one(tmp_path, split="val", info={"geodesic_distance": 5.0, "difficulty": "hard"})
    assert (episode.episode_id, episode.trajectory_id) == ("7", "42")
    assert episode.extra == {"split": "val", "info": {"difficulty": "hard"}}


def test_tokens_and_vocabulary_are_ignored(tmp_path: Path):
    path = tmp_path / "val.json"
    whole = {"episodes": [entry()], "instruction_vocab": {"word_list": ["a"]}, "version": 3}
    path.write_text(json.dumps(whole), encoding="utf-8")
    source = read_episodes(path)
    assert source.extra == {"version": 3}
    assert "instruction" not in source.episodes[0].extra


def test_the_instruction_is_verbatim(tmp_path: Path):
    assert one(tmp_path).instruction == "Walk to the pool. "


def test_a_test_split_has_no_goal_and_no_path(tmp_path: Path):
    cut = {name: value for name, value in entry().items() if name in KEPT_IN_A_TEST_SPLIT}
    episode = read_episodes(file_of(tmp_path, cut)).episodes[0]
    assert episode.goal_m is None
    assert episode.geodesic_m is None
    assert episode.reference_path_m == ()


KEPT_IN_A_TEST_SPLIT = {
    "episode_id",
    "scene_id",
    "start_position",
    "start_rotation",
    "instruction",
}


def test_a_quaternion_is_xyzw_and_left_is_positive_yaw(tmp_path: Path):
    half = math.sqrt(0.5)
    episode = one(tmp_path, start_rotation=[0.0, half, 0.0, half])
    assert episode.start.yaw_rad == pytest.approx(math.pi / 2)


WRONG = {
    "episode_id": [None, True, -1, 1.5, "", "../up", "a/b", "x" * 101, [7]],
    "trajectory_id": [1.5, "a b"],
    "scene_id": [None, 3, "", "  ", "\ud800"],
    "start_position": [None, [1.0, 2.0], [1.0, 2.0, "3"], [1.0, 2.0, math.nan], [1, 2, True], {}],
    "start_rotation": [None, [0, 0, 0, 0], [0, 0, 0], [0, math.inf, 0, 1], [1e-9, 0, 0, 0]],
    "info": [3, {"geodesic_distance": "far"}, {"geodesic_distance": -1.0}],
    "goals": [3, [3], [{"radius": 3.0}], [{"position": [0, 0, 0], "radius": 0}]],
    "instruction": [None, "go", {}, {"instruction_text": ""}, {"instruction_text": 3}],
    "reference_path": [3, [[1, 2]], [[1, 2, math.nan]], [3]],
    "leg_ends": [3, [], [0], [1, 1], [5], [True], ["1"], [1.0]],
}


@pytest.mark.parametrize(
    ("field", "value"), [(field, value) for field, values in WRONG.items() for value in values]
)
def test_a_wrong_field_is_named_with_its_episode(tmp_path: Path, field: str, value: object):
    with pytest.raises(EpisodeError, match=field) as caught:
        one(tmp_path, **{field: value})
    whose = "episodes[0]" if field == "episode_id" else "episode 7"
    assert whose in str(caught.value)
    assert "expected" in str(caught.value)


@pytest.mark.parametrize(
    "field", ["episode_id", "scene_id", "start_position", "start_rotation", "instruction"]
)
def test_a_missing_field_is_named(tmp_path: Path, field: str):
    cut = {name: value for name, value in entry().items() if name != field}
    with pytest.raises(EpisodeError, match=rf"{field}.*came nothing"):
        read_episodes(file_of(tmp_path, cut))


def test_ids_are_distinct_even_across_types(tmp_path: Path):
    with pytest.raises(EpisodeError, match="episode 7: expected distinct ids"):
        read_episodes(file_of(tmp_path, entry(), entry(episode_id="7")))


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"", "expected JSON"),
        (b"[]", "expected a JSON object"),
        (b"{}", "episodes: expected a list"),
        (b'{"episodes": []}', "at least one episode"),
        (b'{"episodes": [3]}', r"episodes\[0\]: expected an object"),
        (b'{"episodes": ' + b"[" * 100_000, "expected JSON"),
        (b'{"episodes": [' + b"9" * 5000 + b"]}", "expected"),
        (gzip.compress(b'{"episodes": []}', mtime=0)[:-9], "cut-off"),
        (b"\x1f\x8bnonsense", "gzip"),
        (b"\xff\xfe{", "expected JSON"),
    ],
    ids=range(10),
)
def test_a_broken_file_is_named(tmp_path: Path, data: bytes, says: str):
    path = tmp_path / "broken.json.gz"
    path.write_bytes(data)
    with pytest.raises(EpisodeError, match=says) as caught:
        read_episodes(path)
    assert "broken.json.gz" in str(caught.value)


def test_a_missing_file_is_named(tmp_path: Path):
    with pytest.raises(EpisodeError, match=r"nowhere\.json"):
        read_episodes(tmp_path / "nowhere.json")


def test_headings_come_from_another_file_of_the_same_episodes(tmp_path: Path):
    source = read_episodes(file_of(tmp_path, entry(), name="old_v1-2.json"))
    newer = file_of(tmp_path, entry(start_rotation=[0, 0, 0, 1]), name="new_v1-3.json")
    turned = read_headings(newer, source)
    assert turned.episodes[0].start.yaw_rad == 0.0
    assert turned.headings == "v1-3 (new_v1-3.json)"
    assert source.headings == "v1-2 (old_v1-2.json)"
    assert turned.sha256 == source.sha256


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"episode_id": 8}, "no such episode"),
        ({"start_position": [1.02, 0.0, -2.0]}, "within 1 cm"),
        ({"instruction": {"instruction_text": "Walk elsewhere."}}, "instruction_text"),
    ],
)
def test_headings_of_other_episodes_are_refused(
    tmp_path: Path, changes: dict[str, object], says: str
):
    source = read_episodes(file_of(tmp_path, entry()))
    other = read_episodes(file_of(tmp_path, entry(**changes), name="other.json"))
    with pytest.raises(EpisodeError, match=says):
        with_headings(source, other)


def test_ground_truth_is_keyed_by_text(tmp_path: Path):
    path = tmp_path / "val_gt.json"
    path.write_text(json.dumps({"7": {"locations": [[0, 0, 0], [1, 0, 0]], "actions": [1]}}))
    assert read_ground_truth(path) == {"7": ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0))}


def test_a_wrong_ground_truth_names_its_episode(tmp_path: Path):
    path = tmp_path / "val_gt.json"
    path.write_text(json.dumps({"7": {"locations": [[0, 0]]}}))
    with pytest.raises(EpisodeError, match=r"episode 7: locations"):
        read_ground_truth(path)


def test_ground_truth_is_found_by_name_or_by_version_never_guessed(tmp_path: Path):
    path = file_of(tmp_path, entry(), name="part_v1-2.json")
    assert ground_truth_beside(path) is None
    (tmp_path / "whole_v1-3_gt.json.gz").touch()
    assert ground_truth_beside(path) is None
    by_version = tmp_path / "whole_v1-2_gt.json.gz"
    by_version.touch()
    assert ground_truth_beside(path) == by_version
    by_name = tmp_path / "part_v1-2_gt.json"
    by_name.touch()
    assert ground_truth_beside(path) == by_name


def test_the_open_nav_file_is_read_whole_and_its_old_headings_are_known(shared: Path):
    source = read_episodes(shared / "data" / OPEN_NAV)
    assert len(source.episodes) == 100
    assert source.headings == f"v1-2 ({OPEN_NAV})"
    beside = ground_truth_beside(shared / "data" / OPEN_NAV, source)
    assert beside is not None
    assert beside.name == "R2R_VLNCE_v1-2_val_unseen_gt.json.gz"
    truth = read_ground_truth(beside)
    for episode in source.episodes:
        assert truth[episode.episode_id][0] == pytest.approx(episode.start.position_m)


def test_the_newer_headings_differ_in_every_open_nav_episode(shared: Path):
    old = read_episodes(shared / "data" / OPEN_NAV)
    new = read_headings(shared / "data" / V1_3, old)
    assert new.headings == f"v1-3 ({V1_3})"
    for before, after in zip(old.episodes, new.episodes, strict=True):
        assert abs(math.remainder(after.start.yaw_rad - before.start.yaw_rad, math.tau)) > 1e-3
        assert replace(after, start=before.start) == before


def test_objects_say_what_they_are_missing():
    fields = parse_object(b'{"a": 1}', "file.json")
    assert str(fields.wrong("b", "a text")) == "file.json: b: expected a text, came nothing"
