"""Solids that houses are built of: closed ones face outward, textures fit, models stand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from c2nav_engine.world.builtin import textures
from c2nav_engine.world.builtin.furniture.catalogue import FLAT, HUNG, MAKERS, PHRASES, model
from c2nav_engine.world.builtin.furniture.model import Tones
from c2nav_engine.world.builtin.looks import lacquer
from c2nav_engine.world.builtin.mesh import (
    Solid,
    box,
    cushion,
    cylinder,
    lathe,
    projected_uvs,
    sheet,
)
from c2nav_engine.world.builtin.palette import COLOURS

WHITE = lacquer("white")
SPHERE = [
    (0.5 * math.cos(a) + 1e-9, 0.5 + 0.5 * math.sin(a))
    for a in np.linspace(-math.pi / 2, math.pi / 2, 25)
]


def volume(solid: Solid) -> float:
    """Signed volume: positive when all faces look outward."""
    corners = solid.vertices_m[solid.triangles]
    return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6


@pytest.mark.parametrize(
    ("solid", "expected", "tolerance"),
    [
        (box(WHITE, (1.0, 2.0, 3.0)), 6.0, 1e-9),
        (cushion(WHITE, (1.0, 2.0, 3.0), radius=0.1), 5.9, 0.02),
        (cylinder(WHITE, 0.5, 2.0, sides=64), math.pi / 2, 0.01),
        (lathe(WHITE, SPHERE, sides=48), math.pi / 6, 0.02),
    ],
)
def test_closed_solids_face_outward(solid: Solid, expected: float, tolerance: float):
    assert volume(solid) == pytest.approx(expected, rel=tolerance)


@pytest.mark.parametrize("turn", [0.3, -1.2, math.pi])
def test_moving_and_turning_keep_a_solid_rigid(turn: float):
    solid = box(WHITE, (1.0, 2.0, 3.0))
    for moved in (solid.turned(turn), solid.tilted(turn), solid.leaned(turn), solid.at(1, 2, 3)):
        assert volume(moved) == pytest.approx(6.0)


def test_a_turn_to_the_left_takes_the_front_to_the_right_hand_side():
    # Seen from above with z down the page, a thing that faces +z faces +x after a left turn.
    front = box(WHITE, (0.1, 0.1, 0.1), (0.0, 0.0, 1.0)).turned(math.pi / 2)
    assert front.vertices_m.mean(axis=0)[[0, 2]] == pytest.approx((1.0, 0.0), abs=1e-9)


def test_a_whole_sheet_shows_its_picture_once_and_upright():
    solid = sheet(WHITE, (0, 0, 0), ((2, 0, 0), (0, 1, 0)), parts=(3, 2), whole=True)
    assert solid.uvs is not None
    corners = solid.vertices_m[solid.triangles]
    assert solid.uvs[..., 0] == pytest.approx(corners[..., 0] / 2)
    assert solid.uvs[..., 1] == pytest.approx(corners[..., 1])


def test_one_tile_covers_its_length_on_every_side():
    solid = box(WHITE, (1.0, 1.0, 1.0))
    uvs = projected_uvs(solid.vertices_m, solid.triangles, 0.25)
    assert np.ptp(uvs.reshape(6, -1, 2), axis=1) == pytest.approx(np.full((6, 2), 4.0))


@pytest.mark.parametrize("kind", sorted(MAKERS))
def test_a_model_stands_on_the_floor_in_the_middle_of_its_footprint(kind: str):
    made = model(kind, Tones("teal", "oak", 1))
    points = np.concatenate([solid.vertices_m for solid in made.solids])
    assert points[:, [0, 2]].max(axis=0) == pytest.approx((made.width_m / 2, made.depth_m / 2))
    assert points[:, [0, 2]].min(axis=0) == pytest.approx((-made.width_m / 2, -made.depth_m / 2))
    lowest = float(points[:, 1].min())
    if kind in HUNG:
        assert lowest > HUNG[kind] - 0.01
    elif kind not in {"washbasin", "towel rail"}:  # which are fixed to the wall
        assert lowest == pytest.approx(0.0, abs=0.03)
    if kind in FLAT:
        assert made.height_m < 0.02


@pytest.mark.parametrize("colour", sorted(COLOURS))
def test_every_colour_word_fits_every_phrase(colour: str):
    for kind, phrase in PHRASES.items():
        assert phrase.format(colour=colour).strip(), kind


def test_colours_are_far_enough_apart_to_tell():
    values = list(COLOURS.values())
    nearest = min(math.dist(a, b) for i, a in enumerate(values) for b in values[i + 1 :])
    assert nearest > 20.0


@pytest.mark.parametrize(
    "picture",
    [
        textures.planks((190, 148, 98)),
        textures.tiles((200, 200, 200), count=4),
        textures.brick((170, 96, 76)),
        textures.carpet((120, 120, 160)),
    ],
    ids=["planks", "tiles", "brick", "carpet"],
)
def test_textures_repeat_without_a_seam(picture: np.ndarray):
    grey = picture[..., :3].mean(axis=2)
    inside = np.abs(np.diff(grey, axis=1)).mean(axis=0)
    across = np.abs(grey[:, 0] - grey[:, -1]).mean()
    assert across <= inside.max() + 1e-9
    assert (picture[..., 3] == 255).all()


def test_noise_is_the_same_for_the_same_seed_and_centred():
    first = textures.noise(64, across=4, down=4, seed=1)
    assert np.array_equal(first, textures.noise(64, across=4, down=4, seed=1))
    assert not np.array_equal(first, textures.noise(64, across=4, down=4, seed=2))
    assert first.mean() == pytest.approx(0.0, abs=1e-9)
    assert first.std() == pytest.approx(1.0)
