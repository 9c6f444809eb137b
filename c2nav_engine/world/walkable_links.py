"""From columns of open space to a walkable surface: links, erosion by the radius, islands."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Int

from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.walkable_raster import OpenSpans
from c2nav_engine.world.walkable_spans import DIRECTIONS_X, DIRECTIONS_Z, NONE, Spans

_Links = Int[np.ndarray, "n 4"]

_EPSILON_M = 1e-4  # float32 heights of a step that is exactly as high as the body climbs


def linked_spans(
    spans: OpenSpans,
    *,
    cell_m: float,
    height_m: float,
    radius_m: float,
    climb_m: float,
    min_island_m2: float,
) -> Spans:
    """The part of the open floor where the whole body fits, without islands that are too small.

    The largest island stays whatever its size.
    """
    column = _columns(spans.first)
    shape = (spans.columns_x, spans.columns_z)
    links = _link(spans, column, (height_m, climb_m + _EPSILON_M))
    keep = _fits(column, links, (spans.columns_x, radius_m / cell_m))
    links = _without(links, keep)
    island, sizes = _islands(links, keep)
    if sizes.size:
        large = sizes * cell_m**2 >= min_island_m2
        large[np.argmax(sizes)] = True
        keep &= large[island]
    # Labels are handed out by first span, so they count on without gaps.
    number = np.cumsum(keep) - 1
    links = _without(links, keep)[keep]
    links = np.where(links == NONE, NONE, number[links]).astype(np.int32)
    column = column[keep]
    first = np.searchsorted(column, np.arange(shape[0] * shape[1] + 1)).astype(np.int64)
    _, island = np.unique(island[keep], return_inverse=True)
    return Spans(
        origin_x_m=spans.origin_x_m,
        origin_z_m=spans.origin_z_m,
        cell_m=cell_m,
        columns_x=shape[0],
        columns_z=shape[1],
        first=first,
        column=column,
        floor_m=spans.floor_m[keep],
        links=links,
        island=island.astype(np.int32),
    )


def _columns(first: Int[np.ndarray, " c"]) -> Int[np.ndarray, " n"]:
    """The column of each span."""
    return np.repeat(np.arange(first.size - 1, dtype=np.int64), np.diff(first))


def _without(links: _Links, keep: Bool[np.ndarray, " n"]) -> _Links:
    """Links between kept spans only."""
    usable = (links != NONE) & keep[links] & keep[:, None]
    return np.where(usable, links, NONE).astype(np.int32)


@compiled
def _link(spans: OpenSpans, column: Int[np.ndarray, " n"], limits: tuple[float, float]) -> _Links:
    """Neighbours that a body can roll to: a step it climbs, and room for its head on both."""
    height_m, climb_m = limits
    count = column.shape[0]
    links = np.full((count, 4), NONE, np.int32)
    for span in range(count):
        x, z = column[span] % spans.columns_x, column[span] // spans.columns_x
        for side in range(4):
            beside_x, beside_z = x + DIRECTIONS_X[side], z + DIRECTIONS_Z[side]
            if not (0 <= beside_x < spans.columns_x and 0 <= beside_z < spans.columns_z):
                continue
            beside = beside_z * spans.columns_x + beside_x
            smallest = climb_m
            for other in range(spans.first[beside], spans.first[beside + 1]):
                step = abs(spans.floor_m[other] - spans.floor_m[span])
                bottom = max(spans.floor_m[other], spans.floor_m[span])
                top = min(spans.ceiling_m[other], spans.ceiling_m[span])
                if step <= smallest and top - bottom >= height_m:
                    smallest = step
                    links[span, side] = other
    # A link is a way there and back.
    for span in range(count):
        for side in range(4):
            other = links[span, side]
            if other != NONE and links[other, (side + 2) % 4] != span:
                links[span, side] = NONE
    return links


@compiled
def _fits(
    column: Int[np.ndarray, " n"], links: _Links, body: tuple[int, float]
) -> Bool[np.ndarray, " n"]:
    """Which spans keep the body's radius, in cells, between all of their cell and every edge."""
    columns_x, radius = body
    reach = int(np.ceil(radius)) + 1
    width = 2 * reach + 1
    # Cells whose nearest point is closer than the radius must all be floor.
    disc = np.zeros((width, width), np.bool_)
    for i in range(width):
        for j in range(width):
            gap_x = max(abs(i - reach) - 1.0, 0.0)
            gap_z = max(abs(j - reach) - 1.0, 0.0)
            disc[i, j] = np.sqrt(gap_x**2 + gap_z**2) < radius - 1e-9
    disc[reach, reach] = True
    wanted = disc.sum()
    keep = np.zeros(column.shape[0], np.bool_)
    seen = np.zeros((width, width), np.bool_)
    queue = np.empty(width * width, np.int64)
    for span in range(column.shape[0]):
        x, z = column[span] % columns_x, column[span] // columns_x
        seen[:] = False
        seen[reach, reach] = True
        queue[0] = span
        filled, taken = 1, 0
        while taken < filled:
            here = queue[taken]
            taken += 1
            for side in range(4):
                other = links[here, side]
                if other == NONE:
                    continue
                i = column[other] % columns_x - x + reach
                j = column[other] // columns_x - z + reach
                if 0 <= i < width and 0 <= j < width and disc[i, j] and not seen[i, j]:
                    seen[i, j] = True
                    queue[filled] = other
                    filled += 1
        keep[span] = filled == wanted
    return keep


@compiled
def _islands(
    links: _Links, keep: Bool[np.ndarray, " n"]
) -> tuple[Int[np.ndarray, " n"], Int[np.ndarray, " islands"]]:
    """Labels of connected parts, by first span, and how many spans each has."""
    count = links.shape[0]
    island = np.full(count, NONE, np.int64)
    sizes = np.zeros(count, np.int64)
    queue = np.empty(count, np.int64)
    label = 0
    for seed in range(count):
        if not keep[seed] or island[seed] != NONE:
            continue
        island[seed] = label
        queue[0] = seed
        filled, taken = 1, 0
        while taken < filled:
            for side in range(4):
                other = links[queue[taken], side]
                if other != NONE and island[other] == NONE:
                    island[other] = label
                    queue[filled] = other
                    filled += 1
            taken += 1
        sizes[label] = filled
        label += 1
    return island, sizes[:label].copy()
