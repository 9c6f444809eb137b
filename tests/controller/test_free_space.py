"""Free space from synthetic depth: walls, doors, tables, stairs, drops, and what memory adds."""

import math

import numpy as np
import pytest

from c2nav_engine.controller.free_space import FreeSpaceConfig, FreeSpaceMemory
from c2nav_engine.episodes.profile import LAVIRA, VLNCE, Profile
from c2nav_engine.geometry import Pose
from tests.helpers.meshes import Box, slab
from tests.helpers.seen import depth_points_m

FLOOR = slab(-10.0, -10.0, 10.0, 10.0)
START = Pose((0.0, 0.0, 0.0), 0.0)
"""Looks along −z."""

both = pytest.mark.parametrize("profile", [VLNCE, LAVIRA], ids=lambda profile: profile.name)


def free_ahead_m(
    boxes: list[Box],
    profile: Profile = VLNCE,
    *,
    along: list[Pose] | None = None,
    offset_rad: float = 0.0,
) -> float:
    """Free space of the last pose, after having looked from every pose on the way."""
    memory = FreeSpaceMemory(profile)
    travelled_m, before = 0.0, (along or [START])[0]
    for pose in along or [START]:
        travelled_m += math.dist(pose.position_m, before.position_m)
        before = pose
        memory.observe(depth_points_m(boxes, pose, profile, offset_rad=offset_rad), travelled_m)
    return memory.free_m(before, offset_rad)


def approach(from_m: float, to_m: float, *, height_m: float = 0.0) -> list[Pose]:
    """Poses a step apart along −z."""
    steps = round((to_m - from_m) / 0.25)
    return [Pose((0.0, height_m, -from_m - 0.25 * i), 0.0) for i in range(steps + 1)]


def wall_ahead(distance_m: float) -> Box:
    return Box((-5.0, 0.0, -distance_m - 0.1), (5.0, 2.5, -distance_m))


def stairs_ahead(distance_m: float, *, up: bool, steps: int = 10) -> list[Box]:
    """A flight along −z of 0.18 m risers and 0.28 m treads, and the landing behind it."""
    sign = 1.0 if up else -1.0
    boxes = [
        Box(
            (-1.0, -5.0, -distance_m - 0.28 * (i + 1)),
            (1.0, sign * 0.18 * (i + 1), -distance_m - 0.28 * i),
        )
        for i in range(steps)
    ]
    end_m = distance_m + 0.28 * steps
    landing = Box((-1.0, -5.0, -end_m - 1.2), (1.0, sign * 0.18 * steps, -end_m))
    return [*boxes, landing, Box((-1.0, -5.0, -end_m - 1.3), (1.0, 5.0, -end_m - 1.2))]


def floor_until(distance_m: float) -> Box:
    return Box((-3.0, -0.1, -distance_m), (3.0, 0.0, 5.0))


def test_nothing_seen_is_nothing_free():
    assert FreeSpaceMemory(VLNCE).free_m(START, 0.0) == 0.0


@both
def test_an_open_floor_is_free_up_to_the_cap(profile):
    assert free_ahead_m([FLOOR, wall_ahead(8.0)], profile) == FreeSpaceConfig().max_range_m


@both
@pytest.mark.parametrize("distance_m", [0.4, 0.9, 1.7, 2.6])
def test_a_wall_ends_the_travel_a_radius_before_it(profile, distance_m):
    free_m = free_ahead_m([FLOOR, wall_ahead(distance_m)], profile)
    assert free_m == pytest.approx(distance_m - profile.radius_m, abs=0.03)


@both
@pytest.mark.parametrize("offset_deg", [-60.0, -45.0, 45.0, 60.0])
def test_an_oblique_wall_is_met_along_the_heading(profile, offset_deg):
    offset_rad = math.radians(offset_deg)
    free_m = free_ahead_m([FLOOR, wall_ahead(0.8)], profile, offset_rad=offset_rad)
    # A disc on a slanted line touches the wall where its centre is a radius away.
    true_m = (0.8 - profile.radius_m) / math.cos(offset_rad)
    assert free_m == pytest.approx(true_m, abs=0.08)


