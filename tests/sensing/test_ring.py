"""The sensor ring: keys, angles and what each camera sees."""

from __future__ import annotations

import math

import numpy as np
import pytest

from c2nav_engine.episodes.profile import LAVIRA, VLNCE
from c2nav_engine.geometry import Pose
from c2nav_engine.sensing.conformance_scenes import Room
from c2nav_engine.sensing.embree import EmbreeRenderer
from c2nav_engine.sensing.encode import sectors
from c2nav_engine.sensing.ring import DEPTH_STRIDE, RING_VIEWS, SECTORS, SensorRing

ORIGIN = Pose((0.0, 0.0, 0.0), 0.0)


@pytest.mark.parametrize("profile", [VLNCE, LAVIRA], ids=lambda profile: profile.name)
def test_the_fan_is_left_front_right(profile):
    fan = SensorRing(profile).fan
    assert [camera.key for camera in fan] == ["left", "front", "right"]
    assert [camera.offset_rad for camera in fan] == [
        profile.fan_offset_rad,
        0.0,
        -profile.fan_offset_rad,
    ]


def test_the_ring_goes_once_round_to_the_left():
    ring = SensorRing(VLNCE).ring
    assert [camera.key for camera in ring] == [f"ring{k}" for k in range(12)]
    assert [round(math.degrees(camera.offset_rad)) for camera in ring] == list(range(0, 360, 30))
    assert RING_VIEWS == 2 * SECTORS


def test_cameras_see_what_lies_on_their_side():
    images = SensorRing(VLNCE).capture(
        EmbreeRenderer(Room().scene()), ORIGIN, SensorRing(VLNCE).ring
    )
    middle = [tuple(image.rgb[112, 112].tolist()) for image in images]
    assert middle[0] == (255, 255, 255)
    assert middle[3] == (255, 0, 0)
    assert middle[6] == (255, 0, 255)
    assert middle[9] == (255, 255, 0)


def test_only_the_view_ahead_is_sensed_whole_in_depth():
    ring = SensorRing(VLNCE)
    renderer = EmbreeRenderer(Room().scene())
    whole, grid = (256, 256), (256 // DEPTH_STRIDE, 256 // DEPTH_STRIDE)
    fan = ring.capture(renderer, ORIGIN, ring.fan)
    assert [image.depth_m.shape for image in fan] == [grid, whole, grid]
    views = ring.capture(renderer, ORIGIN, ring.ring)
    assert {image.depth_m.shape for image in views} == {grid}
    # Both look ahead, so what the one senses is a part of what the other does.
    assert np.array_equal(views[0].depth_m, fan[1].depth_m[::DEPTH_STRIDE, ::DEPTH_STRIDE])
    assert np.array_equal(views[0].rgb, fan[1].rgb)


def test_a_capture_is_the_same_alone_and_together():
    ring = SensorRing(VLNCE)
    renderer = EmbreeRenderer(Room().scene())
    together = ring.capture(renderer, ORIGIN.turned(0.3), ring.fan)
    front = ring.capture(renderer, ORIGIN.turned(0.3), ring.front)[0]
    assert np.array_equal(together[1].rgb, front.rgb)
    assert np.array_equal(together[1].depth_m, front.depth_m)


def test_turning_the_body_turns_the_ring():
    ring = SensorRing(VLNCE)
    renderer = EmbreeRenderer(Room().scene())
    before = ring.capture(renderer, ORIGIN, ring.ring)
    after = ring.capture(renderer, ORIGIN.turned(math.radians(90.0)), ring.ring)
    for k in range(RING_VIEWS):
        drift = np.abs(after[k].depth_m - before[(k + 3) % RING_VIEWS].depth_m)
        assert drift.max() < 1e-4


def test_sectors_join_neighbours_with_the_further_left_on_the_left():
    views = [np.full((2, 3, 3), k, np.uint8) for k in range(RING_VIEWS)]
    joined = sectors(views)
    assert len(joined) == SECTORS
    for k, sector in enumerate(joined):
        assert sector.shape == (2, 6, 3)
        assert (sector[:, :3] == 2 * k + 1).all()
        assert (sector[:, 3:] == 2 * k).all()
