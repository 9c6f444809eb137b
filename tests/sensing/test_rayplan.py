"""Ray plans: every pixel of both pictures is filled once, by the ray through its centre."""

from __future__ import annotations

import math

import numpy as np
import pytest

from c2nav_engine.geometry import Pinhole
from c2nav_engine.sensing.rayplan import ray_plan

WIDE = Pinhole(30, 20, math.radians(90.0))
SMALL = Pinhole(17, 13, math.radians(60.0))


@pytest.mark.parametrize(("rgb", "depth"), [(WIDE, SMALL), (SMALL, WIDE), (WIDE, WIDE)])
def test_every_pixel_is_filled_once_by_its_own_ray(rgb, depth):
    plan = ray_plan(rgb, depth)
    for pinhole, pixels in ((rgb, plan.rgb_pixels), (depth, plan.depth_pixels)):
        used = pixels >= 0
        assert sorted(pixels[used]) == list(range(pinhole.width_px * pinhole.height_px))
        centres = pinhole.ray_directions().reshape(-1, 3)
        assert np.allclose(plan.directions[used], centres[pixels[used]], atol=1e-6)


@pytest.mark.parametrize(("rgb", "depth"), [(WIDE, SMALL), (SMALL, WIDE), (WIDE, WIDE)])
def test_a_depth_grid_takes_its_own_pixels_rays_alone(rgb, depth):
    plan = ray_plan(rgb, depth, 4)
    grid = depth.ray_directions()[::4, ::4].reshape(-1, 3)
    used = plan.depth_pixels >= 0
    assert sorted(plan.depth_pixels[used]) == list(range(len(grid)))
    assert np.allclose(plan.directions[used], grid[plan.depth_pixels[used]], atol=1e-6)
    assert (plan.rgb_pixels >= 0).sum() == rgb.width_px * rgb.height_px


def test_equal_pinholes_share_their_rays():
    assert len(ray_plan(WIDE, WIDE).directions) == 600
    assert len(ray_plan(WIDE, WIDE, 4).directions) == 600
    assert len(ray_plan(WIDE, SMALL).directions) == 600 + 17 * 13
    assert len(ray_plan(WIDE, SMALL, 4).directions) == 600 + 5 * 4


def test_rays_that_follow_each_other_look_the_same_way():
    profile = Pinhole(224, 224, math.radians(90.0))
    plan = ray_plan(profile, Pinhole(256, 256, math.radians(90.0)))
    steps = np.abs(np.diff(plan.directions[:, :2], axis=0)).max(axis=1)
    tile = 8.0 / profile.focal_px
    assert np.quantile(steps, 0.97) <= tile
