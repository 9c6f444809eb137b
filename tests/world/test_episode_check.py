"""Checking episodes against a floor whose distances are known."""

from __future__ import annotations

from dataclasses import replace

import pytest

from c2nav_engine.episodes.episode import Episode
from c2nav_engine.errors import SceneError
from c2nav_engine.geometry import Pose
from c2nav_engine.world.episode_check import check_episode, check_episodes
from c2nav_engine.world.surface import Surface
from tests.helpers.meshes import room, surface_of, wall

GOOD = Episode(
    episode_id="1",
    trajectory_id="1",
    scene_id="a.glb",
    start=Pose((1.0, 0.0, 2.0), 0.0),
    instruction="Walk to the wall.",
    goal_m=(5.0, 0.0, 2.0),
    geodesic_m=4.0,
    reference_path_m=((1.0, 0.0, 2.0), (5.0, 0.0, 2.0)),
)


@pytest.fixture(scope="module")
def floor() -> Surface:
    return surface_of(room(6.0, 4.0))


@pytest.fixture(scope="module")
def parted() -> Surface:
    return surface_of([*room(6.0, 4.0), wall(2.9, 0.0, 3.1, 4.0)])


def test_an_episode_that_fits_has_no_finding(floor: Surface):
    assert check_episode(GOOD, floor) == []


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"start": Pose((1.0, 3.0, 2.0), 0.0), "reference_path_m": ()}, "start: expected a place"),
        ({"start": Pose((90.0, 0.0, 2.0), 0.0), "reference_path_m": ()}, "no floor near"),
        ({"goal_m": (5.0, 0.0, 5.5)}, "goal: expected a place"),
        ({"geodesic_m": 4.5}, "geodesic_distance: expected 4.00 m"),
        ({"reference_path_m": ((2.0, 0.0, 2.0), (5.0, 0.0, 2.0))}, "reference_path"),
    ],
)
def test_each_fault_is_found(floor: Surface, changes: dict[str, object], says: str):
    findings = check_episode(replace(GOOD, **changes), floor)  # pyright: ignore[reportArgumentType]
    assert any(says in finding for finding in findings)


def test_a_goal_behind_a_wall_has_no_way(parted: Surface):
    assert any("expected a way" in finding for finding in check_episode(GOOD, parted))


def test_five_percent_are_allowed(floor: Surface):
    assert check_episode(replace(GOOD, geodesic_m=4.19), floor) == []
    assert check_episode(replace(GOOD, geodesic_m=4.22), floor) != []


def test_without_a_goal_only_the_start_is_checked(parted: Surface):
    assert check_episode(replace(GOOD, goal_m=None, geodesic_m=None), parted) == []


def test_one_row_an_episode_in_order_with_missing_scenes_as_findings(floor: Surface):
    def scene_of(scene_id: str) -> object:
        if scene_id != "a.glb":
            message = f"scene {scene_id}: expected a file, came none"
            raise SceneError(message)
        return object()

    episodes = [
        GOOD,
        replace(GOOD, episode_id="2", scene_id="b.glb"),
        replace(GOOD, episode_id="3"),
    ]
    rows = check_episodes(episodes, scene_of, lambda _: floor)
    assert [row.episode_id for row in rows] == ["1", "2", "3"]
    assert [bool(row.findings) for row in rows] == [False, True, False]
    assert "b.glb" in rows[1].findings[0]
    assert rows[0].geodesic_m == pytest.approx(4.0, abs=0.05)
    assert rows[1].geodesic_m is None
