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
from jaxtyping import Float, Int

from c2nav_engine.errors import SceneError
from c2nav_engine.world.compiled import compiled

_Pieces = Float[np.ndarray, "_ 3"]
_Polygon = Float[np.ndarray, "_ 3"]

_MAX_COLUMNS = 60_000_000
_TOUCH = 1e-5  # cells; a polygon that reaches less far into a cell only touches it
_INWARDS = 1e-4  # cells
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
    first: Int[np.ndarray, " columns+1"]
    floor_m: Float[np.ndarray, " n"]
    ceiling_m: Float[np.ndarray, " n"]


def open_spans(
    vertices_m: Float[np.ndarray, "v 3"],
    triangles: Int[np.ndarray, "t 3"],
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
def _rasterize(
    mesh: tuple[Float[np.ndarray, "v 3"], Int[np.ndarray, "t 3"], float, float],
    columns_x: int,
    cursor: Int[np.ndarray, " c"],
    pieces: _Pieces,
) -> None:
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
            _copy(cells, triangles[index, corner], polygon, corner)
        if not _shift_inwards(polygon):
            continue
        plane = _plane(polygon, upright)
        corners = 3
        first_z, last_z = _cells(polygon, corners, 2)
        for z in range(first_z, last_z + 1):
            in_row, corners = _split((polygon, corners), (2, z + 1.0), (row, rest))
            polygon, rest = rest, polygon
            if in_row < 3:
                continue
            first_x, last_x = _cells(row, in_row, 0)
            for x in range(first_x, last_x + 1):
                in_cell, in_row = _split((row, in_row), (0, x + 1.0), (cell, rest))
                row, rest = rest, row
                if in_cell < 3:
                    continue
                column = z * columns_x + x
                if pieces.shape[0] > 0:
                    lowest, highest = _extent(cell, in_cell, 1)
                    middle = plane[0] + plane[1] * (x + 0.5) + plane[2] * (z + 0.5)
                    if middle > -np.inf:
                        middle = min(max(middle, lowest), highest)
                    pieces[cursor[column], 0] = lowest * cell_m
                    pieces[cursor[column], 1] = highest * cell_m
                    pieces[cursor[column], 2] = middle * cell_m
                cursor[column] += 1


@compiled
def _shift_inwards(polygon: _Polygon) -> bool:
    """Move a triangle a hair against its normal, in plan; False if it has no area.

    A wall that lies exactly on a grid line then blocks the cells of its own side. Where the
    winding is wrong it blocks those of the other side instead: one cell more, never a gap.
    """
    nx, ny, nz = _normal(polygon)
    for corner in range(3):
        polygon[corner, 0] -= _INWARDS * np.sign(nx)
        polygon[corner, 2] -= _INWARDS * np.sign(nz)
    return nx != 0.0 or ny != 0.0 or nz != 0.0


@compiled
def _normal(polygon: _Polygon) -> tuple[float, float, float]:
    """Normal of a triangle, twice its area long."""
    x, y, z = polygon[0, 0], polygon[0, 1], polygon[0, 2]
    ux, uy, uz = polygon[1, 0] - x, polygon[1, 1] - y, polygon[1, 2] - z
    vx, vy, vz = polygon[2, 0] - x, polygon[2, 1] - y, polygon[2, 2] - z
    return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx


@compiled
def _plane(polygon: _Polygon, upright: float) -> tuple[float, float, float]:
    """Height = a + b·x + c·z of a triangle's plane; a is −inf where it is too steep to carry."""
    nx, ny, nz = _normal(polygon)
    norm = math.sqrt(nx * nx + ny * ny + nz * nz)
    # Either side of a sheet carries: many meshes wind their floors the wrong way round.
    if abs(ny) < upright * norm:
        return -np.inf, 0.0, 0.0
    b, c = -nx / ny, -nz / ny
    return polygon[0, 1] - b * polygon[0, 0] - c * polygon[0, 2], b, c


@compiled
def _extent(polygon: _Polygon, corners: int, axis: int) -> tuple[float, float]:
    """Smallest and largest coordinate of a polygon along an axis."""
    low, high = polygon[0, axis], polygon[0, axis]
    for i in range(1, corners):
        low, high = min(low, polygon[i, axis]), max(high, polygon[i, axis])
    return low, high


@compiled
def _cells(polygon: _Polygon, corners: int, axis: int) -> tuple[int, int]:
    """First and last cell along an axis that a polygon reaches into."""
    low, high = _extent(polygon, corners, axis)
    first = int(low + _TOUCH)
    return first, max(first, int(high - _TOUCH))


@compiled
def _copy(source: _Polygon, index: int, target: _Polygon, at: int) -> None:
    """One corner; spelt out because array expressions take seconds to compile."""
    for axis in range(3):
        target[at, axis] = source[index, axis]


@compiled
def _split(
    polygon: tuple[_Polygon, int], line: tuple[int, float], halves: tuple[_Polygon, _Polygon]
) -> tuple[int, int]:
    """Cut a convex polygon at coordinate `line = (axis, value)` into the halves below and above.

    Corners on the line go to both. Returns the corner counts of both halves.
    """
    (points, corners), (axis, value), (below, above) = polygon, line, halves
    in_below, in_above = 0, 0
    for i in range(corners):
        j = (i + 1) % corners
        here, there = value - points[i, axis], value - points[j, axis]
        if here >= 0.0:
            _copy(points, i, below, in_below)
            in_below += 1
        if here <= 0.0:
            _copy(points, i, above, in_above)
            in_above += 1
        if here * there < 0.0:
            share = here / (here - there)
            for k in range(3):
                below[in_below, k] = points[i, k] + share * (points[j, k] - points[i, k])
            below[in_below, axis] = value
            _copy(below, in_below, above, in_above)
            in_below += 1
            in_above += 1
    return in_below, in_above


@compiled
def _open_columns(
    first: Int[np.ndarray, " c"], pieces: _Pieces, height_m: float, climb_m: float
) -> tuple[Int[np.ndarray, " c"], Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
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
def _solids(pieces: _Pieces, climb_m: float) -> _Pieces:
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
