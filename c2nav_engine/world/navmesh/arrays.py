"""The mesh as flat records that compiled queries walk; positions in single precision as Detour's.

Polygons of all tiles are numbered through in file order. The plane is X–Z; heights are Y.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from c2nav_engine.world.navmesh.cursor import Records
from c2nav_engine.world.navmesh.tile import MAX_CORNERS

POLYGON = np.dtype(
    [
        ("points", np.float32, (MAX_CORNERS, 3)),
        ("neighbours", np.int32, (MAX_CORNERS,)),
        ("corners", np.int32),
        ("tile", np.int32),
        ("first_link", np.int32),
        ("end_link", np.int32),
        ("first_triangle", np.int32),
        ("end_triangle", np.int32),
    ],
    align=True,
)
"""`neighbours` holds polygon numbers, `WALL`, or `PORTAL` where links into other tiles decide."""

LINK = np.dtype(
    [
        ("target", np.int32),
        ("edge", np.int32),
        ("side", np.int32),
        ("low", np.int32),
        ("high", np.int32),
    ],
    align=True,
)
"""`side` is `INSIDE` or the tile's side; `low` and `high`, 0 … 255, bound the shared part."""

TRIANGLE = np.dtype(
    [("points", np.float32, (3, 3)), ("order", np.int32, (3,)), ("boundary", np.int32)],
    align=True,
)
"""`order` are the file's vertex numbers; bit k of `boundary` is set where edge k lies outside."""

NODE = np.dtype([("low", np.int32, (3,)), ("high", np.int32, (3,)), ("item", np.int32)], align=True)

TILE = np.dtype(
    [
        ("x", np.int64),
        ("z", np.int64),
        ("low", np.float32, (3,)),
        ("high", np.float32, (3,)),
        ("quantum", np.float32),
        ("climb", np.float32),
        ("first_polygon", np.int32),
        ("end_polygon", np.int32),
        ("first_node", np.int32),
        ("end_node", np.int32),
    ],
    align=True,
)

WALL = -1
PORTAL = -2
INSIDE = 0xFF


class MeshArrays(NamedTuple):
    """One mesh; every number in it has been checked to be in range.

    Attributes:
        polygons: Records of `POLYGON`.
        links: Records of `LINK`, those of one polygon in a row, in Detour's order.
        triangles: Records of `TRIANGLE`, those of one polygon in a row.
        nodes: Records of `NODE`: bounding volumes in depth-first order, those of one tile in a row;
            `item` is a polygon of the tile, or minus the number of records to skip.
        tiles: Records of `TILE`, in the order in which Detour visits them.
        grid: Origin X and Z, tile width and depth.
        passable: 1 where a body may walk, one entry a polygon.
        island: Connected part of each polygon; -1 where no body may walk.
    """

    polygons: Records
    links: Records
    triangles: Records
    nodes: Records
    tiles: Records
    grid: NDArray[np.float32]
    passable: NDArray[np.uint8]
    island: NDArray[np.int32]