@both
def test_what_stands_behind_the_body_does_not_matter(profile):
    behind = Box((-5.0, 0.0, 0.3), (5.0, 2.5, 0.4))
    memory = FreeSpaceMemory(profile)
    for yaw_rad in (0.0, math.pi):
        pose = Pose(START.position_m, yaw_rad)
        memory.observe(depth_points_m([FLOOR, wall_ahead(5.0), behind], pose, profile), 0.0)
    assert memory.free_m(START, 0.0) == FreeSpaceConfig().max_range_m
    assert memory.free_m(START, math.pi) == pytest.approx(0.3 - profile.radius_m, abs=0.03)


@both
@pytest.mark.parametrize("aside_m", [-0.25, 0.0, 0.25])
def test_a_door_lets_the_body_through(profile, aside_m):
    left = Box((-5.0, 0.0, -1.1), (aside_m - 0.4, 2.5, -1.0))
    right = Box((aside_m + 0.4, 0.0, -1.1), (5.0, 2.5, -1.0))
    lintel = Box((-5.0, 2.0, -1.1), (5.0, 2.5, -1.0))
    boxes = [FLOOR, left, right, lintel, wall_ahead(6.0)]
    assert free_ahead_m(boxes, profile) == FreeSpaceConfig().max_range_m


@both
def test_a_door_post_in_the_way_blocks(profile):
    post = Box((0.05, 0.0, -1.1), (0.15, 2.5, -1.0))
    free_m = free_ahead_m([FLOOR, post, wall_ahead(6.0)], profile)
    assert free_m == pytest.approx(1.0 - profile.radius_m, abs=0.05)


@both
def test_a_table_top_blocks_bodies_that_do_not_fit_under_it(profile):
    table = Box((-0.5, 0.70, -2.2), (0.5, 0.75, -1.4))
    free_m = free_ahead_m([FLOOR, table, wall_ahead(6.0)], profile)
    assert free_m == pytest.approx(1.4 - profile.radius_m, abs=0.1)


def test_a_beam_above_a_low_body_does_not_block_it():
    beam = Box((-1.0, 1.0, -1.6), (1.0, 1.2, -1.4))
    boxes = [FLOOR, beam, wall_ahead(6.0)]
    assert free_ahead_m(boxes, LAVIRA) == FreeSpaceConfig().max_range_m
    assert free_ahead_m(boxes, VLNCE) == pytest.approx(1.3, abs=0.05)


@both
def test_a_rug_is_free_and_a_crate_is_not(profile):
    rug = Box((-1.0, 0.0, -2.5), (1.0, 0.03, -1.0))
    crate = Box((-0.3, 0.0, -2.2), (0.3, 0.35, -1.8))
    boxes = [FLOOR, rug, wall_ahead(6.0)]
    assert free_ahead_m(boxes, profile) == FreeSpaceConfig().max_range_m
    assert free_ahead_m([*boxes, crate], profile) == pytest.approx(1.7, abs=0.05)


@both
@pytest.mark.parametrize("distance_m", [0.15, 0.5, 1.0, 1.75])
def test_stairs_are_free_upwards(profile, distance_m):
    boxes = [FLOOR, *stairs_ahead(distance_m, up=True)]
    assert free_ahead_m(boxes, profile) > distance_m + 0.8


@both
@pytest.mark.parametrize("distance_m", [0.15, 0.5, 0.75])
def test_stairs_are_free_downwards(profile, distance_m):
    boxes = [floor_until(distance_m), *stairs_ahead(distance_m, up=False)]
    assert free_ahead_m(boxes, profile) > distance_m + 0.8


@both
@pytest.mark.parametrize("up", [True, False], ids=["up", "down"])
def test_stairs_stay_free_while_walking_on_them(profile, up):
    boxes = [floor_until(0.5), *stairs_ahead(0.5, up=up)]
    sign = 1.0 if up else -1.0
    poses = [Pose((0.0, 0.0, 0.5 - 0.25 * i), 0.0) for i in range(4)]
    for step in range(6):
        poses.append(Pose((0.0, sign * 0.18 * (step + 1), -0.5 - 0.28 * (step + 0.5)), 0.0))
    memory = FreeSpaceMemory(profile)
    for i, pose in enumerate(poses):
        memory.observe(depth_points_m(boxes, pose, profile), 0.3 * i)
        assert i < 4 or memory.free_m(pose, 0.0) > 0.95, i


