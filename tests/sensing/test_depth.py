"""Depth pictures: statistics over what returned, and points that lie on the surfaces."""

from __future__ import annotations

import math

import numpy as np
import pytest

from c2nav_engine.geometry import Pinhole, Pose, world_from_camera
from c2nav_engine.sensing.conformance import room_depth_m
from c2nav_engine.sensing.conformance_scenes import Room
from c2nav_engine.sensing.depth import depth_facts, depth_points

PINHOLE = Pinhole(40, 30, math.radians(90.0))


def test_the_median_is_over_what_returned():
    depth_m = np.asarray([[0.0, np.nan, 1.0], [2.0, 9.0, 0.0]], np.float32)
    assert depth_facts(depth_m) == (2.0, 0.5)


def test_without_a_return_there_is_no_median():
    assert depth_facts(np.zeros((3, 3), np.float32)) == (0.0, 1.0)


def test_what_lies_out_of_range_is_a_hole():
    depth_m = np.asarray([[0.05, 1.0, 12.0, 3.0]], np.float32)
    assert depth_facts(depth_m, near_m=0.1, far_m=10.0) == (2.0, 0.5)


@pytest.mark.parametrize("yaw_rad", [0.0, 1.1, -2.4, math.pi])
def test_points_lie_on_the_walls_that_were_seen(yaw_rad):
    room = Room()
    matrix = world_from_camera(Pose((0.4, 0.0, -0.9), yaw_rad), height_m=1.25)
    depth_m = room_depth_m(room, matrix, PINHOLE).astype(np.float32)
    points_m = depth_points(depth_m, PINHOLE, matrix, near_m=0.0, far_m=100.0)
    assert points_m.shape == (1200, 3)
    gaps = np.stack(
        [
            room.half_width_m - np.abs(points_m[:, 0]),
            np.minimum(points_m[:, 1], room.height_m - points_m[:, 1]),
            room.ahead_m - np.abs(points_m[:, 2]),
        ],
        axis=1,
    )
    assert np.abs(gaps.min(axis=1)).max() < 1e-5


def test_a_point_ahead_of_a_turned_body_lies_where_its_heading_points():
    pose = Pose((1.0, 0.0, 2.0), math.radians(90.0))
    middle = Pinhole(1, 1, math.radians(90.0))
    depth_m = np.asarray([[3.0]], np.float32)
    matrix = world_from_camera(pose, height_m=1.0)
    points_m = depth_points(depth_m, middle, matrix, near_m=0.0, far_m=10.0)
    x, y, z = pose.ahead(3.0)
    assert points_m[0] == pytest.approx([x, y + 1.0, z])


def test_holes_give_no_point_and_a_stride_thins():
    depth_m = np.ones((30, 40), np.float32)
    depth_m[::2] = np.nan
    depth_m[1] = 0.0
    matrix = np.eye(4)
    every = depth_points(depth_m, PINHOLE, matrix, near_m=0.0, far_m=10.0)
    assert len(every) == 14 * 40
    full = np.ones((30, 40), np.float32)
    thinned = depth_points(full[::4, ::4], PINHOLE, matrix, near_m=0.0, far_m=10.0, stride=4)
    assert len(thinned) == 8 * 10
    whole = depth_points(full, PINHOLE, matrix, near_m=0.0, far_m=10.0).reshape(30, 40, 3)
    assert np.array_equal(thinned, whole[::4, ::4].reshape(-1, 3))
