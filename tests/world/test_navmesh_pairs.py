from __future__ import annotations

import json
from pathlib import Path

import pytest

from c2nav_engine.errors import UsageError
from c2nav_engine.world.navmesh import NavMesh, query_pairs
from c2nav_engine.world.navmesh.file import parse
from c2nav_engine.world.navmesh.mesh import prepare
from tests.helpers.navmesh_bytes import MeshSpec, TileSpec, rectangle, write_navmesh


@pytest.fixture(scope="module")
def mesh() -> NavMesh:
    parts = [rectangle((0, 0), (1, 4)), rectangle((2, 0), (4, 4))]
    data = write_navmesh(MeshSpec([TileSpec(parts)]))
    return prepare(parse(data, Path("made.navmesh")), Path("made.navmesh"))


def test_answers_have_the_promised_form_and_order(mesh: NavMesh):
    pairs = {
        "paths": [
            {"raw": [[0.5, 1.0, 1.0], [0.5, -1.0, 3.0]], "geodesic_m": "ignored"},
            {"raw": [[0.5, 0.0, 1.0], [3.0, 0.0, 1.0]]},
            {"raw": [[0.5, 0.0, 1.0], [90.0, 0.0, 1.0]]},
        ],
        "steps": [{"from": [0.75, 0.0, 1.0], "to": [0.75, 0.0, 1.25]}],
    }
    answers = query_pairs(mesh, pairs)
    assert set(answers) == {"paths", "steps", "queries_per_s"}
    assert answers["paths"] == [
        {"from": [0.5, 0.0, 1.0], "to": [0.5, 0.0, 3.0], "geodesic_m": 2.0},
        {"from": [0.5, 0.0, 1.0], "to": [3.0, 0.0, 1.0], "geodesic_m": None},
        {"from": [0.5, 0.0, 1.0], "to": None, "geodesic_m": None},
    ]
    assert answers["steps"] == [{"slid": [0.75, 0.0, 1.25]}]
    assert answers["queries_per_s"] > 0
    json.dumps(answers, allow_nan=False)


def test_no_question_is_no_answer(mesh: NavMesh):
    assert query_pairs(mesh, {}) == {"paths": [], "steps": [], "queries_per_s": 0.0}


@pytest.mark.parametrize(
    ("pairs", "words"),
    [
        ([], ["object with paths", "list"]),
        ({"paths": 3}, ["paths", "list", "int"]),
        ({"paths": [{}]}, ["paths[0]", "'raw'"]),
        ({"paths": [{"raw": [[0, 0, 0]]}]}, ["paths[0]", "two points"]),
        ({"paths": [{"raw": [[0, 0, 0], [0, float("nan"), 0]]}]}, ["paths[0]", "nan"]),
        ({"paths": [{"raw": [[0, 0, 0], [0, 0, 1e300]]}]}, ["paths[0]", "1e+300"]),
        ({"steps": [{"from": [0, 0, 0]}]}, ["steps[0]", "'to'"]),
        ({"steps": [{"from": [0, 0, 0], "to": "there"}]}, ["steps[0]", "there"]),
    ],
)
def test_a_wrong_entry_is_named(mesh: NavMesh, pairs: object, words: list[str]):
    with pytest.raises(UsageError) as caught:
        query_pairs(mesh, pairs)
    for word in words:
        assert word in str(caught.value)
