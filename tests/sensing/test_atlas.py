"""Packed looks: smaller copies keep the light, shared textures are stored once."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from c2nav_engine.sensing.atlas import atlas_of, packed
from c2nav_engine.sensing.colour import DECODED
from c2nav_engine.sensing.conformance_scenes import quad
from c2nav_engine.sensing.mipmap import LEVELS, mipmaps
from c2nav_engine.world.scene import Material, Piece, scene_of

CORNERS = [(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (2.0, 1.0, 0.0), (0.0, 1.0, 0.0)]


def channels(texels: np.ndarray) -> np.ndarray:
    return np.stack([(texels >> shift) & 255 for shift in (0, 8, 16, 24)], axis=-1)


def picture(rows: int, columns: int) -> np.ndarray:
    return np.random.default_rng(1).integers(0, 256, (rows, columns, 4), dtype=np.uint8)


def test_packing_keeps_the_channels():
    texture = picture(3, 5)
    assert np.array_equal(channels(packed(texture)), texture)


def test_halvings_keep_the_light():
    texture = picture(64, 64)
    texture[..., 3] = 255
    light = DECODED[texture[..., :3]].mean(axis=(0, 1))
    for level in mipmaps(packed(texture))[1:]:
        kept = DECODED[channels(level)[..., :3]].mean(axis=(0, 1))
        assert kept == pytest.approx(light, abs=0.01)


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (512, 3), (208, 512)])
def test_halvings_end_at_one_texel(shape):
    levels = mipmaps(packed(picture(*shape)))
    assert len(levels) == LEVELS
    assert levels[0].shape == shape
    assert levels[-1].shape == (1, 1)
    for larger, smaller in itertools.pairwise(levels):
        assert smaller.shape == tuple(max(1, side // 2) for side in larger.shape)


def test_clear_texels_lend_no_colour():
    texture = np.zeros((2, 2, 4), np.uint8)
    texture[0, 0] = (200, 100, 50, 255)
    half = channels(mipmaps(packed(texture))[1])[0, 0]
    assert np.abs(half[:3].astype(int) - [200, 100, 50]).max() <= 2
    assert half[3] == 64


def test_shared_textures_are_stored_once():
    texture = picture(16, 16)
    one, other = Material("one", texture=texture), Material("other", (0.5, 0.5, 0.5, 1.0), texture)
    twice = atlas_of(scene_of("s", [quad("a", CORNERS, one), quad("b", CORNERS, other)]))
    once = atlas_of(scene_of("s", [quad("a", CORNERS, one)]))
    assert len(twice.texels) == len(once.texels)
    assert np.array_equal(twice.offsets[0], twice.offsets[1])


def test_density_counts_texels_in_a_square_metre():
    atlas = atlas_of(scene_of("s", [quad("a", CORNERS, Material("m", texture=picture(10, 40)))]))
    # 400 texels over 2 m².
    assert atlas.surfaces[:, 1] == pytest.approx([200.0, 200.0])


def test_a_texture_without_coordinates_is_left_out():
    piece = quad("a", CORNERS, Material("m", texture=picture(4, 4)))
    bare = Piece(piece.name, piece.material, piece.vertices_m, piece.triangles)
    atlas = atlas_of(scene_of("s", [bare]))
    assert not atlas.sizes_px.any()
    assert atlas.surfaces.shape == (2, 1)


def test_vertices_far_away_and_read_only_arrays_are_taken():
    piece = quad("a", CORNERS, Material("m", texture=picture(4, 4)))
    scene = scene_of("s", [piece])
    for array in (scene.vertices_m, scene.triangles, scene.uvs):
        assert array is not None
        array.flags.writeable = False
    assert np.isfinite(atlas_of(scene).surfaces).all()
