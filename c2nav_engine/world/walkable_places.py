"""Between world positions and places on a built surface."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from c2nav_engine.geometry import Point
from c2nav_engine.world.walkable_spans import NONE, Cells, Place, Spans
from c2nav_engine.world.walkable_walk import height_at, inside, nearest, places_of

SNAP_HALF_EXTENTS_M = (2.0, 4.0, 2.0)
"""The search box of Detour's users, half extents along x, y, z."""

_ON_FLOOR_M = 0.3  # interpolated heights stay this close to the floor of their own cell


def cells_of(spans: Spans, points_m: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
    """World points as (x in cells, height in metres, z in cells)."""
    cells = np.array(points_m, np.float64)
    cells[:, 0] = (cells[:, 0] - spans.origin_x_m) / spans.cell_m
    cells[:, 2] = (cells[:, 2] - spans.origin_z_m) / spans.cell_m
    return cells


def cell_of(spans: Spans, point_m: Point) -> tuple[float, float, float]:
    """One world point as (x in cells, height in metres, z in cells)."""
    x, y, z = cells_of(spans, np.array([point_m], np.float64))[0].tolist()
    return x, y, z


def places(spans: Spans, points_m: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
    """Rows of (span, x, z): the floor under each point, else the nearest; `NONE` without any."""
    return places_of(spans, cells_of(spans, points_m), (_ON_FLOOR_M, _half(spans)))


def place(spans: Spans, point_m: Point) -> Place | None:
    """The floor under a point, else the nearest within the search box, else None."""
    span, x, z = places(spans, np.array([point_m], np.float64))[0].tolist()
    return None if span == NONE else (int(span), (x, z))


def nearest_place(spans: Spans, point_m: Point) -> Place | None:
    """The floor nearest to a point in space within the search box, else None."""
    span, x, z = nearest(spans, cell_of(spans, point_m), _half(spans))
    return None if span == NONE else (int(span), (float(x), float(z)))


def place_within(spans: Spans, span: int, position: Cells) -> Place:
    """A position moved inside the cell of a span that it borders on."""
    z, x = divmod(int(spans.column[span]), spans.columns_x)
    return int(span), (float(inside(x, position[0])), float(inside(z, position[1])))


def point_of(spans: Spans, at: Place) -> Point:
    """The world point of a place, on the floor."""
    span, (x, z) = at
    height_m = float(height_at(spans, span, x, z))
    return (spans.origin_x_m + x * spans.cell_m, height_m, spans.origin_z_m + z * spans.cell_m)


def between(start: Cells, end: Cells, share: float) -> Cells:
    """The position at a share of the straight way."""
    return (start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1]))


def _half(spans: Spans) -> tuple[float, float]:
    return SNAP_HALF_EXTENTS_M[0] / spans.cell_m, SNAP_HALF_EXTENTS_M[1]
