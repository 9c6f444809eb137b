from __future__ import annotations

import json
import struct
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.inspector.scene.cutting import cut_below
from app.inspector.scene.flat import add_flat
from app.inspector.scene.frames import disc
from app.inspector.scene.glb import Surface, pack
from app.inspector.scene.mesh import chunks
from app.inspector.scene.section import section_of
from app.inspector.scene.shading import ALONG_X, ALONG_Z, LEVEL, shades_of
from c2nav_engine.world.scene import Material, Piece, scene_of

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


def piece(corners_m: np.ndarray, material: Material) -> Piece:
    """Triangles by their corners as a piece of a scene."""
    vertices_m = corners_m.reshape(-1, 3)
    triangles = np.arange(len(vertices_m), dtype=np.int32).reshape(-1, 3)
    return Piece(material.name, material, vertices_m, triangles)


def unpacked(glb: bytes) -> tuple[dict[str, Any], bytes]:
    """The document of a binary glTF, and its buffer."""
    size = struct.unpack_from("<I", glb, 12)[0]
    return json.loads(glb[20 : 20 + size]), glb[28 + size :]


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
    document, _ = unpacked(data)
    assert len(document["meshes"][0]["primitives"]) == 2
    assert len(document["materials"]) == 1
    assert document["accessors"][0]["count"] == len(corners_m)


def test_light_depends_on_how_a_face_lies_and_not_on_its_winding():
    faces = box((0.0, 0.0, 0.0), (1.0, 2.0, 3.0))
    normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    expected = np.array([ALONG_X, LEVEL, ALONG_Z])[np.abs(normals).argmax(axis=1)]
    assert np.allclose(shades_of(faces), expected)
    assert np.allclose(shades_of(faces[:, ::-1]), expected)
    leaning = np.array([[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 1.0]]], np.float32)
    assert np.allclose(shades_of(leaning), (LEVEL + ALONG_Z) / 2.0)
    assert np.isfinite(shades_of(np.zeros((1, 3, 3), np.float32))).all()


def test_light_is_painted_on_the_vertices_of_what_has_none_of_its_own():
    photograph = Material("wall", (1.0, 1.0, 1.0, 1.0), unlit=True)
    corners_m = np.array([[0, 1, 0], [1, 1, 0], [0, 1, 1], [0, 0, 0], [1, 0, 0], [0, 1, 0]], "f4")
    mesh = scene_of("two", [piece(corners_m, GREY), piece(corners_m, photograph)])
    (surfaces,) = chunks(mesh, 5.0)
    document, binary = unpacked(pack(surfaces))
    assert all("KHR_materials_unlit" in m["extensions"] for m in document["materials"])
    by_name = {
        document["materials"][primitive["material"]]["name"]: primitive["attributes"]
        for primitive in document["meshes"][0]["primitives"]
    }
    assert "COLOR_0" not in by_name["wall"]
    view = document["bufferViews"][document["accessors"][by_name["grey"]["COLOR_0"]]["bufferView"]]
    start = view["byteOffset"]
    colours = np.frombuffer(binary[start : start + view["byteLength"]], np.uint8).reshape(-1, 4)
    light = np.repeat([LEVEL, ALONG_Z], 3) * 255.0
    assert np.abs(colours[:, :3] - light[:, None]).max() <= 1.0
    assert (colours[:, 3] == 255).all()


@pytest.mark.parametrize(("opacity", "mode"), [(1.0, None), (0.25, "BLEND")])
def test_a_sign_has_its_colour_unlit_and_shines_through_where_it_should(opacity, mode):
    sent: list[bytes] = []
    scene = cast("Any", SimpleNamespace(add_glb=lambda _, data, **__: sent.append(data)))
    add_flat(scene, "/goal/disc", disc(3.0), (0, 158, 255), opacity=opacity)
    document, _ = unpacked(sent[0])
    (material,) = document["materials"]
    assert "KHR_materials_unlit" in material["extensions"]
    assert material["doubleSided"]
    assert material.get("alphaMode") == mode
    red, green, blue, alpha = material["pbrMetallicRoughness"]["baseColorFactor"]
    assert (red, blue, alpha) == (0.0, 1.0, opacity)
    # glTF's factors are linear: 158 of 255 is a third of the light.
    assert green == pytest.approx(0.342, abs=1e-3)


