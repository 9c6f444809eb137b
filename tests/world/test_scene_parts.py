"""The scene type: pieces join without loss, the content key tells contents apart."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from c2nav_engine.errors import SceneError
from c2nav_engine.world.scene import Material, Part, Piece, Scene, scene_of

PLAIN = Material("plain")
TEXTURED = Material("textured", texture=np.zeros((2, 2, 4), np.uint8))


def piece(name="piece", at=0.0, material=PLAIN, **extra) -> Piece:
    vertices_m = np.asarray([[at, 0, 0], [at + 1, 0, 0], [at, 1, 0]], np.float32)
    return Piece(name, material, vertices_m, np.asarray([[0, 1, 2]], np.int32), **extra)


def test_joining_keeps_every_piece_where_it_was():
    pieces = [piece("a", 0.0), piece("b", 5.0), piece("c", 9.0)]
    scene = scene_of("three", pieces)
    assert [part.name for part in scene.parts] == ["a", "b", "c"]
    for part, source in zip(scene.parts, pieces, strict=True):
        corners = scene.vertices_m[scene.triangles[part.first : part.stop]]
        assert np.array_equal(corners, source.vertices_m[source.triangles])
    assert scene.part_of_triangle.tolist() == [0, 1, 2]


def test_materials_are_shared_by_identity():
    scene = scene_of("two", [piece(), piece(at=2.0), piece(at=4.0, material=Material("plain"))])
    assert [part.material for part in scene.parts] == [0, 0, 1]


def test_missing_colours_and_coordinates_are_filled():
    colours = np.full((3, 4), 7, np.uint8)
    uvs = np.ones((1, 3, 2), np.float32)
    scene = scene_of(
        "mixed", [piece(), piece(at=2.0, material=TEXTURED, uvs=uvs), piece(colours=colours)]
    )
    assert scene.colours is not None
    assert scene.uvs is not None
    assert scene.colours[:6].min() == 255
    assert (scene.colours[6:] == 7).all()
    assert scene.uvs[0].max() == 0.0
    assert scene.uvs[1].min() == 1.0


def test_the_key_follows_the_content_and_not_the_name():
    base = scene_of("a", [piece()])
    assert scene_of("b", [piece()]).sha256 == base.sha256
    assert scene_of("a", [piece(at=0.5)]).sha256 != base.sha256
    assert scene_of("a", [piece("renamed")]).sha256 != base.sha256
    repainted = Material("plain", (0.5, 1.0, 1.0, 1.0))
    assert scene_of("a", [piece(material=repainted)]).sha256 != base.sha256
    assert len(base.sha256) == 64


def test_bounds_ignore_vertices_without_a_triangle():
    vertices_m = np.asarray([[0, 0, 0], [1, 0, 0], [0, 1, 0], [99, 99, 99]], np.float32)
    scene = scene_of("a", [Piece("a", PLAIN, vertices_m, np.asarray([[0, 1, 2]], np.int32))])
    assert scene.bounds_m.tolist() == [[0, 0, 0], [1, 1, 0]]


def good() -> Scene:
    return scene_of("good", [piece(), piece(at=2.0)])


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"triangles": np.asarray([[0, 1, 6]], np.int32)}, "expected indices of 6 vertices"),
        ({"triangles": np.asarray([[0, 1, -1]], np.int32)}, "expected indices of 6 vertices"),
        ({"triangles": np.zeros((0, 3), np.int32)}, "expected at least one triangle"),
        ({"vertices_m": np.full((6, 3), np.nan, np.float32)}, "expected finite vertices"),
        ({"parts": (Part("a", 0, 0, 1),)}, "expected parts that cover 2 triangles"),
        ({"parts": (Part("a", 0, 0, 1), Part("b", 5, 1, 2))}, "one of 1 materials"),
        ({"uvs": np.full((2, 3, 2), np.inf, np.float32)}, "expected finite texture coordinates"),
    ],
)
def test_what_no_reader_could_use_is_refused(change, reason):
    with pytest.raises(SceneError, match=reason):
        replace(good(), **change)


def test_no_triangle_is_no_scene():
    empty = Piece("a", PLAIN, np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int32))
    with pytest.raises(SceneError, match="came none"):
        scene_of("empty", [empty])
