"""Detour's own answers on real meshes, within 1 cm: 800 paths and 800 moves."""

from __future__ import annotations

import json
import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from c2nav_engine.world.navmesh import NavMesh, query_pairs, read_navmesh

TOLERANCE_M = 0.01


@pytest.fixture(scope="module", params=["apartment_1", "van-gogh-room"])
def real(request: pytest.FixtureRequest, shared: Path) -> tuple[NavMesh, dict[str, Any]]:
    mesh = read_navmesh(shared / "scenes" / f"habitat_test_{request.param}.navmesh")
    answers = shared / "data" / f"navmesh_reference_{request.param}.json"
    return mesh, json.loads(answers.read_text(encoding="utf-8"))


def test_the_file_is_understood(real: tuple[NavMesh, dict[str, Any]]):
    mesh, reference = real
    assert len(mesh.arrays.polygons) == reference["polys"]
    assert np.allclose(mesh.bounds_m, reference["bounds"], atol=1e-6)
    assert mesh.notes == ()
    assert mesh.settings.agent_height_m == 1.5


def test_paths_and_moves_equal_the_reference(real: tuple[NavMesh, dict[str, Any]]):
    mesh, reference = real
    answers = query_pairs(mesh, reference)
    for ours, theirs in zip(answers["paths"], reference["paths"], strict=True):
        assert math.dist(ours["from"], theirs["from"]) < TOLERANCE_M
        assert math.dist(ours["to"], theirs["to"]) < TOLERANCE_M
        assert (ours["geodesic_m"] is None) == (theirs["geodesic_m"] is None)
        if theirs["geodesic_m"] is not None:
            assert abs(ours["geodesic_m"] - theirs["geodesic_m"]) < TOLERANCE_M
    for ours, theirs in zip(answers["steps"], reference["steps"], strict=True):
        assert math.dist(ours["slid"], theirs["slid"]) < TOLERANCE_M


def test_single_questions_equal_the_reference(real: tuple[NavMesh, dict[str, Any]]):
    mesh, reference = real
    for path in reference["paths"][:100]:
        start, end = tuple(path["from"]), tuple(path["to"])
        corners = mesh.path(start, end)
        if path["geodesic_m"] is None:
            assert corners is None
            assert mesh.geodesic_m(start, end) == math.inf
            continue
        assert corners is not None
        # Where both ends are one point, habitat-sim still returns both.
        assert len(corners) == max(2, path["points"])
        length = sum(math.dist(a, b) for a, b in pairwise(corners))
        assert length == pytest.approx(path["geodesic_m"], abs=1e-4)
        assert mesh.geodesic_m(start, end) == pytest.approx(path["geodesic_m"], abs=1e-4)
    for step in reference["steps"][:100]:
        slid = mesh.slide(tuple(step["from"]), tuple(step["to"]))
        assert math.dist(slid, step["slid"]) < TOLERANCE_M


def test_a_field_is_a_metric_and_never_longer_than_the_path(
    real: tuple[NavMesh, dict[str, Any]],
):
    mesh, reference = real
    points = [tuple(path["from"]) for path in reference["paths"][:25]]
    table = np.array([mesh.distance_field(goal).distances_m(np.array(points)) for goal in points])
    assert np.allclose(np.diag(table), 0.0, atol=1e-6)
    assert np.allclose(table, table.T, atol=1e-6)
    for middle in range(len(points)):
        assert (table <= table[:, middle, None] + table[None, middle] + 1e-6).all()
    for row, goal in enumerate(points):
        for column, start in enumerate(points):
            detour = mesh.geodesic_m(start, goal)
            assert math.isinf(detour) == math.isinf(table[row, column])
            assert table[row, column] <= detour + 1e-4
            assert table[row, column] >= math.dist(start, goal) - 1e-4
