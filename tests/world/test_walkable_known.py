"""Scenes whose shortest paths are known exactly: a body's centre keeps its radius from walls."""

import math

import numpy as np
import pytest

from c2nav_engine.errors import SceneError, StartError
from c2nav_engine.world.walkable import WalkableSurface, build_surface
from tests.helpers.meshes import (
    Box,
    merged,
    room,
    slab,
    stairs,
    surface_of,
    wall,
    way_around_m,
)

STAIRS = 14
UP_M = 0.18 * STAIRS
RUN_M = 0.28 * STAIRS


def two_storeys() -> WalkableSurface:
    """A ground floor and, above half of it, an upper floor that a flight of stairs leads to."""
    return surface_of(
        [
            slab(0.0, 0.0, 4.0, 12.0),
            *stairs(0.0, 1.0, 3.0, STAIRS),
            slab(0.0, 3.0 + RUN_M, 4.0, 12.0, top_m=UP_M),
        ]
    )


def close(measured_m: float, true_m: float) -> bool:
    """Never shorter than the truth, and at most 3 % longer."""
    return true_m - 1e-6 <= measured_m <= 1.03 * true_m


def test_an_empty_room_is_crossed_in_a_straight_line():
    surface = surface_of(room(6.0, 4.0))
    start, end = (0.33, 0.0, 0.41), (5.52, 0.0, 3.47)
    assert surface.geodesic_m(start, end) == pytest.approx(math.dist(start, end), abs=1e-6)
    path = surface.path(start, end)
    assert path is not None
    assert path == [pytest.approx(start, abs=1e-6), pytest.approx(end, abs=1e-6)]


def test_the_body_keeps_its_radius_from_the_walls_of_an_empty_room():
    area_m2 = surface_of(room(6.0, 4.0)).area_m2
    assert 5.7 * 3.7 <= area_m2 <= 5.8 * 3.8 + 1e-9


def test_a_door_bends_the_path_at_its_jamb():
    surface = surface_of([*room(6.0, 4.0), wall(2.95, 0.0, 3.05, 2.0), wall(2.95, 2.8, 3.05, 4.0)])
    start, end = (1.0, 0.0, 0.5), (5.0, 0.0, 0.5)
    true_m = way_around_m((1.0, 0.5), (5.0, 0.5), [(2.95, 2.0), (3.05, 2.0)])
    assert close(surface.geodesic_m(start, end), true_m)


def test_a_u_maze_is_walked_around_the_end_of_its_wall():
    surface = surface_of([*room(4.0, 6.0), wall(1.95, 0.0, 2.05, 5.0)])
    start, end = (1.0, 0.0, 0.5), (3.0, 0.0, 0.5)
    true_m = way_around_m((1.0, 0.5), (3.0, 0.5), [(1.95, 5.0), (2.05, 5.0)])
    assert close(surface.geodesic_m(start, end), true_m)


def test_an_l_corridor_turns_at_its_inner_corner():
    surface = surface_of([*room(6.0, 6.0), wall(1.2, 1.2, 6.0, 6.0)])
    start, end = (0.5, 0.0, 5.5), (5.5, 0.0, 0.5)
    true_m = way_around_m((0.5, 5.5), (5.5, 0.5), [(1.2, 1.2)])
    assert close(surface.geodesic_m(start, end), true_m)


def test_a_wall_without_thickness_blocks_too():
    sheet = Box((3.0, 0.0, 0.0), (3.0, 2.4, 3.0))
    surface = surface_of([*room(6.0, 4.0), sheet])
    true_m = way_around_m((2.0, 0.5), (4.0, 0.5), [(3.0, 3.0)])
    assert close(surface.geodesic_m((2.0, 0.0, 0.5), (4.0, 0.0, 0.5)), true_m)


def test_stairs_join_two_storeys_and_lengths_follow_the_slope():
    surface = two_storeys()
    start, end = (0.5, 0.0, 1.0), (0.5, UP_M, 11.0)
    true_m = 2.0 + math.hypot(RUN_M, UP_M) + (11.0 - 3.0 - RUN_M)
    assert surface.geodesic_m(start, end) == pytest.approx(true_m, rel=0.03)
    assert surface.geodesic_m(end, start) == pytest.approx(true_m, rel=0.03)


def test_one_place_on_two_storeys_is_two_places():
    surface = two_storeys()
    below, above = surface.snap((3.0, 0.1, 10.0)), surface.snap((3.0, UP_M - 0.1, 10.0))
    assert below == pytest.approx((3.0, 0.0, 10.0), abs=1e-6)
    assert above == pytest.approx((3.0, UP_M, 10.0), abs=1e-6)
    assert below is not None
    assert above is not None
    assert surface.geodesic_m(below, above) > 10.0


def test_a_path_up_the_stairs_stays_on_them():
    path = two_storeys().path((0.5, 0.0, 1.0), (0.5, UP_M, 11.0))
    assert path is not None
    for x, y, z in path:
        slope_m = min(max((z - 3.0) / RUN_M * UP_M, 0.0), UP_M)
        assert y == pytest.approx(slope_m, abs=0.2), (x, y, z)


