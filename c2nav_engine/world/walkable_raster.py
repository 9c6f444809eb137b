"""From triangles to columns of open space: the first half of building a walkable surface.

Every triangle is cut along the grid's lines, so a column knows of everything that touches it: a
wall without thickness blocks its column too, which vertical ray casts would miss. The rule set is
Recast's (conservative rasterisation, clearance, low obstacles that a body rolls over), with exact
heights instead of height voxels.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from c2nav_engine.errors import SceneError
from c2nav_engine.world.walkable_compiled import compiled

_MAX_COLUMNS = 60_000_000
_CORNERS = 12  # a triangle cut by four lines has at most seven corners


class OpenSpans(NamedTuple):
    """Floors with enough room above them, before links and erosion.

    Attributes:
        origin_x_m: World x of the grid's corner.
        origin_z_m: World z of the grid's corner.
        columns_x: Columns along x.
        columns_z: Columns along z.
        first: (columns + 1,) index of a column's first span.
        floor_m: (n,) floor height at the middle of the cell.
        ceiling_m: (n,) height of the next solid thing above, or inf.
    """

    origin_x_m: float
    origin_z_m: float
    columns_x: int
    columns_z: int
    first: np.ndarray
    floor_m: np.ndarray
    ceiling_m: np.ndarray


def open_spans(
    vertices_m: np.ndarray,
    triangles: np.ndarray,
    *,
    height_m: float,
    climb_m: float,
    slope_rad: float,
    cell_m: float,
) -> OpenSpans:
    """Every floor of every column on which a body of that height finds room."""
    low, high = vertices_m.min(axis=0), vertices_m.max(axis=0)
    # Whole multiples of the cell: parts of one world share their grid lines.
    corner_x, corner_z = math.floor(low[0] / cell_m) - 1, math.floor(low[2] / cell_m) - 1
    columns_x = math.floor(high[0] / cell_m) - corner_x + 2
    columns_z = math.floor(high[2] / cell_m) - corner_z + 2
    if columns_x * columns_z > _MAX_COLUMNS:
        message = (
            f"expected a scene that fits in {_MAX_COLUMNS} cells of {cell_m} m, came "
            f"{high[0] - low[0]:.0f} × {high[2] - low[2]:.0f} m; check that its unit is the "
            "metre, cut off its surroundings, or choose larger cells"
        )
        raise SceneError(message)
    cells = vertices_m / cell_m
    cells[:, 0] -= corner_x
    cells[:, 2] -= corner_z
    upright = math.cos(slope_rad)
    count = np.zeros(columns_x * columns_z + 1, np.int64)
    # The same cuts twice, first to count and then to fill: no list has to grow.
    _rasterize((cells, triangles, cell_m, upright), columns_x, count, np.empty((0, 3), np.float32))
    first = np.concatenate([np.zeros(1, np.int64), np.cumsum(count)])[:-1]
    pieces = np.empty((int(first[-1]), 3), np.float32)
    _rasterize((cells, triangles, cell_m, upright), columns_x, first.copy(), pieces)
    kept, floor_m, ceiling_m = _open_columns(first, pieces, height_m, climb_m)
    return OpenSpans(
        corner_x * cell_m, corner_z * cell_m, columns_x, columns_z, kept, floor_m, ceiling_m
    )


@compiled
def _rasterize(mesh, columns_x, cursor, pieces):
    """Cut triangles along grid lines; count pieces per column, or write them at the cursor.

    A piece is (lowest, highest, floor): its height range in the column, and its plane's height
    at the middle of the cell, or −inf where it is too steep to stand on. Only `cursor` moves when
    `pieces` is empty.
    """
    cells, triangles, cell_m, upright = mesh
    polygon = np.empty((_CORNERS, 3))
    rest = np.empty((_CORNERS, 3))
    row = np.empty((_CORNERS, 3))
    cell = np.empty((_CORNERS, 3))
    for index in range(triangles.shape[0]):
        for corner in range(3):
            polygon[corner] = cells[triangles[index, corner]]
        u, v = polygon[1] - polygon[0], polygon[2] - polygon[0]
        nx = u[1] * v[2] - u[2] * v[1]
        ny = u[2] * v[0] - u[0] * v[2]
        nz = u[0] * v[1] - u[1] * v[0]
        norm = math.sqrt(nx * nx + ny * ny + nz * nz)
        # Either side of a sheet carries: many meshes wind their floors the wrong way round.
        stands = norm > 0.0 and abs(ny) >= upright * norm
        x0, y0, z0 = polygon[0, 0], polygon[0, 1], polygon[0, 2]
        corners = 3
        last_row = int(math.floor(polygon[:3, 2].max()))
        for z in range(int(math.floor(polygon[:3, 2].min())), last_row + 1):
            in_row, corners = _split(polygon, corners, (2, z + 1.0), row, rest)
            polygon, rest = rest, polygon
            if in_row < 3:
                continue
            last = int(math.floor(row[:in_row, 0].max()))
            for x in range(int(math.floor(row[:in_row, 0].min())), last + 1):
                in_cell, in_row = _split(row, in_row, (0, x + 1.0), cell, rest)
                row, rest = rest, row
                if in_cell < 3:
                    continue
                column = z * columns_x + x
                if pieces.shape[0] > 0:
                    lowest = cell[:in_cell, 1].min() * cell_m
                    highest = cell[:in_cell, 1].max() * cell_m
                    floor = -np.inf
                    if stands:
                        middle = y0 - (nx * (x + 0.5 - x0) + nz * (z + 0.5 - z0)) / ny
                        floor = min(max(middle * cell_m, lowest), highest)
                    pieces[cursor[column], 0] = lowest
                    pieces[cursor[column], 1] = highest
                    pieces[cursor[column], 2] = floor
                cursor[column] += 1


@compiled
def _split(polygon, corners, line, below, above):
    """Cut a convex polygon at coordinate `line = (axis, value)`; the corner counts of both."""
    axis, value = line
    in_below, in_above = 0, 0
    for i in range(corners):
        j = (i + 1) % corners
        here, there = value - polygon[i, axis], value - polygon[j, axis]
        if here >= 0.0:
            below[in_below] = polygon[i]
            in_below += 1
        if here <= 0.0:
            above[in_above] = polygon[i]
            in_above += 1
        if (here > 0.0 and there < 0.0) or (here < 0.0 and there > 0.0):
            share = here / (here - there)
            below[in_below] = polygon[i] + share * (polygon[j] - polygon[i])
            below[in_below, axis] = value
            above[in_above] = below[in_below]
            in_below += 1
            in_above += 1
    return in_below, in_above


@compiled
def _open_columns(first, pieces, height_m, climb_m):
    """Merge the pieces of each column into solids and keep the floors with room above."""
    kept = np.zeros_like(first)
    floor_m = np.empty(pieces.shape[0], np.float32)
    ceiling_m = np.empty(pieces.shape[0], np.float32)
    total = 0
    for column in range(first.shape[0] - 1):
        kept[column] = total
        if first[column] == first[column + 1]:
            continue
        solids = _solids(pieces[first[column] : first[column + 1]], climb_m)
        stood, stood_m = False, 0.0
        for i in range(solids.shape[0]):
            top, floor = solids[i, 1], solids[i, 2]
            stands = floor > -np.inf
            # A low thing just above a floor, a door sill or a cable: the body rolls over it.
            over = not stands and stood and top - stood_m <= climb_m
            stood, stood_m = stands, floor
            if over:
                floor = top
            ceiling = solids[i + 1, 0] if i + 1 < solids.shape[0] else np.float32(np.inf)
            if (stands or over) and ceiling - floor >= height_m:
                floor_m[total] = floor
                ceiling_m[total] = ceiling
                total += 1
    kept[-1] = total
    return kept, floor_m[:total].copy(), ceiling_m[:total].copy()


@compiled
def _solids(pieces, climb_m):
    """Pieces of one column merged where they touch: rows of (bottom, top, floor or −inf)."""
    order = np.argsort(pieces[:, 0], kind="mergesort")
    solids = np.empty((pieces.shape[0], 3), pieces.dtype)
    count = 0
    standing_top = np.float32(-np.inf)  # top of the highest piece that carries, in this solid
    for index in order:
        bottom, top, floor = pieces[index, 0], pieces[index, 1], pieces[index, 2]
        if count == 0 or bottom > solids[count - 1, 1]:
            solids[count, 0], solids[count, 1], solids[count, 2] = bottom, top, floor
            standing_top = top if floor > -np.inf else np.float32(-np.inf)
            count += 1
            continue
        solid = solids[count - 1]
        solid[1] = max(solid[1], top)
        if floor > -np.inf:
            solid[2] = max(solid[2], floor)
            standing_top = max(standing_top, top)
        if solid[1] > standing_top + climb_m:
            solid[2] = -np.inf
    return solids[:count]
