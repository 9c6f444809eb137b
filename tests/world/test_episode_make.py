"""Episodes made on any mesh hold on its floor, and say what the mesh's names say."""

from __future__ import annotations

import math

import numpy as np
import pytest

from c2nav_engine.contract.lint import metric_words
from c2nav_engine.contract.route import parse_english
from c2nav_engine.errors import SceneError
from c2nav_engine.world.episode_check import check_episode
from c2nav_engine.world.episode_make import MakeConfig, make_episodes, told
from c2nav_engine.world.part_words import NamedThing, named_things, words_of_part
from c2nav_engine.world.scene import Material, Piece, Scene, scene_of
from c2nav_engine.world.walkable import WalkableSurface
from tests.helpers.meshes import Box, room, slab, surface_of, wall

SOFA = Box((4.0, 0.0, 0.2), (6.0, 0.8, 1.0))
SHELF = Box((8.8, 0.0, 6.0), (9.8, 1.9, 6.4))
BOXES = {"SofaC_01_001/mesh": SOFA, "Bookshelf_02/mesh": SHELF}


def scene(boxes: dict[str, Box]) -> Scene:
    pieces = []
    for name, shape in boxes.items():
        vertices, triangles = shape.mesh()
        white = Material("white")
        pieces.append(Piece(name, white, vertices.astype(np.float32), triangles.astype(np.int32)))
    return scene_of("test", pieces)


@pytest.fixture(scope="module")
def floor() -> WalkableSurface:
    return surface_of([*room(10.0, 7.0), wall(4.9, 2.0, 5.1, 7.0), *BOXES.values()])


def test_made_episodes_hold_and_are_the_same_for_the_same_seed(floor: WalkableSurface):
    made = make_episodes(floor, scene(BOXES), count=8, seed=3)
    assert made == make_episodes(floor, scene(BOXES), count=8, seed=3)
    assert made != make_episodes(floor, scene(BOXES), count=8, seed=4)
    assert [each.episode_id for each in made] == [str(k + 1) for k in range(8)]
    for episode in made:
        assert check_episode(episode, floor) == []
        assert episode.geodesic_m is not None
        assert 4.0 <= episode.geodesic_m <= 17.0
        assert metric_words(episode.instruction) == []
        assert parse_english(episode.instruction).legs


def test_a_floor_that_is_too_small_is_said_so():
    with pytest.raises(SceneError, match="expected 2 routes of 4 to 17 m, came 0"):
        make_episodes(surface_of(room(2.0, 2.0)), scene(BOXES), count=2, seed=0)


def test_wanted_lengths_are_kept(floor: WalkableSurface):
    config = MakeConfig(shortest_m=2.0, longest_m=3.0)
    for episode in make_episodes(floor, scene(BOXES), count=4, seed=0, config=config):
        assert episode.geodesic_m is not None
        assert 2.0 <= episode.geodesic_m <= 3.0


def test_nobody_starts_on_the_roof():
    roofed = surface_of([*room(10.0, 7.0), slab(-0.1, -0.1, 10.1, 7.1, top_m=2.6)])
    for episode in make_episodes(roofed, scene(BOXES), count=6, seed=0):
        assert episode.start.position_m[1] < 1.0


def test_texts_say_turns_and_sides_as_the_path_takes_them():
    lamp = NamedThing("lamp", (1.0, 0.0, -3.2), (1.4, 1.5, -2.8))
    door = NamedThing("door", (-4.4, 0.0, -6.1), (-4.0, 2.0, -5.0))
    ahead = [(0.0, 0.0, -float(k)) for k in range(7)]
    left = [(-float(k), 0.0, -6.0) for k in range(1, 5)]
    text = told([*ahead, *left], math.pi, [lamp, door])
    assert text == (
        "Turn around and walk past the lamp on your right. "
        "Turn left and walk straight on. Stop next to the door."
    )


def test_without_names_turns_are_all_there_is():
    assert told([(0.0, 0.0, 0.0), (0.0, 0.0, -3.0)], 0.0, []) == "Walk straight on. Stop there."


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("Refrigerator_01_001/aws_Refrigerator_01_visual-lib_1", "refrigerator"),
        ("TVCabinet_01_001/aws_x", "tv cabinet"),
        ("SofaC_01_001/mesh", "sofa"),
        ("study/teal globe", "teal globe"),
        ("living room/plant in the teal pot", "plant in the teal pot"),
        ("wall/kitchen", ""),
        ("floor/kitchen", ""),
        ("Object_12", ""),
        ("mesh0", ""),
        ("", ""),
    ],
)
def test_part_names_become_words(name: str, words: str):
    assert words_of_part(name) == words


def test_two_things_of_one_name_are_not_mentioned():
    twice = scene({"Chair_01/a": SOFA, "Chair_02/a": SHELF, "Vase_01/a": SHELF})
    assert [thing.words for thing in named_things(twice)] == ["vase"]
