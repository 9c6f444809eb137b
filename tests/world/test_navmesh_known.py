"""Small meshes whose answers follow from a ruler: tiles, storeys, islands, walls, details."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from c2nav_engine.world.navmesh.file import parse
from c2nav_engine.world.navmesh.mesh import NavMesh, prepare
from tests.helpers.navmesh_bytes import MeshSpec, TileSpec, rectangle, write_navmesh


def mesh_of(*tiles: TileSpec, version: int = 1) -> NavMesh:
    data = write_navmesh(MeshSpec(list(tiles), version=version))
    return prepare(parse(data, Path("made.navmesh")), Path("made.navmesh"))


def floor(cell: tuple[int, int], *, tree: bool = True) -> TileSpec:
    x, z = 4 * cell[0], 4 * cell[1]
    return TileSpec([rectangle((x, z), (x + 4, z + 4))], cell=cell, tree=tree)


# A corridor, 2 m wide, around three sides of a block of 4 m.
LEFT_ARM = [(0.0, 0.0, 0.0), (0.0, 0.0, 4.0), (2.0, 0.0, 4.0), (2.0, 0.0, 2.0), (2.0, 0.0, 0.0)]
RIGHT_ARM = [(6.0, 0.0, 0.0), (6.0, 0.0, 2.0), (6.0, 0.0, 4.0), (8.0, 0.0, 4.0), (8.0, 0.0, 0.0)]
BEND = (
    TileSpec([LEFT_ARM, rectangle((2, 0), (4, 2))]),
    TileSpec([rectangle((4, 0), (6, 2)), RIGHT_ARM], cell=(1, 0)),
)


@pytest.mark.parametrize("version", [1, 2])
@pytest.mark.parametrize("tree", [True, False])
def test_four_tiles_are_one_floor(version: int, tree: bool):
    cells = [(0, 0), (1, 0), (0, 1), (1, 1)]
    mesh = mesh_of(*(floor(cell, tree=tree) for cell in cells), version=version)
    assert len(mesh.islands) == 1
    assert mesh.islands[0].area_m2 == pytest.approx(64)
    start, end = (0.5, 0.0, 0.5), (7.5, 0.0, 6.5)
    assert mesh.distance_field(end).distance_m(start) == pytest.approx(math.dist(start, end))
    assert mesh.geodesic_m(start, end) >= math.dist(start, end) - 1e-6


def test_a_straight_line_over_many_tiles_has_two_corners():
    mesh = mesh_of(*(floor((x, 0)) for x in range(5)))
    start, end = (1.0, 0.0, 2.0), (19.0, 0.0, 2.5)
    assert mesh.path(start, end) == [start, end]
    assert mesh.geodesic_m(start, end) == pytest.approx(math.dist(start, end))


def test_a_path_bends_at_inner_corners_across_tiles():
    mesh = mesh_of(*BEND)
    start, end = (1.0, 0.0, 3.5), (7.0, 0.0, 3.5)
    corners = [start, (2.0, 0.0, 2.0), (6.0, 0.0, 2.0), end]
    assert mesh.path(start, end) == corners
    expected = sum(math.dist(a, b) for a, b in pairwise(corners))
    assert mesh.geodesic_m(start, end) == pytest.approx(expected)


def test_tiles_meet_only_along_the_shared_part_of_an_edge():
    left = TileSpec([rectangle((0, 0), (4, 4))])
    right = TileSpec([rectangle((4, 1), (8, 2))], cell=(1, 0))
    mesh = mesh_of(left, right)
    path = mesh.path((1.0, 0.0, 3.5), (7.0, 0.0, 1.5))
    assert path is not None
    # The opening's ends are kept as 255ths of the 4 m edge.
    assert path[1] == pytest.approx((4.0, 0.0, 2.0), abs=4 / 255)


def test_tiles_whose_edges_lie_more_than_two_climbs_apart_do_not_meet():
    low = floor((0, 0))
    for height, islands in ((0.35, 1), (0.45, 2)):
        high = TileSpec([rectangle((4, 0), (8, 4), y=height)], cell=(1, 0))
        assert len(mesh_of(low, high).islands) == islands


def test_a_ramp_joins_two_storeys_and_a_gap_does_not():
    ground, upper = rectangle((0, 0), (4, 4)), rectangle((0, 0), (4, 4), y=2.5)
    stack = [TileSpec([ground]), TileSpec([upper], layer=1)]
    assert len(mesh_of(*stack).islands) == 2
    ramp = TileSpec([rectangle((4, 0), (8, 2), rise=2.5)], cell=(1, 0))
    landing = TileSpec([rectangle((8, 0), (12, 4), y=2.5)], cell=(2, 0))
    back = TileSpec([rectangle((4, 2), (8, 4), y=2.5)], cell=(1, 0), layer=1)
    mesh = mesh_of(*stack, ramp, landing, back)
    assert len(mesh.islands) == 1
    assert mesh.islands[0].highest_m == 2.5
    below, above = (1.0, 0.0, 1.0), (1.0, 2.5, 1.0)
    climbed = mesh.geodesic_m(below, above)
    assert 2 * math.dist((1, 0), (8, 2.5)) - 2 < climbed < 30
    assert mesh.distance_field(above).distance_m(below) <= climbed + 4 / 255


def test_snapping_prefers_the_storey_within_a_climb():
    stack = [
        TileSpec([rectangle((0, 0), (4, 4))]),
        TileSpec([rectangle((0, 0), (4, 4), y=2.5)], layer=1),
    ]
    mesh = mesh_of(*stack)
    assert mesh.snap((1.0, 0.9, 1.0)) == (1.0, 0.0, 1.0)
    assert mesh.snap((1.0, 1.9, 1.0)) == (1.0, 2.5, 1.0)


@pytest.mark.parametrize("tree", [True, False])
def test_snapping_reaches_two_metres_aside_and_four_up(tree: bool):
    mesh = mesh_of(floor((0, 0), tree=tree))
    assert mesh.snap((5.9, 3.9, 2.0)) == (4.0, 0.0, 2.0)
    assert mesh.snap((6.1, 0.0, 2.0)) is None
    # With a tree, Detour pulls the search box into the tile's own, so that height never misses.
    assert mesh.snap((2.0, 4.2, 2.0)) == ((2.0, 0.0, 2.0) if tree else None)
    assert mesh.snap((math.inf, 0.0, 0.0)) is None


def test_heights_come_from_the_detail_mesh():
    mesh = mesh_of(replace(floor((0, 0)), bumps={0: 0.5}))
    assert mesh.snap((2.0, 0.0, 2.0)) == pytest.approx((2.0, 0.5, 2.0))
    assert mesh.snap((1.0, 0.0, 2.0)) == pytest.approx((1.0, 0.25, 2.0))
    assert mesh.slide((1.0, 0.25, 2.0), (1.5, 0.25, 2.0)) == pytest.approx((1.5, 0.375, 2.0))


def test_islands_are_told_apart_at_once():
    mesh = mesh_of(TileSpec([rectangle((0, 0), (1, 4)), rectangle((2, 0), (4, 4))]))
    assert [island.area_m2 for island in mesh.islands] == pytest.approx([4, 8])
    assert (mesh.island_at((0.5, 0.0, 1.0)), mesh.island_at((3.0, 0.0, 1.0))) == (0, 1)
    assert mesh.island_at((50.0, 0.0, 0.0)) is None
    assert mesh.geodesic_m((0.5, 0.0, 1.0), (3.0, 0.0, 1.0)) == math.inf
    assert mesh.path((0.5, 0.0, 1.0), (3.0, 0.0, 1.0)) is None
    assert mesh.distance_field((3.0, 0.0, 1.0)).distance_m((0.5, 0.0, 1.0)) == math.inf


def test_disabled_polygons_are_walls():
    parts = [rectangle((0, 0), (1, 4)), rectangle((1, 0), (2, 4)), rectangle((2, 0), (4, 4))]
    mesh = mesh_of(TileSpec(parts, flags={1: 4}))
    assert mesh.geodesic_m((0.5, 0.0, 1.0), (3.0, 0.0, 1.0)) == math.inf
    assert mesh.slide((0.8, 0.0, 1.0), (1.05, 0.0, 1.0)) == pytest.approx((1.0, 0.0, 1.0))


def test_a_blocked_step_slides_or_stops():
    mesh = mesh_of(floor((0, 0)))
    start, end = (3.9, 0.0, 1.0), (4.1, 0.0, 1.15)
    assert mesh.slide(start, end) == pytest.approx((4.0, 0.0, 1.15))
    assert mesh.slide(start, end, sliding=False) == pytest.approx((4.0, 0.0, 1.075))
    free = (3.5, 0.0, 1.2)
    for sliding in (True, False):
        assert mesh.slide(start, free, sliding=sliding) == pytest.approx(free)


def test_a_step_crosses_tiles():
    mesh = mesh_of(floor((0, 0)), floor((1, 0)))
    for sliding in (True, False):
        end = mesh.slide((3.9, 0.0, 1.0), (4.15, 0.0, 1.0), sliding=sliding)
        assert end == pytest.approx((4.15, 0.0, 1.0))


def test_a_step_towards_another_island_is_refused():
    mesh = mesh_of(TileSpec([rectangle((0, 0), (1, 4)), rectangle((1.05, 0), (4, 4))]))
    assert mesh.slide((0.9, 0.0, 1.0), (1.15, 0.0, 1.0)) == pytest.approx((0.9, 0.0, 1.0))


def test_a_hovering_end_counts_its_height_as_habitat_does():
    mesh = mesh_of(floor((0, 0)))
    assert mesh.geodesic_m((1.0, 0.0, 1.0), (1.0, 1.0, 3.0)) == pytest.approx(math.sqrt(5))
    assert mesh.geodesic_m((1.0, 0.0, 1.0), (1.0, 1.0, 1.0)) == 0.0


def test_a_tile_without_room_for_links_says_so():
    parts = [rectangle((x, 0), (x + 1, 4)) for x in range(3)]
    mesh = mesh_of(TileSpec(parts, room_for_links=2))
    assert any("2 links found no room" in note for note in mesh.notes)


def test_distances_of_many_points_equal_single_ones():
    mesh = mesh_of(*BEND)
    target = mesh.distance_field((7.0, 0.0, 3.5))
    points = np.array([[1.0, 0.0, 3.5], [7.0, 0.0, 1.0], [90.0, 0.0, 0.0], [np.nan, 0.0, 0.0]])
    singles = [target.distance_m((float(x), float(y), float(z))) for x, y, z in points]
    assert target.distances_m(points).tolist() == singles
    assert singles[2:] == [math.inf, math.inf]
