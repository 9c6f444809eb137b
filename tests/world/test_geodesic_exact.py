"""Any-angle distances against the exact ones: the visibility graph of all inner corners."""

import math

import numpy as np
import pytest
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from c2nav_engine.geometry import Point
from c2nav_engine.world.walkable import WalkableSurface
from tests.helpers.meshes import Box, room, surface_of


def clutter(seed: int) -> list[Box]:
    rng = np.random.default_rng(seed)
    boxes = room(7.0, 5.0)
    for _ in range(9):
        x, z = rng.uniform([0.3, 0.3], [6.0, 4.0])
        width, depth = rng.uniform(0.05, 1.5, 2)
        boxes.append(Box((x, 0.0, z), (x + width, 2.0, z + depth)))
    return boxes


def inner_corners(surface: WalkableSurface) -> list[Point]:
    """Points just inside every corner of the floor around which a string can bend."""
    spans = surface.spans
    floor = np.zeros(spans.columns_x * spans.columns_z, np.bool_)
    floor[spans.column] = True
    grid = floor.reshape(spans.columns_z, spans.columns_x)
    count = sum(
        grid[i : -1 + i or None, j : -1 + j or None].astype(int) for i in (0, 1) for j in (0, 1)
    )
    found: list[Point] = []
    for z, x in np.argwhere(count == 3):
        for dz, dx in ((0, 0), (0, 1), (1, 0), (1, 1)):
            if grid[z + dz, x + dx]:
                at_x = spans.origin_x_m + (x + 1 + (dx - 0.5) * 4e-6) * spans.cell_m
                at_z = spans.origin_z_m + (z + 1 + (dz - 0.5) * 4e-6) * spans.cell_m
                found.append((float(at_x), 0.0, float(at_z)))
    return found


def sees(surface: WalkableSurface, start: Point, end: Point) -> bool:
    return math.dist(surface.slide(start, end, sliding=False), end) < 1e-6


@pytest.mark.parametrize("seed", [1, 2])
def test_distances_are_those_of_the_visibility_graph(seed):
    surface = surface_of(clutter(seed), cell_m=0.1)
    rng = np.random.default_rng(seed)
    raw = rng.uniform([0.2, 0.2], [6.8, 4.8], (16, 2))
    asked = [point for x, z in raw if (point := surface.snap((float(x), 0.0, float(z))))]
    nodes = [*asked, *inner_corners(surface)]
    rows, columns, lengths = [], [], []
    for i, start in enumerate(nodes):
        for j in range(i):
            if sees(surface, start, nodes[j]):
                rows.append(i)
                columns.append(j)
                # A length of 0 would mean no edge.
                lengths.append(max(math.dist(start, nodes[j]), 1e-9))
    graph = csr_matrix((lengths, (rows, columns)), (len(nodes), len(nodes)))
    exact_m = dijkstra(graph, directed=False, indices=range(len(asked)))[:, : len(asked)]
    ours_m = np.array([[surface.geodesic_m(a, b) for a in asked] for b in asked])
    assert np.array_equal(np.isinf(ours_m), np.isinf(exact_m))
    reached = np.isfinite(exact_m)
    assert reached.sum() > 100
    assert (ours_m[reached] >= exact_m[reached] - 1e-4).all()
    # A turn forced too early costs a fraction of a cell, whatever the distance.
    assert (ours_m[reached] <= exact_m[reached] * 1.01 + 0.01).all()
    assert np.median(ours_m[reached] / np.maximum(exact_m[reached], 1e-9)) <= 1.001
