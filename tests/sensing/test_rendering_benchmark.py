"""The rendering benchmark measures what it says, whatever the times are."""

from __future__ import annotations

from benchmarks.rendering import building, open_places, over_casts
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.sensing.embree import EmbreeRenderer
from c2nav_engine.sensing.ring import SensorRing


def test_the_building_has_the_triangles_that_were_asked_for():
    for wanted in (3_000, 50_000):
        count = len(building(wanted).triangles)
        assert wanted <= count <= 1.5 * wanted


def test_a_building_has_doorways_to_look_through():
    scene = building(20_000)
    renderer = EmbreeRenderer(scene)
    front = SensorRing(VLNCE).capture(
        renderer, open_places(renderer, scene, VLNCE)[0], SensorRing(VLNCE).front
    )
    assert front[0].depth_m.max() > 4.0


def test_places_lie_on_the_floor_with_room_around():
    scene = building(20_000)
    for place in open_places(EmbreeRenderer(scene), scene, VLNCE):
        assert abs(place.position_m[1]) < 0.05


def test_a_ratio_compares_two_positive_times():
    ratio = over_casts(building(5_000), SensorRing(VLNCE).front, rounds=4)
    assert ratio.above_ms > 0.0
    assert ratio.below_ms > 0.0
    assert ratio.value == ratio.above_ms / ratio.below_ms
