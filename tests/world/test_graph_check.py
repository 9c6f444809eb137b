"""Episodes held against a connectivity graph of three viewpoints."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from c2nav_engine.episodes.episode import Episode
from c2nav_engine.geometry import Pose
from c2nav_engine.world.connectivity import ConnectivityGraph, Viewpoint
from c2nav_engine.world.graph_check import check_on_graph

# a — b — c in an L of 3 and 4 m.
FEET = {"a": (0.0, 0.0, 0.0), "b": (3.0, 0.0, 0.0), "c": (3.0, 0.0, -4.0)}
GRAPH = ConnectivityGraph(
    "made",
    {name: Viewpoint(name, foot_m, (foot_m[0], 1.5, foot_m[2])) for name, foot_m in FEET.items()},
    {"a": {"b": 3.0}, "b": {"a": 3.0, "c": 4.0}, "c": {"b": 4.0}},
)
GOOD = Episode(
    episode_id="1",
    trajectory_id="1",
    scene_id="mp3d/made/made.glb",
    start=Pose((0.2, 0.1, 0.0), 0.0),
    instruction="Turn the corner.",
    goal_m=(3.0, 0.1, -4.2),
    geodesic_m=6.4,
    reference_path_m=tuple(FEET.values()),
)


def test_an_episode_along_the_graph_has_no_finding():
    assert check_on_graph(GOOD, GRAPH) == []
    assert check_on_graph(GOOD, GRAPH, surface_m=7.5) == []
    assert check_on_graph(replace(GOOD, goal_m=None, geodesic_m=None), GRAPH) == []


@pytest.mark.parametrize(
    ("surface_m", "says"), [(math.inf, "one of 7.0 m, came none"), (20.0, "came 20.00 m")]
)
def test_a_floor_without_the_way_that_the_graph_has_is_found(surface_m: float, says: str):
    (finding,) = check_on_graph(GOOD, GRAPH, surface_m)
    assert finding.startswith("walkable surface: expected a way of at most 12.5 m")
    assert says in finding


def test_a_distance_of_the_file_beyond_the_graph_is_found():
    (finding,) = check_on_graph(replace(GOOD, geodesic_m=14.0), GRAPH)
    assert finding.startswith("geodesic_distance")


def test_another_scans_places_are_found():
    elsewhere = replace(GOOD, start=Pose((9.0, 0.0, 0.0), 0.0))
    (finding,) = check_on_graph(elsewhere, GRAPH)
    assert finding == (
        "start: expected a place within 1 m of a viewpoint of made, came 6.00 m from the nearest"
    )
