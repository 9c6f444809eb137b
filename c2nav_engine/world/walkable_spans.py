"""The layered grid behind a built surface: floor cells, one layer above another, linked sideways.

Cells are squares of `cell_m` in the floor plane. A column may hold several *spans* (floors of
several storeys, a table top above the floor). Two spans in neighbouring columns are linked where
a body can roll from one to the other. Inside kernels a position is in *cells*: (x − origin) / cell.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

DIRECTIONS_X = np.array([1, 0, -1, 0])
DIRECTIONS_Z = np.array([0, 1, 0, -1])
"""Steps in columns of the four links of a span; link d and link (d + 2) % 4 are opposite."""

NONE = -1
"""No span."""

Cells = tuple[float, float]
"""A position (x, z) in cells."""

Place = tuple[int, Cells]
"""A span and a position inside its cell."""


class Spans(NamedTuple):
    """A walkable surface as arrays; a named tuple because kernels read it directly.

    Attributes:
        origin_x_m: World x of the grid's corner.
        origin_z_m: World z of the grid's corner.
        cell_m: Side of a cell.
        columns_x: Columns along x.
        columns_z: Columns along z.
        first: (columns + 1,) index of a column's first span; columns run along x first.
        column: (n,) the column of each span; within a column, spans rise.
        floor_m: (n,) height of the floor at the middle of the cell.
        links: (n, 4) neighbours along +x, +z, −x, −z, or `NONE`.
        island: (n,) label of the connected part; labels count from 0 by first span.
    """

    origin_x_m: float
    origin_z_m: float
    cell_m: float
    columns_x: int
    columns_z: int
    first: Int[np.ndarray, " columns+1"]
    column: Int[np.ndarray, " n"]
    floor_m: Float[np.ndarray, " n"]
    links: Int[np.ndarray, "n 4"]
    island: Int[np.ndarray, " n"]