def test_a_translucent_sheet_is_painted_before_the_cut_face_wherever_one_looks_from():
    sent: list[bytes] = []
    scene = cast("Any", SimpleNamespace(add_glb=lambda _, data, **__: sent.append(data)))
    add_flat(scene, "/goal/disc", disc(3.0), (0, 158, 255), opacity=0.25)
    document, binary = unpacked(sent[0])
    places, index = document["accessors"]
    # Browsers go by the middle of the bounds: seen past a house's width, the cut is still nearer.
    middle_m = (np.array(places["min"]) + places["max"]) / 2.0
    eye_m, look = np.array([0.0, 8.0, 6.0]), np.array([0.0, -0.8, -0.6])
    assert look @ (middle_m - eye_m) > look @ (np.array([0.0, 1.6, -12.0]) - eye_m)
    start = document["bufferViews"][index["bufferView"]]["byteOffset"]
    used = np.frombuffer(binary, "<u4", index["count"], start)
    shown_m = np.frombuffer(binary, "<f4", 3 * places["count"]).reshape(-1, 3)[used]
    assert (shown_m[:, 1] == 0.0).all()


def test_a_scenes_alpha_does_not_shine_through_unless_its_file_says_so():
    glass = Material("glass", (1.0, 1.0, 1.0, 0.3))
    corners_m = box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)).reshape(-1, 3)
    surface = Surface(corners_m, np.arange(len(corners_m), dtype=np.uint32), glass)
    document, _ = unpacked(pack([surface]))
    assert "alphaMode" not in document["materials"][0]


def test_what_is_high_is_drawn_first():
    low, high = (box((0.0, y, 0.0), (1.0, y + 0.5, 1.0)) for y in (0.0, 1.0))
    red = Material("red", (1.0, 0.0, 0.0, 1.0))
    pieces = [piece(np.concatenate([low, high]), GREY), piece(high, red)]
    (surfaces,) = chunks(scene_of("two", pieces), 5.0)
    assert [surface.material.name for surface in surfaces] == ["red", "grey"]
    tops_m = surfaces[1].positions_m[surfaces[1].triangles][:, :, 1].max(axis=1)
    assert (np.diff(tops_m) <= 0.0).all()


def bent_sheet(fold_rad: float) -> Piece:
    """Two squares that share an edge, the second one raised by an angle."""
    up, along = np.sin(fold_rad), 1.0 + np.cos(fold_rad)
    vertices_m = np.array(
        [[0, 0, 0], [0, 0, 1], [1, 0, 0], [1, 0, 1], [along, up, 0], [along, up, 1]], np.float32
    )
    triangles = np.array([[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]], np.int32)
    return Piece("sheet", GREY, vertices_m, triangles)


def sent(given: Piece, height_m: float = 5.0) -> Surface:
    ((surface,),) = chunks(scene_of("one", [given]), height_m)
    return surface


def test_triangles_share_the_vertices_that_they_agree_about():
    assert len(sent(bent_sheet(0.1)).positions_m) == 6
    assert len(sent(bent_sheet(np.pi / 2)).positions_m) == 12


def test_triangles_that_differ_in_texture_coordinates_share_none_of_those_vertices():
    picture = np.zeros((2, 2, 4), np.uint8)
    look = Material("picture", (1.0, 1.0, 1.0, 1.0), texture=picture)
    flat = bent_sheet(0.0)
    uvs = flat.vertices_m[flat.triangles][:, :, ::2]
    whole = replace(flat, material=look, uvs=uvs)
    assert len(sent(whole).positions_m) == 6
    torn = uvs.copy()
    torn[2:] += 0.5
    surface = sent(replace(whole, uvs=torn))
    assert surface.uvs is not None
    corners = {
        (*position_m, *uv)
        for position_m, uv in zip(
            surface.positions_m.tolist(), surface.uvs.round(4).tolist(), strict=True
        )
    }
    assert len(corners) == 8


@given(st.floats(0.05, 1.0), st.floats(0.0, 1.5))
def test_sharing_moves_nothing(height_m: float, fold_rad: float):
    given_piece = bent_sheet(fold_rad)
    corners_m = given_piece.vertices_m[given_piece.triangles]
    expected_m2 = area_m2(cut_below(corners_m, blank(corners_m), height_m).corners_m)
    surface = sent(given_piece, height_m)
    assert np.isclose(area_m2(surface.positions_m[surface.triangles]), expected_m2, atol=1e-5)
