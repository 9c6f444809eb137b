from __future__ import annotations

import numpy as np
import pytest

from app.inspector.still.lighter import Lightness, lighter, shrunk, triangle_size_m
from c2nav_engine.world.scene import Material, Piece, Scene, scene_of


def texture(side_px: int, left: int = 200, right: int = 40) -> np.ndarray:
    picture = np.full((side_px, side_px, 4), 255, np.uint8)
    picture[:, : side_px // 2, :3] = left
    picture[:, side_px // 2 :, :3] = right
    return picture


def sheet(cells: int, *, side_m: float = 4.0, height_m: float = 0.0, **looks: object) -> Piece:
    """A square floor of two triangles a cell, its picture laid over it once."""
    steps = np.linspace(0.0, 1.0, cells + 1)
    u, v = np.meshgrid(steps, steps, indexing="ij")
    flat = np.stack([u, v], axis=2).reshape(-1, 2)
    vertices = np.stack(
        [flat[:, 0] * side_m, np.full(len(flat), height_m), flat[:, 1] * side_m], axis=1
    )
    index = np.arange((cells + 1) ** 2).reshape(cells + 1, cells + 1)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    triangles = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)]).reshape(-1, 3)
    return Piece(
        "floor",
        Material("wood", texture=texture(512)),
        vertices.astype(np.float32),
        triangles.astype(np.int32),
        flat[triangles].astype(np.float32),
    )


def made(*pieces: Piece) -> Scene:
    return scene_of("made", pieces)


def test_large_triangles_keep_a_small_picture():
    light = lighter(made(sheet(2)), below_m=1.0)
    (material,) = light.materials
    assert material.texture is not None
    assert max(material.texture.shape[:2]) == Lightness().texture_px
    assert light.uvs is not None


def test_small_triangles_take_the_colours_of_their_picture():
    light = lighter(made(sheet(64)), below_m=1.0)
    (material,) = light.materials
    assert material.texture is None
    assert light.colours is not None
    x_m = light.vertices_m[:, 0]
    assert light.colours[x_m < 1.5, :3].mean() == pytest.approx(200, abs=3)
    assert light.colours[x_m > 2.5, :3].mean() == pytest.approx(40, abs=3)
    assert (light.colours[:, 3] == 255).all()


@pytest.mark.parametrize("budget", [200, 1000, 5000])
def test_the_budget_holds_and_the_floor_stays_where_it_was(budget: int):
    scene = made(sheet(80))
    light = lighter(scene, below_m=1.0, lightness=Lightness(triangles=budget))
    assert len(light.triangles) <= budget
    assert np.abs(light.vertices_m[:, 1]).max() < 1e-6
    assert np.abs(light.bounds_m - scene.bounds_m).max() < 4.0 / np.sqrt(budget / 2.0) * 2.0


def test_what_lies_wholly_above_goes():
    light = lighter(made(sheet(2), sheet(2, height_m=2.6)), below_m=1.6)
    assert light.vertices_m[light.triangles][:, :, 1].max() < 1.6


def test_pictures_only_ever_get_smaller():
    assert shrunk(texture(64), 192).shape == (64, 64, 4)
    assert shrunk(texture(512), 192).shape == (192, 192, 4)


def test_the_size_of_a_triangle_is_that_of_its_square():
    assert triangle_size_m(sheet(1, side_m=3.0)) == pytest.approx(3.0, rel=1e-6)
