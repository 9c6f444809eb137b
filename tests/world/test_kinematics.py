"""Steps and turns: what moves, what collides, what slides."""

import dataclasses
import math
from itertools import pairwise

import pytest

from c2nav_engine.episodes.profile import LAVIRA, VLNCE, Profile
from c2nav_engine.geometry import Pose
from c2nav_engine.world.kinematics import COLLISION_M, Body
from c2nav_engine.world.walkable import WalkableSurface
from tests.helpers.meshes import room, slab, stairs, surface_of


@pytest.fixture(scope="module")
def surface() -> WalkableSurface:
    return surface_of(room(4.0, 4.0))


STOPPING = dataclasses.replace(VLNCE, sliding=False)


@pytest.mark.parametrize("yaw_deg", range(0, 360, 30))
def test_a_free_step_goes_its_length_along_the_heading(surface, yaw_deg):
    pose = Pose((2.0, 0.0, 2.0), math.radians(yaw_deg))
    step = Body(surface, VLNCE).forward(pose)
    assert step.pose.position_m == pytest.approx(pose.ahead(0.25), abs=1e-6)
    assert step.pose.yaw_rad == pose.yaw_rad
    assert step.moved_m == pytest.approx(0.25, abs=1e-6)
    assert not step.collided


@pytest.mark.parametrize("profile", [VLNCE, LAVIRA], ids=lambda profile: profile.name)
def test_turns_are_the_profiles_and_undo_each_other(surface, profile: Profile):
    body, pose = Body(surface, profile), Pose((2.0, 0.0, 2.0), 3.0)
    left = body.turn(pose, left=True)
    assert left.position_m == pose.position_m
    assert math.remainder(left.yaw_rad - 3.0 - profile.turn_rad, math.tau) == pytest.approx(0.0)
    assert body.turn(left, left=False).yaw_rad == pytest.approx(3.0)


def test_a_step_into_a_wall_collides_and_stands_at_its_edge(surface):
    step = Body(surface, VLNCE).forward(Pose((2.0, 0.0, 0.2), 0.0))
    assert step.collided
    assert step.pose.position_m == pytest.approx((2.0, 0.0, 0.1), abs=0.05)
    assert step.moved_m == pytest.approx(0.1, abs=0.05)


def test_a_slanted_step_slides_along_the_wall_or_stops_by_option(surface):
    pose = Pose((2.0, 0.0, 0.15), math.radians(45.0))
    slid, stopped = Body(surface, VLNCE).forward(pose), Body(surface, STOPPING).forward(pose)
    assert slid.collided
    assert stopped.collided
    assert slid.pose.position_m[0] == pytest.approx(2.0 - 0.25 * math.sin(math.pi / 4), abs=1e-4)
    along_x, _, along_z = stopped.pose.position_m
    assert 2.0 - along_x == pytest.approx(0.15 - along_z, abs=1e-6)
    assert slid.moved_m > stopped.moved_m


def test_a_step_along_a_touching_wall_is_free(surface):
    at_wall = Body(surface, VLNCE).forward(Pose((2.0, 0.0, 0.2), 0.0)).pose
    step = Body(surface, VLNCE).forward(Pose(at_wall.position_m, math.pi / 2.0))
    assert not step.collided


def test_pushing_against_a_wall_stays_where_it_is(surface):
    body, pose = Body(surface, VLNCE), Pose((2.0, 0.0, 0.2), 0.0)
    for _ in range(5):
        pose = body.forward(pose).pose
    again = body.forward(pose)
    assert again.moved_m < COLLISION_M
    assert again.pose.position_m == pytest.approx(pose.position_m, abs=COLLISION_M)


@pytest.mark.parametrize("profile", [VLNCE, STOPPING], ids=["sliding", "stopping"])
def test_a_walk_up_and_down_the_stairs_follows_the_floor(profile):
    steps = 8
    end_z = 2.0 + 0.28 * steps
    boxes = [
        slab(0.0, 0.0, 1.0, 2.0),
        *stairs(0.0, 1.0, 2.0, steps),
        slab(0.0, end_z, 1.0, end_z + 2.0, top_m=0.18 * steps),
    ]
    body = Body(surface_of(boxes), profile)
    pose = Pose((0.5, 0.0, 0.5), math.pi)
    heights_m = [0.0]
    for _ in range(20):
        step = body.forward(pose)
        pose = step.pose
        assert not step.collided
        heights_m.append(pose.position_m[1])
    assert pose.position_m[1] == pytest.approx(0.18 * steps, abs=1e-4)
    assert heights_m == sorted(heights_m)
    assert max(b - a for a, b in pairwise(heights_m)) <= 0.25
    pose = Pose(pose.position_m, 0.0)
    for _ in range(20):
        pose = body.forward(pose).pose
    assert pose.position_m == pytest.approx((0.5, 0.0, 0.5), abs=1e-3)
