"""Straight walks over linked spans: line of sight, heights, the nearest floor, sliding.

Positions are (x, z) in cells (see `walkable_spans`), each with the span that it stands on.
"""

from __future__ import annotations

import math

import numpy as np
from jaxtyping import Float, Int

from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.walkable_spans import DIRECTIONS_X, DIRECTIONS_Z, NONE, Cells, Spans

_TIE = 1e-9
_INSET = 1e-6
"""How far, in cells, results stay off the border of their cell: which cell is theirs is plain."""

CHUNK_M = 0.5
"""Lengths follow the floor's height, read about this often: shorter would count single risers."""


@compiled
def column_of(spans: Spans, span: int) -> tuple[int, int]:
    """The column (x, z) of a span."""
    return spans.column[span] % spans.columns_x, spans.column[span] // spans.columns_x


@compiled
def walk(spans: Spans, span: int, start: Cells, end: Cells) -> tuple[int, float, float]:
    """Walk straight from `start` on `span` to `end`.

    Returns:
        (the span where the walk ends, the share of the way done, the length in metres). The share
        is 1 when the end is reached, else it lies on the surface's edge and the length is inf.
    """
    dx, dz = end[0] - start[0], end[1] - start[1]
    along_m = math.sqrt(dx * dx + dz * dz) * spans.cell_m
    chunks = max(1, int(along_m / CHUNK_M))
    chunk_m = along_m / chunks
    done, length_m, height_m = 0, 0.0, spans.floor_m[span]
    side_x, side_z = (0 if dx > 0.0 else 2), (1 if dz > 0.0 else 3)
    x, z = column_of(spans, span)
    # Grid lines ahead, as offsets from the start; shares of the way where they are crossed.
    ahead_x, ahead_z = x + (dx > 0.0) - start[0], z + (dz > 0.0) - start[1]
    while True:
        next_x = ahead_x / dx if dx != 0.0 else np.inf
        next_z = ahead_z / dz if dz != 0.0 else np.inf
        share = min(next_x, next_z)
        while done + 1 < min(chunks, share * chunks):
            rise_m = spans.floor_m[span] - height_m
            length_m += math.sqrt(chunk_m * chunk_m + rise_m * rise_m)
            height_m = spans.floor_m[span]
            done += 1
        if share >= 1.0 - _TIE:
            break
        if abs(next_x - next_z) <= _TIE:
            # Exactly through a corner: either way round it will do.
            other = _diagonal(spans.links, span, side_x, side_z)
        else:
            other = spans.links[span, side_x if next_x < next_z else side_z]
        if other == NONE:
            return span, max(share, 0.0), np.inf
        if next_x <= share + _TIE:
            ahead_x += DIRECTIONS_X[side_x]
        if next_z <= share + _TIE:
            ahead_z += DIRECTIONS_Z[side_z]
        span = other
    rise_m = spans.floor_m[span] - height_m
    return span, 1.0, length_m + math.sqrt(chunk_m * chunk_m + rise_m * rise_m)


@compiled
def _diagonal(links: Int[np.ndarray, "n 4"], span: int, side_x: int, side_z: int) -> int:
    """The diagonal neighbour, around either side of the corner between."""
    beside = links[span, side_x]
    if beside != NONE and links[beside, side_z] != NONE:
        return links[beside, side_z]
    beside = links[span, side_z]
    if beside != NONE:
        return links[beside, side_x]
    return NONE


@compiled
def height_at(spans: Spans, span: int, x: float, z: float) -> float:
    """Floor height at (x, z), interpolated between the middles of the cells that are linked."""
    column_x, column_z = column_of(spans, span)
    east, south = x - column_x - 0.5, z - column_z - 0.5
    side_x, side_z = (0 if east > 0.0 else 2), (1 if south > 0.0 else 3)
    share_x, share_z = min(abs(east), 0.5), min(abs(south), 0.5)
    here_m = spans.floor_m[span]
    beside_x, beside_z = spans.links[span, side_x], spans.links[span, side_z]
    diagonal = _diagonal(spans.links, span, side_x, side_z)
    x_m = spans.floor_m[beside_x] if beside_x != NONE else here_m
    z_m = spans.floor_m[beside_z] if beside_z != NONE else here_m
    diagonal_m = spans.floor_m[diagonal] if diagonal != NONE else x_m + z_m - here_m
    near_m = here_m + share_x * (x_m - here_m)
    far_m = z_m + share_x * (diagonal_m - z_m)
    return float(near_m + share_z * (far_m - near_m))


@compiled
def inside(column: int, value: float) -> float:
    """A coordinate moved into its cell, off the border."""
    return min(max(value, column + _INSET), column + 1.0 - _INSET)


