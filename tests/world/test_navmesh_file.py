from __future__ import annotations

import struct
from dataclasses import replace
from pathlib import Path

import pytest

from c2nav_engine.episodes.profile import LAVIRA, VLNCE
from c2nav_engine.errors import NavMeshError
from c2nav_engine.world.navmesh import NavMesh, profile_note, read_navmesh
from c2nav_engine.world.surface import Surface
from tests.helpers.navmesh_bytes import MeshSpec, TileSpec, rectangle, write_navmesh

ROOM = MeshSpec([TileSpec([rectangle((0, 0), (4, 4))])])
SET_BYTES = 40
HEADER_AT = SET_BYTES + 8


def read(data: bytes, folder: Path) -> NavMesh:
    file = folder / "some.navmesh"
    file.write_bytes(data)
    return read_navmesh(file)


def patched(data: bytes, offset: int, kind: str, value: float) -> bytes:
    changed = bytearray(data)
    struct.pack_into(kind, changed, offset, value)
    return bytes(changed)


def test_a_file_is_a_surface_that_names_its_source(tmp_path: Path):
    surface: Surface = read(write_navmesh(ROOM), tmp_path)
    assert surface.source == "navmesh"
    assert surface.triangles().shape == (2, 3, 3)


def test_version_1_takes_the_body_from_the_tiles(tmp_path: Path):
    settings = read(write_navmesh(replace(ROOM, body=(0.88, 0.18, 0.25))), tmp_path).settings
    assert settings.agent_height_m == pytest.approx(0.88)
    assert settings.agent_radius_m == pytest.approx(0.18)
    assert settings.agent_climb_m == pytest.approx(0.25)
    assert not settings.recorded


@pytest.mark.parametrize("with_bounds", [False, True])
def test_version_2_reads_the_settings_block(tmp_path: Path, with_bounds: bool):
    spec = replace(ROOM, version=2, bounds_in_settings=with_bounds)
    mesh = read(write_navmesh(spec), tmp_path)
    assert mesh.settings.recorded["cell_size_m"] == pytest.approx(0.05)
    assert mesh.settings.recorded["filter_ledge_spans"] == 1
    assert mesh.settings.agent_height_m == 1.5
    assert mesh.notes == ()


def test_a_settings_block_that_contradicts_the_tiles_is_noted(tmp_path: Path):
    data = write_navmesh(replace(ROOM, version=2))
    mesh = read(patched(data, SET_BYTES + 8, "<f", 0.5), tmp_path)
    assert mesh.settings.agent_height_m == 0.5
    assert any("settings block says" in note for note in mesh.notes)


def test_off_mesh_connections_are_ignored_with_a_note(tmp_path: Path):
    tile = TileSpec([rectangle((0, 0), (1, 1)), rectangle((3, 3), (4, 4))], connections=1)
    mesh = read(write_navmesh(MeshSpec([tile])), tmp_path)
    assert any("off-mesh" in note for note in mesh.notes)
    assert len(mesh.islands) == 2


def test_a_list_of_tiles_that_ends_early_is_noted(tmp_path: Path):
    beside = TileSpec([rectangle((4, 0), (8, 4))], cell=(1, 0))
    data = write_navmesh(replace(ROOM, tiles=[ROOM.tiles[0], beside]))
    second = data.index(b"VAND", HEADER_AT + 4) - 8
    mesh = read(patched(data, second, "<I", 0), tmp_path)
    assert mesh.notes[0] == "the list of tiles ends after 1 of 2"


def test_polygons_without_area_are_closed_and_noted(tmp_path: Path):
    sliver = [(2.0, 0.0, 0.0), (2.0, 0.0, 2.0), (2.0, 0.0, 4.0)]
    tile = TileSpec([rectangle((0, 0), (2, 4)), sliver])
    mesh = read(write_navmesh(MeshSpec([tile])), tmp_path)
    assert any("1 polygons without area" in note for note in mesh.notes)
    assert sum(island.polygons for island in mesh.islands) == 1


@pytest.mark.parametrize(
    ("offset", "kind", "value", "words"),
    [
        (0, "<i", 7, ["byte 0", "MSET", "0x7"]),
        (4, "<i", 3, ["byte 4", "version 1 or 2", "version 3"]),
        (8, "<i", 0, ["byte 8", "at least one tile", "came 0"]),
        (8, "<i", 2, ["tile reference", "0 bytes"]),
        (24, "<f", 0.0, ["byte 24", "tiles of 1 mm"]),
        (24, "<f", float("nan"), ["byte 24", "tiles of 1 mm"]),
        (28, "<f", -1.0, ["byte 24", "came 4.0 × -1.0"]),
        (SET_BYTES + 4, "<i", 10**6, ["a tile of 1000000 bytes"]),
        (HEADER_AT, "<i", 5, [f"byte {HEADER_AT}", "DNAV", "0x5"]),
        (HEADER_AT + 4, "<i", 6, ["tile version 7", "version 6"]),
        (HEADER_AT + 24, "<i", -1, ["polygons", "-1"]),
        (HEADER_AT + 24, "<i", 9999, ["9999 × 32 bytes of polygons"]),
        (HEADER_AT + 72, "<f", float("inf"), ["low_m within", "inf"]),
        (HEADER_AT + 100, "<f", float("nan"), ["vertices within", "nan"]),
        (HEADER_AT + 100 + 48 + 4, "<H", 77, ["corners below 4", "77"]),
        (HEADER_AT + 100 + 48 + 16, "<H", 9, ["neighbours below 1", "came 8"]),
        (HEADER_AT + 100 + 48 + 30, "<B", 2, ["polygons of 3 to 6 corners", "came 2"]),
    ],
)
def test_damage_is_named_with_place_expectation_and_value(
    tmp_path: Path, offset: int, kind: str, value: float, words: list[str]
):
    with pytest.raises(NavMeshError) as caught:
        read(patched(write_navmesh(ROOM), offset, kind, value), tmp_path)
    for word in ["some.navmesh", "expected", *words]:
        assert word in str(caught.value)


def test_a_settings_block_without_a_tile_behind_it_is_an_error(tmp_path: Path):
    with pytest.raises(NavMeshError, match="settings block of 56 bytes and a tile"):
        read(patched(write_navmesh(ROOM), 4, "<i", 2), tmp_path)


def test_two_tiles_in_one_place_are_an_error(tmp_path: Path):
    with pytest.raises(NavMeshError, match="one tile a place"):
        read(write_navmesh(replace(ROOM, tiles=ROOM.tiles * 2)), tmp_path)


def test_a_missing_file_is_an_input_error(tmp_path: Path):
    with pytest.raises(NavMeshError, match="No such file"):
        read_navmesh(tmp_path / "absent.navmesh")


def test_a_note_says_when_habitat_would_recompute(tmp_path: Path):
    usual = read(write_navmesh(ROOM), tmp_path)
    assert profile_note(usual, VLNCE) == ""
    assert "habitat-sim would recompute" in profile_note(usual, LAVIRA)
    small = read(write_navmesh(replace(ROOM, body=(0.88, 0.1, 0.2))), tmp_path)
    assert "built for 0.88 m and 0.1 m" in profile_note(small, VLNCE)
