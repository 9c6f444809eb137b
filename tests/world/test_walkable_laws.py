"""What holds on every built surface: tried on a cluttered room at seeded random points."""

import math
from itertools import pairwise

import numpy as np
import pytest

from c2nav_engine.geometry import Point
from c2nav_engine.world.walkable import WalkableSurface
from tests.helpers.meshes import Box, room, surface_of

WIDTH_M, DEPTH_M, RADIUS_M = 8.0, 6.0, 0.1


def clutter() -> list[Box]:
    rng = np.random.default_rng(7)
    boxes = room(WIDTH_M, DEPTH_M)
    for _ in range(14):
        x, z = rng.uniform([0.5, 0.5], [WIDTH_M - 1.0, DEPTH_M - 1.0])
        width, depth = rng.uniform(0.1, 1.0, 2)
        boxes.append(Box((x, 0.0, z), (x + width, 2.0, z + depth)))
    return boxes


BOXES = clutter()


@pytest.fixture(scope="module")
def surface() -> WalkableSurface:
    return surface_of(BOXES)


def points(surface: WalkableSurface, count: int, seed: int = 0) -> list[Point]:
    """Places on the floor."""
    rng = np.random.default_rng(seed)
    raw = rng.uniform([0.0, -0.2, 0.0], [WIDTH_M, 0.2, DEPTH_M], (count, 3))
    snapped = [surface.snap((float(x), float(y), float(z))) for x, y, z in raw]
    return [point for point in snapped if point is not None]


def pairs(surface: WalkableSurface, count: int) -> list[tuple[Point, Point]]:
    found = points(surface, 2 * count)
    return list(zip(found[::2], found[1::2], strict=True))


def test_snapping_again_changes_nothing(surface):
    for point in points(surface, 200):
        assert surface.snap(point) == pytest.approx(point, abs=1e-9)


def test_the_body_never_stands_closer_to_a_wall_than_its_radius(surface):
    for x, _, z in points(surface, 500):
        assert min(box.gap_m(x, z) for box in BOXES[1:]) >= RADIUS_M - 1e-6


def test_a_geodesic_is_at_least_the_straight_line_and_a_distance_is_symmetric(surface):
    for start, end in pairs(surface, 15):
        there, back = surface.geodesic_m(start, end), surface.geodesic_m(end, start)
        assert there >= math.dist(start, end) - 1e-9
        assert there == pytest.approx(back, rel=0.01)
        assert surface.geodesic_m(start, start) == pytest.approx(0.0, abs=1e-9)


def test_no_detour_is_shorter_than_the_way(surface):
    found = points(surface, 60, seed=3)
    for a, b, c in zip(found[::3], found[1::3], found[2::3], strict=True):
        detour_m = surface.geodesic_m(a, b) + surface.geodesic_m(b, c)
        assert surface.geodesic_m(a, c) <= 1.01 * detour_m


def test_a_path_is_as_long_as_the_geodesic_and_can_be_walked(surface):
    for start, end in pairs(surface, 15):
        distance_m, path = surface.geodesic_m(start, end), surface.path(start, end)
        if path is None:
            assert distance_m == math.inf
            continue
        assert (path[0], path[-1]) == (pytest.approx(start), pytest.approx(end))
        legs = list(pairwise(path))
        assert sum(math.dist(a, b) for a, b in legs) == pytest.approx(distance_m, rel=0.001)
        for a, b in legs:
            assert surface.slide(a, b) == pytest.approx(b, abs=1e-6)


def test_a_field_and_the_geodesic_agree(surface):
    target, *others = points(surface, 60, seed=5)
    field = surface.distance_field(target)
    measured = field.distances_m(np.array(others))
    for point, distance_m in zip(others, measured.tolist(), strict=True):
        assert distance_m == field.distance_m(point) == surface.geodesic_m(point, target)


def test_a_walk_with_sliding_never_leaves_the_floor_or_passes_a_wall(surface):
    rng = np.random.default_rng(11)
    for start in points(surface, 20, seed=9):
        position = start
        for _ in range(40):
            yaw_rad = rng.uniform(-math.pi, math.pi)
            x, y, z = position
            end = (x - 0.25 * math.sin(yaw_rad), y, z - 0.25 * math.cos(yaw_rad))
            moved = surface.slide(position, end)
            assert math.dist(moved, position) <= 0.25 + 1e-6
            assert surface.snap(moved) == pytest.approx(moved, abs=1e-6)
            for share in np.linspace(0.0, 1.0, 6):
                on_x, _, on_z = (a + share * (b - a) for a, b in zip(position, moved, strict=True))
                assert min(box.gap_m(on_x, on_z) for box in BOXES[1:]) > 0.0
            position = moved


def test_sliding_gets_at_least_as_near_to_the_end_as_stopping(surface):
    rng = np.random.default_rng(13)
    for start in points(surface, 200, seed=17):
        yaw_rad = rng.uniform(-math.pi, math.pi)
        end = (start[0] - 0.25 * math.sin(yaw_rad), 0.0, start[2] - 0.25 * math.cos(yaw_rad))
        slid, stopped = surface.slide(start, end), surface.slide(start, end, sliding=False)
        assert math.dist(slid, end) <= math.dist(stopped, end) + 1e-6


def test_stopping_stays_on_the_straight_line(surface):
    rng = np.random.default_rng(19)
    for start in points(surface, 200, seed=23):
        yaw_rad = rng.uniform(-math.pi, math.pi)
        end = (start[0] - math.sin(yaw_rad), 0.0, start[2] - math.cos(yaw_rad))
        stopped = surface.slide(start, end, sliding=False)
        along_m = math.dist(start, stopped) + math.dist(stopped, end)
        assert along_m == pytest.approx(math.dist(start, end), abs=1e-6)


def test_a_surface_is_built_the_same_every_time(surface):
    again = surface_of(BOXES)
    for name, value in surface.spans._asdict().items():
        assert np.array_equal(value, getattr(again.spans, name)), name


def rough(seed: int) -> WalkableSurface:
    """Paving stones at random heights that can all be stepped over; some are missing."""
    rng = np.random.default_rng(seed)
    side_m, count = 0.2, 15
    heights_m = rng.uniform(0.0, 0.19, (count, count))
    return surface_of(
        [
            Box((i * side_m, -0.1, j * side_m), ((i + 1) * side_m, height_m, (j + 1) * side_m))
            for (i, j), height_m in np.ndenumerate(heights_m)
            if rng.random() > 0.08
        ]
    )


@pytest.mark.parametrize("seed", range(3))
def test_on_rough_ground_every_way_ends_at_its_target(seed):
    """Lengths over uneven floor break the triangle inequality: nothing may hang on itself."""
    surface = rough(seed)
    low, high = surface.triangles().min(axis=(0, 1)), surface.triangles().max(axis=(0, 1))
    for x, y, z in np.random.default_rng(seed).uniform(low, high, (8, 3)).tolist():
        target = surface.snap((x, y, z))
        assert target is not None
        parent = np.asarray(surface.distance_field(target).field.parent)
        span = np.arange(len(parent))
        for _ in parent:
            span = np.where(parent[span] >= 0, parent[span], span)
        assert (parent[span] < 0).all()
