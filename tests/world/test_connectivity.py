from __future__ import annotations

import gzip
import json
import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from c2nav_engine.errors import SceneError
from c2nav_engine.world.connectivity import (
    ConnectivityGraph,
    connectivity_of,
    read_connectivity,
)


def entry(name: str, at: tuple[float, float, float], ways: list[bool], **more: object) -> Any:
    x, y, z = at
    pose = [1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, y, 0.0, 0.0, 1.0, z, 0.0, 0.0, 0.0, 1.0]
    return {"image_id": name, "pose": pose, "included": True, "unobstructed": ways, "height": 1.5,
            "visible": ways} | more  # fmt: skip


def graph_of(folder: Path, entries: object) -> ConnectivityGraph:
    file = folder / "some_connectivity.json"
    file.write_text(json.dumps(entries), encoding="utf-8")
    return read_connectivity(file)


# a — b — c in an L of 3 and 4 m; d is not included, e stands alone.
SMALL = [
    entry("a", (0, 0, 1.5), [False, True, False, True, False]),
    entry("b", (3, 0, 1.5), [True, False, True, True, False]),
    entry("c", (3, 4, 1.5), [False, True, False, True, False]),
    entry("d", (1, 1, 1.5), [True, True, True, False, True], included=False),
    entry("e", (9, 9, 4.5), [False, False, False, True, False]),
]


def test_axes_and_eye_height_are_mapped(tmp_path: Path):
    view = graph_of(tmp_path, SMALL).viewpoints["c"]
    assert view.foot_m == (3.0, 0.0, -4.0)
    assert view.eye_m == (3.0, 1.5, -4.0)


def test_distances_follow_the_graph_and_leave_out_what_is_not_included(tmp_path: Path):
    graph = graph_of(tmp_path, SMALL)
    assert graph.scan == "some"
    assert set(graph.viewpoints) == {"a", "b", "c", "e"}
    assert graph.distance_m("a", "c") == pytest.approx(7.0)
    assert graph.path("a", "c") == ["a", "b", "c"]
    assert graph.distance_m("a", "e") == math.inf
    assert graph.path("a", "e") is None
    assert graph.path("b", "b") == ["b"]


def test_nearest_takes_the_storey(tmp_path: Path):
    graph = graph_of(tmp_path, SMALL)
    assert graph.nearest((8.5, 2.8, -9.0)).image_id == "e"
    assert graph.nearest((0.4, 0.1, 0.3)).image_id == "a"


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ({"not": "a list"}, ["the top", "list"]),
        ([entry("a", (0, 0, 0), [False]) | {"pose": [1.0]}], ["[0]['pose']"]),
        ([entry("a", (0, 0, 0), [])], ["expected 1 values", "came 0"]),
    ],
)
def test_a_broken_file_is_named(tmp_path: Path, entries: object, words: list[str]):
    with pytest.raises(SceneError) as caught:
        graph_of(tmp_path, entries)
    for word in ["some_connectivity.json", *words]:
        assert word in str(caught.value)


def test_a_scan_without_a_graph_is_named(tmp_path: Path):
    with pytest.raises(SceneError, match=r"expected SCAN_connectivity\.json in .*found none"):
        connectivity_of(tmp_path, "mp3d/SCAN/SCAN.glb")


def test_a_missing_file_is_named(tmp_path: Path):
    with pytest.raises(SceneError, match="absent"):
        read_connectivity(tmp_path / "absent.json")


@pytest.fixture(scope="module")
def graphs(shared: Path) -> dict[str, ConnectivityGraph]:
    files = sorted((shared / "data" / "connectivity").glob("*.json"))
    return {graph.scan: graph for graph in map(read_connectivity, files)}


@pytest.fixture(scope="module")
def episodes(shared: Path) -> list[dict[str, Any]]:
    file = shared / "data" / "R2R_VLNCE_v1-3_val_unseen.json.gz"
    return json.loads(gzip.decompress(file.read_bytes()))["episodes"]


def test_every_scan_of_the_split_is_there(
    graphs: dict[str, ConnectivityGraph], episodes: list[dict[str, Any]]
):
    assert {episode["scene_id"].split("/")[1] for episode in episodes} == set(graphs)
    assert len(graphs) == 11


def test_ways_run_both_ways_and_obey_the_triangle_inequality(graphs: dict[str, ConnectivityGraph]):
    for graph in graphs.values():
        for here, ways in graph.ways_m.items():
            distances = graph.distances_m(here)
            for there, length_m in ways.items():
                assert graph.ways_m[there][here] == pytest.approx(length_m)
                assert distances[there] <= length_m + 1e-9


def test_viewpoints_overlay_the_reference_paths(
    graphs: dict[str, ConnectivityGraph], episodes: list[dict[str, Any]]
):
    apart_m: list[float] = []
    for episode in episodes:
        graph = graphs[episode["scene_id"].split("/")[1]]
        for x, y, z in episode["reference_path"]:
            foot = graph.nearest((x, y, z)).foot_m
            apart_m.append(math.hypot(foot[0] - x, foot[2] - z))
            # Storeys are not confused: the tripod's height is good to half a metre.
            assert abs(foot[1] - y) < 0.6
    apart_m.sort()
    assert apart_m[len(apart_m) // 2] < 1e-4
    assert apart_m[int(0.97 * len(apart_m))] < 0.05


def test_reference_paths_are_ways_of_the_graph(
    graphs: dict[str, ConnectivityGraph], episodes: list[dict[str, Any]]
):
    steps = known = 0
    for episode in episodes[::10]:
        graph = graphs[episode["scene_id"].split("/")[1]]
        ids = [graph.nearest(tuple(point)).image_id for point in episode["reference_path"]]
        for here, there in pairwise(ids):
            steps += 1
            known += there in graph.ways_m[here] or here == there
    assert known / steps > 0.97