def test_a_step_higher_than_the_climb_parts_the_floor():
    boxes = [slab(0.0, 0.0, 2.0, 2.0), slab(2.0, 0.0, 4.0, 2.0, top_m=0.19)]
    start, end = (0.5, 0.0, 1.0), (3.5, 0.19, 1.0)
    assert math.isfinite(surface_of(boxes).geodesic_m(start, end))
    assert surface_of(boxes, climb_m=0.18).geodesic_m(start, end) == math.inf
    assert surface_of(boxes, climb_m=0.18).path(start, end) is None


@pytest.mark.parametrize(("slope_deg", "walkable"), [(40.0, True), (50.0, False)])
def test_a_ramp_carries_up_to_the_slope_limit(slope_deg: float, walkable: bool):
    rise_m = math.tan(math.radians(slope_deg))
    boxes = [slab(0.0, 0.0, 2.0, 2.0), slab(3.0, 0.0, 5.0, 2.0, top_m=rise_m)]
    vertices_m, triangles = merged(boxes)
    ramp = np.array([[2.0, 0.0, 0.0], [3.0, rise_m, 0.0], [3.0, rise_m, 2.0], [2.0, 0.0, 2.0]])
    quad = np.array([[0, 1, 2], [0, 2, 3]]) + len(vertices_m)
    surface = build_surface(
        np.concatenate([vertices_m, ramp]),
        np.concatenate([triangles, quad]),
        height_m=1.5,
        radius_m=0.1,
        climb_m=0.2,
        slope_rad=math.radians(45.0),
    )
    distance_m = surface.geodesic_m((0.5, 0.0, 1.0), (4.5, rise_m, 1.0))
    assert math.isfinite(distance_m) == walkable
    if walkable:
        assert distance_m == pytest.approx(3.0 + math.hypot(1.0, rise_m), rel=0.03)


def test_a_low_beam_blocks_a_tall_body_only():
    boxes = [*room(4.0, 2.0), Box((1.9, 1.0, 0.0), (2.1, 1.2, 2.0))]
    start, end = (1.0, 0.0, 1.0), (3.0, 0.0, 1.0)
    assert surface_of(boxes).geodesic_m(start, end) == math.inf
    assert surface_of(boxes, height_m=0.88).geodesic_m(start, end) == pytest.approx(2.0, abs=0.01)


def test_a_table_top_is_no_part_of_the_floor():
    table = Box((2.0, 0.7, 1.0), (4.0, 0.75, 3.0))
    surface = surface_of([*room(6.0, 4.0), table])
    assert surface.snap((3.0, 0.75, 2.0)) == pytest.approx((3.0, 0.75, 2.0), abs=1e-6)
    assert surface.geodesic_m((0.5, 0.0, 0.5), (3.0, 0.75, 2.0)) == math.inf


def test_a_snap_prefers_the_nearest_point_and_gives_up_outside_its_box():
    surface = surface_of([*room(6.0, 4.0), Box((2.0, 0.7, 1.0), (4.0, 0.75, 3.0))])
    assert surface.snap((3.0, 0.9, 2.0)) == pytest.approx((3.0, 0.75, 2.0), abs=1e-6)
    beside = surface.snap((2.1, 0.0, 2.0))
    assert beside == pytest.approx((1.9, 0.0, 2.0), abs=0.06)
    assert surface.snap((3.0, 4.7, 2.0)) == pytest.approx((3.0, 0.75, 2.0), abs=1e-6)
    assert surface.snap((3.0, 5.0, 2.0)) is None
    assert surface.snap((9.0, 0.0, 2.0)) is None


def test_small_things_underfoot_are_rolled_over():
    sill = Box((1.95, 0.02, 0.0), (2.05, 0.03, 2.0))
    surface = surface_of([*room(4.0, 2.0), sill])
    assert surface.geodesic_m((1.0, 0.0, 1.0), (3.0, 0.0, 1.0)) == pytest.approx(2.0, abs=0.01)


def test_the_surface_shows_as_few_triangles_of_the_right_area():
    surface = surface_of([*room(6.0, 4.0), wall(2.0, 1.0, 4.0, 3.0)])
    triangles = surface.triangles()
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    assert (normals[:, 1] > 0.0).all()
    assert normals[:, 1].sum() / 2.0 == pytest.approx(surface.area_m2)
    assert len(triangles) < 100


def test_a_stored_surface_answers_as_the_built_one(tmp_path):
    surface = two_storeys()
    surface.save(tmp_path / "surface.npz")
    loaded = WalkableSurface.load(tmp_path / "surface.npz")
    start, end = (0.5, 0.0, 1.0), (3.0, UP_M, 11.0)
    assert loaded.path(start, end) == surface.path(start, end)
    assert loaded.source == surface.source == "built"


def test_a_file_that_is_no_surface_is_named(tmp_path):
    (tmp_path / "bad.npz").write_bytes(b"no surface")
    with pytest.raises(SceneError, match=r"bad\.npz"):
        WalkableSurface.load(tmp_path / "bad.npz")


def test_a_mesh_without_room_to_stand_is_refused():
    with pytest.raises(SceneError, match="Y is up"):
        surface_of([Box((0.0, 0.0, 0.0), (0.1, 3.0, 0.1))])


def test_a_move_from_nowhere_is_refused():
    with pytest.raises(StartError, match="snap"):
        surface_of(room(2.0, 2.0)).slide((50.0, 0.0, 50.0), (51.0, 0.0, 50.0))
