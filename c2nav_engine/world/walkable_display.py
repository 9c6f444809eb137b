"""A built surface as few triangles, for pictures."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.walkable_spans import NONE, Spans

_LEVEL_M = 0.02  # cells of one rectangle differ by no more


def rectangles(spans: Spans) -> Float[np.ndarray, "n 3 3"]:
    """Level cells joined to rectangles, two triangles each, facing up."""
    found = _grow(spans)
    x = spans.origin_x_m + found[:, [0, 2]] * spans.cell_m
    z = spans.origin_z_m + found[:, [1, 3]] * spans.cell_m
    corners = np.empty((len(found), 4, 3), np.float64)
    corners[:, :, 0] = x[:, [0, 0, 1, 1]]
    corners[:, :, 1] = found[:, 4, None]
    corners[:, :, 2] = z[:, [0, 1, 1, 0]]
    return corners[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 3)


@compiled
def _grow(spans: Spans) -> Float[np.ndarray, "rectangles 5"]:
    """Greedy rectangles, first along x and then along z: rows of (x0, z0, x1, z1, height)."""
    used = np.zeros(spans.column.shape[0], np.bool_)
    found = np.empty((spans.column.shape[0], 5))
    row = np.empty(spans.columns_x, np.int64)
    count = 0
    for seed in range(spans.column.shape[0]):
        if used[seed]:
            continue
        height_m = spans.floor_m[seed]
        row[0] = seed
        width = 1
        while True:
            other = spans.links[row[width - 1], 0]
            if other == NONE or used[other] or abs(spans.floor_m[other] - height_m) > _LEVEL_M:
                break
            row[width] = other
            width += 1
        depth = 0
        grows = True
        while grows:
            for i in range(width):
                used[row[i]] = True
            depth += 1
            for i in range(width):
                other = spans.links[row[i], 1]
                if other == NONE or used[other] or abs(spans.floor_m[other] - height_m) > _LEVEL_M:
                    grows = False
            for i in range(width if grows else 0):
                row[i] = spans.links[row[i], 1]
        x, z = spans.column[seed] % spans.columns_x, spans.column[seed] // spans.columns_x
        found[count, 0], found[count, 1] = x, z
        found[count, 2], found[count, 3] = x + width, z + depth
        found[count, 4] = height_m
        count += 1
    return found[:count].copy()
