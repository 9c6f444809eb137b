from __future__ import annotations

import json
import struct

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.inspector.scene.cutting import cut_below
from app.inspector.scene.glb import Surface, pack
from app.inspector.scene.section import section_of
from c2nav_engine.world.scene import Material

GREY = Material("grey", (0.5, 0.5, 0.5, 1.0))


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> np.ndarray:
    """Twelve triangles of an axis-aligned box."""
    corners = np.array(
        [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    )
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    return corners[np.array(triangles)].astype(np.float32)


def blank(corners_m: np.ndarray) -> np.ndarray:
    return np.zeros((len(corners_m), 3, 0), np.float32)


def area_m2(corners_m: np.ndarray) -> float:
    sides = corners_m[:, 1:] - corners_m[:, :1]
    return float(np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum() / 2.0)


@given(st.floats(0.1, 1.9))
def test_a_cut_box_keeps_the_area_below_the_cut(height_m: float):
    corners_m = box((0.0, 0.0, 0.0), (1.0, 2.0, 3.0))
    soup = cut_below(corners_m, blank(corners_m), height_m)
    assert soup.corners_m[:, :, 1].max() <= height_m + 1e-5
    sides_m2 = 2 * (1.0 + 3.0) * height_m
    assert np.isclose(area_m2(soup.corners_m), 3.0 + sides_m2, rtol=1e-4)


def test_what_lies_below_is_untouched():
    corners_m = box((0.0, 0.0, 0.0), (1.0, 2.0, 3.0))
    soup = cut_below(corners_m, blank(corners_m), 5.0)
    assert np.array_equal(soup.corners_m, corners_m)
    assert not soup.cut.any()


def test_texture_coordinates_are_interpolated_at_the_cut():
    corners_m = np.array([[[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [1.0, 0.0, 0.0]]], np.float32)
    uvs = corners_m[:, :, 1:2] / 2.0  # v follows the height
    soup = cut_below(corners_m, uvs, 1.0)
    assert np.allclose(soup.extra[:, :, 0], soup.corners_m[:, :, 1] / 2.0)


def test_a_walls_cut_face_is_filled_and_a_rooms_is_not():
    wall = box((0.0, 0.0, 0.0), (4.0, 2.5, 0.15))
    room = box((0.0, 0.0, 2.0), (4.0, 2.5, 6.0))
    section = section_of([wall, room], 1.6)
    assert section is not None
    filled = section.rgba[:, :, 3] > 0
    rows, columns = filled.shape

    def at(x: float, z: float) -> bool:
        column = (x - section.centre_m[0]) / section.size_m[0] * columns + columns / 2
        row = (z - section.centre_m[1]) / section.size_m[1] * rows + rows / 2
        return bool(filled[int(row), int(column)])

    assert at(2.0, 0.075)
    assert not at(2.0, 4.0)


def test_nothing_to_cut_gives_no_section():
    assert section_of([box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))], 1.6) is None


def test_a_packed_scene_says_its_own_length():
    corners_m = box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)).reshape(-1, 3)
    surface = Surface(corners_m, np.arange(len(corners_m), dtype=np.uint32), GREY)
    data = pack([surface, surface])
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + size])
    assert len(document["meshes"][0]["primitives"]) == 2
    assert len(document["materials"]) == 1
    assert document["accessors"][0]["count"] == len(corners_m)
