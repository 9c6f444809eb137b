"""The furnished house and its eight episodes: real furniture, real doors, known distances."""

import gzip
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from c2nav_engine.episodes.profile import LAVIRA, VLNCE, Profile
from c2nav_engine.geometry import Point
from c2nav_engine.world.load import load_scene
from c2nav_engine.world.scene import Scene
from c2nav_engine.world.walkable import WalkableSurface, build_surface


@pytest.fixture(scope="module")
def house(shared: Path) -> Scene:
    return load_scene(shared / "scenes/house/aws_small_house_yup.glb")


@pytest.fixture(scope="module", params=[VLNCE, LAVIRA], ids=lambda profile: profile.name)
def surface(house: Scene, request: pytest.FixtureRequest) -> WalkableSurface:
    profile: Profile = request.param
    return build_surface(
        house.vertices_m,
        house.triangles,
        height_m=profile.height_m,
        radius_m=profile.radius_m,
        climb_m=profile.climb_m,
        slope_rad=profile.slope_rad,
    )


@pytest.fixture(scope="module")
def episodes(shared: Path) -> list[tuple[Point, Point, float]]:
    """(start, goal, geodesic distance in the file)."""
    with gzip.open(shared / "data/furnished_house_8.json.gz", "rt", encoding="utf-8") as file:
        found: list[dict[str, Any]] = json.load(file)["episodes"]
    return [
        (
            tuple(episode["start_position"]),
            tuple(episode["goals"][0]["position"]),
            episode["info"]["geodesic_distance"],
        )
        for episode in found
    ]


def test_starts_and_goals_stand_on_the_floor(surface, episodes):
    for start, goal, _ in episodes:
        for point in (start, goal):
            on_floor = surface.snap(point)
            assert on_floor is not None
            assert math.hypot(on_floor[0] - point[0], on_floor[2] - point[2]) <= 0.3
            assert abs(on_floor[1] - point[1]) <= 0.05


def test_geodesics_are_the_files(surface, episodes):
    for start, goal, distance_m in episodes:
        assert surface.geodesic_m(start, goal) == pytest.approx(distance_m, rel=0.05)


def test_the_way_there_is_as_long_as_the_way_back(surface, episodes):
    for start, goal, _ in episodes:
        there_m = surface.geodesic_m(start, goal)
        assert surface.geodesic_m(goal, start) == pytest.approx(there_m, rel=0.005)


def test_distance_falls_along_every_path(surface, episodes):
    for start, goal, _ in episodes:
        path = surface.path(start, goal)
        assert path is not None
        distances_m = surface.distance_field(goal).distances_m(np.array(path))
        assert (np.diff(distances_m) < 1e-6).all()
        assert distances_m[-1] == pytest.approx(0.0, abs=1e-6)


def test_the_field_changes_no_faster_than_the_body_moves(surface, episodes):
    _, goal, _ = episodes[0]
    field = surface.distance_field(goal)
    rng = np.random.default_rng(0)
    steps_m: list[float] = []
    rises_m: list[float] = []
    for x, z in rng.uniform([-9.0, -5.0], [9.0, 5.0], (300, 2)):
        start = surface.snap((float(x), 0.0, float(z)))
        assert start is not None
        end = surface.slide(start, (start[0] + 0.2, start[1], start[2] + 0.1))
        steps_m.append(math.dist(start, end))
        rises_m.append(abs(field.distance_m(end) - field.distance_m(start)))
    reached = np.isfinite(rises_m)
    assert reached.mean() > 0.8
    assert (np.array(rises_m)[reached] <= np.array(steps_m)[reached] * 1.05 + 0.02).all()
