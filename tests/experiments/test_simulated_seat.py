from __future__ import annotations

import math

import numpy as np
import pytest

from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.contract.question import Slot
from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.simulated_seat import simulated_seat
from c2nav_engine.geometry import Point, Pose
from c2nav_engine.navigator.requests import Ask, Candidate, Facts
from c2nav_engine.navigator.variants import preset
from c2nav_engine.runner.opening import Stage
from c2nav_engine.runner.worlds import World, embree
from c2nav_engine.world.scene import Material, Part, Scene
from tests.helpers.meshes import merged, room, surface_of
from tests.helpers.questions import question

START = Pose((1.0, 0.0, 1.0), 0.0)


@pytest.fixture(scope="module")
def world() -> World:
    boxes = room(6.0, 6.0)
    vertices, triangles = merged(boxes)
    scene = Scene(
        name="room",
        vertices_m=vertices.astype(np.float32),
        triangles=triangles.astype(np.int32),
        parts=(Part("room", 0, 0, len(triangles)),),
        materials=(Material("plain"),),
    )
    return World(scene, surface_of(boxes), embree)


def stage(world: World, goal_m: Point | None) -> Stage:
    episode = Episode("3", "3", "room", START, "Walk.", goal_m)
    goal_field = None if goal_m is None else world.field(goal_m)
    return Stage(episode, world, START, goal_field, VLNCE, ("Walk",), preset("full"), seed=0)


def election() -> Ask:
    asked = question(Slot.SEEING)
    views = tuple(
        Candidate(key, True, free_m=3.0, offset_rad=math.radians(degrees))
        for key, degrees in (("left", 45.0), ("front", 0.0), ("right", -45.0))
    )
    return Ask(asked, Facts(Slot.SEEING, 0, 0, views, START, 0.0, 0.0))


def test_a_privileged_observer_sits_at_its_episode(world: World) -> None:
    # Forward is −z, against the wall; the goal lies to the right along +x.
    seat = simulated_seat(stage(world, (5.0, 0.0, 1.0)), {"d_prime": "50"})
    assert seat.privileged and seat.name == "simulated"
    assert seat.options["d_prime"] == "50.0"
    assert seat.ranker is not None and seat.before_ask is not None
    ask = election()
    seat.before_ask(ask, [])
    ranked = seat.ranker.rank(ask.question)
    assert ranked.privileged
    assert isinstance(ranked.outcome, Ordering) and ranked.outcome.winner == "right"


def test_it_answers_the_same_whenever_it_is_asked(world: World) -> None:
    ask = election()
    outcomes: set[object] = set()
    for _ in range(2):
        seat = simulated_seat(stage(world, (5.0, 0.0, 1.0)), {})
        assert seat.ranker is not None and seat.before_ask is not None
        seat.before_ask(ask, [])
        outcomes |= {seat.ranker.rank(ask.question).outcome for _ in range(2)}
    assert len(outcomes) == 1


def test_it_needs_a_goal_and_known_options(world: World) -> None:
    with pytest.raises(UsageError, match="choose another ranker"):
        simulated_seat(stage(world, None), {})
    with pytest.raises(UsageError, match="has no option beta_"):
        simulated_seat(stage(world, (5.0, 0.0, 1.0)), {"beta_": "1"})


def test_it_judges_only_the_pending_question(world: World) -> None:
    seat = simulated_seat(stage(world, (5.0, 0.0, 1.0)), {})
    assert seat.ranker is not None
    with pytest.raises(UsageError, match="pending question of a running episode"):
        seat.ranker.rank(election().question)