@compiled
def nearest(
    spans: Spans, point: tuple[float, float, float], half: tuple[float, float]
) -> tuple[int, float, float]:
    """The surface point nearest to `point` (x in cells, height in metres, z in cells).

    Args:
        spans: The surface.
        point: Where to look from.
        half: Half extents of the search box: cells in the plane, metres in height.

    Returns:
        (span, x, z); the span is `NONE` where the box holds no floor.
    """
    x, height_m, z = point
    reach, reach_m = half
    best, best_x, best_z = NONE, x, z
    smallest = np.inf
    for column_z in range(max(int(z - reach), 0), min(int(z + reach), spans.columns_z - 1) + 1):
        for column_x in range(max(int(x - reach), 0), min(int(x + reach), spans.columns_x - 1) + 1):
            inside_x, inside_z = inside(column_x, x), inside(column_z, z)
            gap_x, gap_z = (inside_x - x) * spans.cell_m, (inside_z - z) * spans.cell_m
            flat = gap_x * gap_x + gap_z * gap_z
            if flat >= smallest:
                continue
            column = column_z * spans.columns_x + column_x
            for span in range(spans.first[column], spans.first[column + 1]):
                drop_m = spans.floor_m[span] - height_m
                if abs(drop_m) <= reach_m and flat + drop_m * drop_m < smallest:
                    smallest = flat + drop_m * drop_m
                    best, best_x, best_z = span, inside_x, inside_z
    return best, best_x, best_z


@compiled
def span_at(spans: Spans, point: tuple[float, float, float], tolerance_m: float) -> int:
    """The span under `point` whose floor is nearest in height, within the tolerance, or `NONE`."""
    x, height_m, z = point
    if not (0.0 <= x < spans.columns_x and 0.0 <= z < spans.columns_z):
        return NONE
    column = int(z) * spans.columns_x + int(x)
    best, smallest = NONE, tolerance_m
    for span in range(spans.first[column], spans.first[column + 1]):
        gap_m = abs(spans.floor_m[span] - height_m)
        if gap_m <= smallest:
            best, smallest = span, gap_m
    return best


@compiled
def places_of(
    spans: Spans, points: Float[np.ndarray, "n 3"], limits: tuple[float, tuple[float, float]]
) -> Float[np.ndarray, "n 3"]:
    """Where points stand: on the floor under them, else on the nearest in the search box.

    Args:
        spans: The surface.
        points: Rows of (x in cells, height in metres, z in cells).
        limits: (tolerance of the height under a point, (half extents as in `nearest`)).

    Returns:
        Rows of (span, x, z); the span is `NONE` where there is no floor.
    """
    tolerance_m, half = limits
    places = np.empty((points.shape[0], 3))
    for i in range(points.shape[0]):
        point = (points[i, 0], points[i, 1], points[i, 2])
        span, x, z = span_at(spans, point, tolerance_m), point[0], point[2]
        if span == NONE:
            span, x, z = nearest(spans, point, half)
        else:
            column_x, column_z = column_of(spans, span)
            x, z = inside(column_x, x), inside(column_z, z)
        places[i, 0], places[i, 1], places[i, 2] = span, x, z
    return places


@compiled
def slide_along(spans: Spans, span: int, start: Cells, end: Cells) -> tuple[int, float, float]:
    """Where a move from `start` towards an `end` that a straight walk cannot reach comes to rest.

    The nearest point to the end that is connected to the start inside the circle around both, as
    Detour's moveAlongSurface has it: along the edge, never through it and never far.

    Returns:
        (span, x, z)
    """
    middle_x, middle_z = (start[0] + end[0]) / 2.0, (start[1] + end[1]) / 2.0
    radius = math.sqrt((end[0] - start[0]) ** 2 + (end[1] - start[1]) ** 2) / 2.0 + _INSET
    seen = np.zeros(spans.column.shape[0], np.bool_)
    queue = np.empty(int((2.0 * radius + 4.0) ** 2), np.int64)
    seen[span] = True
    queue[0] = span
    filled, taken = 1, 0
    best, best_x, best_z, smallest = span, start[0], start[1], np.inf
    while taken < filled:
        here = queue[taken]
        taken += 1
        column_x, column_z = column_of(spans, here)
        x, z = inside(column_x, end[0]), inside(column_z, end[1])
        if (x - middle_x) ** 2 + (z - middle_z) ** 2 > radius * radius:
            x, z = inside(column_x, middle_x), inside(column_z, middle_z)
        gap = (x - end[0]) ** 2 + (z - end[1]) ** 2
        if gap < smallest:
            best, best_x, best_z, smallest = here, x, z, gap
        for side in range(4):
            other = spans.links[here, side]
            if other == NONE or seen[other] or filled == queue.shape[0]:
                continue
            column_x, column_z = column_of(spans, other)
            near_x = inside(column_x, middle_x) - middle_x
            near_z = inside(column_z, middle_z) - middle_z
            if near_x * near_x + near_z * near_z <= radius * radius:
                seen[other] = True
                queue[filled] = other
                filled += 1
    return best, best_x, best_z
