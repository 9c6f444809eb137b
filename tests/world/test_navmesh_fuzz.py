"""Whatever bytes come, the reader gives a mesh that answers, or a `NavMeshError`."""

from __future__ import annotations

import math
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from c2nav_engine.errors import NavMeshError
from c2nav_engine.world.navmesh.file import parse
from c2nav_engine.world.navmesh.mesh import prepare
from tests.helpers.navmesh_bytes import MeshSpec, TileSpec, rectangle, write_navmesh

SMALL = write_navmesh(
    MeshSpec(
        [
            TileSpec([rectangle((0, 0), (2, 4)), rectangle((2, 0), (4, 4))], bumps={0: 0.3}),
            TileSpec([rectangle((4, 0), (8, 4))], cell=(1, 0), tree=False, connections=1),
        ],
        version=2,
    )
)
PLACES = st.integers(0, len(SMALL) - 1)
WORDS = st.sampled_from(
    [0, 1, 2, 3, 0x7F, 0x80, 0xFF, 0x7FFF, 0x8000, 0xFFFF, 0x7F800000, 2**31 - 1]
)


def answer(data: bytes) -> bool:
    """Whether the bytes are a mesh; if so, every kind of question gets an answer."""
    try:
        mesh = prepare(parse(data, Path("some.navmesh")), Path("some.navmesh"))
    except NavMeshError:
        return False
    for point in ((1.0, 0.0, 1.0), (7.0, 0.5, 3.0), (1e30, 0.0, 0.0), (math.nan, 0.0, 0.0)):
        snapped = mesh.snap(point)
        assert snapped is None or all(math.isfinite(value) for value in snapped)
        assert mesh.geodesic_m(point, (3.0, 0.0, 2.0)) >= 0.0
        mesh.slide((1.0, 0.0, 1.0), point)
        mesh.slide((1.0, 0.0, 1.0), point, sliding=False)
    assert mesh.distance_field((3.0, 0.0, 2.0)).distance_m((7.0, 0.0, 1.0)) >= 0.0
    assert mesh.triangles().shape[1:] == (3, 3)
    return True


def test_the_unharmed_file_is_a_mesh():
    assert answer(SMALL)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.lists(st.tuples(PLACES, st.integers(0, 255)), min_size=1, max_size=6))
def test_changed_bytes(changes: list[tuple[int, int]]):
    data = bytearray(SMALL)
    for place, value in changes:
        data[place] = value
    answer(bytes(data))


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.lists(st.tuples(st.integers(0, len(SMALL) // 4 - 1), WORDS), min_size=1, max_size=4))
def test_changed_words(changes: list[tuple[int, int]]):
    data = bytearray(SMALL)
    for place, word in changes:
        data[4 * place : 4 * place + 4] = word.to_bytes(4, "little")
    answer(bytes(data))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(PLACES)
def test_cut_files(length: int):
    assert not answer(SMALL[:length])


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.binary(max_size=400))
def test_noise(data: bytes):
    assert not answer(data)
    assert not answer(SMALL[:48] + data)