@both
def test_a_step_higher_than_the_climb_ends_the_travel(profile):
    stage = Box((-3.0, 0.0, -6.0), (3.0, 0.3, -1.5))
    free_m = free_ahead_m([FLOOR, stage, wall_ahead(6.0)], profile)
    assert free_m == pytest.approx(1.4, abs=0.05)


def test_a_stairwell_ends_the_travel_at_its_edge():
    lower = Box((-3.0, -2.6, -12.0), (3.0, -2.5, 5.0))
    far = Box((-3.0, -2.5, -9.0), (3.0, 2.5, -8.9))
    boxes = [floor_until(2.5), lower, far]
    for to_m in (1.25, 1.5, 2.0):
        free_m = free_ahead_m(boxes, along=approach(0.0, to_m))
        assert free_m == pytest.approx(2.5 - to_m - VLNCE.radius_m, abs=0.12), to_m


@both
def test_a_hole_in_the_floor_ends_the_travel_at_its_edge(profile):
    boxes = [
        floor_until(2.0),
        Box((-3.0, -0.1, -9.0), (3.0, 0.0, -3.0)),
        Box((-3.0, -0.1, -9.1), (3.0, 2.5, -9.0)),
    ]
    free_m = free_ahead_m(boxes, profile)
    assert free_m == pytest.approx(1.9, abs=0.2)


def test_a_crate_below_the_picture_is_remembered():
    crate = Box((-0.3, 0.0, -2.2), (0.3, 0.35, -1.8))
    boxes = [FLOOR, crate, wall_ahead(6.0)]
    near = Pose((0.0, 0.0, -1.5), 0.0)
    assert free_ahead_m(boxes, along=approach(0.0, 1.5)) == pytest.approx(0.2, abs=0.05)
    # Without memory the camera looks over it: this is why there is one.
    assert free_ahead_m(boxes, along=[near]) > 1.0


def test_points_are_forgotten_after_three_metres_of_travel():
    memory = FreeSpaceMemory(VLNCE)
    memory.observe(depth_points_m([FLOOR, wall_ahead(1.0)], START, VLNCE), 0.0)
    empty = np.empty((0, 3))
    memory.observe(empty, 2.9)
    assert memory.free_m(START, 0.0) == pytest.approx(0.9, abs=0.03)
    memory.observe(empty, 3.1)
    assert memory.free_m(START, 0.0) == 0.0


@both
def test_what_nobody_saw_is_not_free(profile):
    wall_aside = Box((-3.0, 0.0, -1.0), (-2.9, 2.5, 1.0))
    memory = FreeSpaceMemory(profile)
    memory.observe(depth_points_m([FLOOR, wall_aside], START, profile), 0.0)
    assert memory.free_m(START, 0.0) > 1.0
    assert memory.free_m(START, math.pi) == 0.0


@both
def test_the_same_sight_moved_and_turned_gives_the_same_free_space(profile):
    points_m = depth_points_m([FLOOR, wall_ahead(1.7)], START, profile)
    still = FreeSpaceMemory(profile)
    still.observe(points_m, 0.0)
    moved = Pose((3.0, 1.4, -2.0), 1.0)
    sin, cos = math.sin(moved.yaw_rad), math.cos(moved.yaw_rad)
    turn = np.array([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]])
    memory = FreeSpaceMemory(profile)
    memory.observe(points_m @ turn.T + np.array(moved.position_m), 0.0)
    for offset_rad in (-0.6, 0.0, 0.6):
        expected_m = still.free_m(START, offset_rad)
        assert memory.free_m(moved, offset_rad) == pytest.approx(expected_m, abs=0.06)


def test_seeing_the_same_again_keeps_the_memory_small():
    memory = FreeSpaceMemory(VLNCE)
    points_m = depth_points_m([FLOOR, wall_ahead(3.0)], START, VLNCE)
    memory.observe(points_m, 0.0)
    once = memory.remembered
    for _ in range(5):
        memory.observe(points_m, 0.0)
    assert memory.remembered == once <= len(points_m)
