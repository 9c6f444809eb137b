"""One Detour tile (magic DNAV, version 7): its sections as arrays whose every index is in range.

Sections follow the header in this order: vertices, polygons, links (empty in files: they are made
on loading), detail meshes, detail vertices, detail triangles, bounding volume tree, off-mesh
connections.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, UInt8
from numpy.typing import DTypeLike

from c2nav_engine.world.navmesh.cursor import Cursor, Records

MAGIC = int.from_bytes(b"DNAV", "big")
VERSION = 7
MAX_CORNERS = 6
GROUND = 0
BORDER = 0x8000
"""Set in a neighbour entry whose edge lies on the tile's border; the low byte is the side."""

HEADER = np.dtype(
    [(name, "<i4") for name in ("magic", "version", "x", "y", "layer", "user_id", "polygons")]
    + [(name, "<i4") for name in ("vertices", "links", "details", "detail_vertices")]
    + [(name, "<i4") for name in ("detail_triangles", "nodes", "connections", "connection_base")]
    + [(name, "<f4") for name in ("height_m", "radius_m", "climb_m")]
    + [("low_m", "<f4", 3), ("high_m", "<f4", 3), ("quantum", "<f4")]
)
POLYGON = np.dtype(
    [
        ("first_link", "<u4"),
        ("corners", "<u2", MAX_CORNERS),
        ("neighbours", "<u2", MAX_CORNERS),
        ("flags", "<u2"),
        ("corner_count", "u1"),
        ("area_and_type", "u1"),
    ]
)
DETAIL = np.dtype(
    [
        ("vertex_base", "<u4"),
        ("triangle_base", "<u4"),
        ("vertex_count", "u1"),
        ("triangle_count", "u1"),
        ("padding", "<u2"),
    ]
)
NODE = np.dtype([("low", "<u2", 3), ("high", "<u2", 3), ("item", "<i4")])
LINK_BYTES = 12
CONNECTION_BYTES = 36
FARTHEST_M = 1e6
"""Coordinates beyond this are damage: single precision no longer holds a centimetre there."""


@dataclass(frozen=True, slots=True, eq=False)
class Tile:
    """A tile whose sections have been checked against each other.

    Attributes:
        header: One record of `HEADER`.
        vertices: Corner positions, world frame, metres.
        polygons: Records of `POLYGON`.
        ground: Which polygons are surface; the others stand for off-mesh connections.
        details: Records of `DETAIL`, one a ground polygon.
        detail_vertices: Height samples that are no corners.
        detail_triangles: Three vertex indices and edge flags; indices from the polygon's corner
            count on point into the detail vertices.
        nodes: Records of `NODE`; empty where the file has no tree.
    """

    header: Records
    vertices: Float32[np.ndarray, "v 3"]
    polygons: Records
    ground: Bool[np.ndarray, " p"]
    details: Records
    detail_vertices: Float32[np.ndarray, "dv 3"]
    detail_triangles: UInt8[np.ndarray, "dt 4"]
    nodes: Records


def read_tile(cursor: Cursor, size: int) -> Tile:
    """The tile in the next `size` bytes; raises `NavMeshError` at the first broken promise."""
    file_end = cursor.end
    if not 0 < size <= file_end - cursor.offset:
        raise cursor.error(f"a tile of {size} bytes", f"{file_end - cursor.offset} bytes")
    start = cursor.offset
    cursor.end = start + size
    tile = _sections(cursor, _header(cursor))
    for check in (_check_vertices, _check_polygons, _check_details, _check_nodes):
        broken = check(tile)
        if broken is not None:
            expected, came = broken
            raise cursor.error(f"in the tile that starts here {expected}", came, offset=start)
    cursor.offset, cursor.end = start + size, file_end
    return tile


def _header(cursor: Cursor) -> Records:
    start = cursor.offset
    header = cursor.array("tile header", HEADER, 1)[0]
    if header["magic"] != MAGIC:
        raise cursor.error(
            f"a tile's magic DNAV ({MAGIC:#x})", f"{int(header['magic']):#x}", offset=start
        )
    if header["version"] != VERSION:
        raise cursor.error(
            f"tile version {VERSION}", f"version {header['version']}", offset=start + 4
        )
    for name in ("height_m", "radius_m", "climb_m", "low_m", "high_m", "quantum"):
        if not np.all(np.abs(header[name]) <= FARTHEST_M):
            offset = start + (HEADER.fields or {})[name][1]
            raise cursor.error(f"{name} within ±{FARTHEST_M:g}", f"{header[name]}", offset=offset)
    return header


def _sections(cursor: Cursor, header: Records) -> Tile:
    def section(what: str, kind: DTypeLike, count: str) -> Records:
        return cursor.array(what, kind, int(header[count]))

    vertices = section("vertices", "<3f4", "vertices")
    polygons = section("polygons", POLYGON, "polygons")
    section("links", f"V{LINK_BYTES}", "links")
    details = section("detail meshes", DETAIL, "details")
    detail_vertices = section("detail vertices", "<3f4", "detail_vertices")
    detail_triangles = section("detail triangles", "4u1", "detail_triangles")
    nodes = section("bounding volumes", NODE, "nodes")
    section("off-mesh connections", f"V{CONNECTION_BYTES}", "connections")
    return Tile(
        header=header,
        vertices=vertices,
        polygons=polygons,
        ground=(polygons["area_and_type"] >> 6) == GROUND,
        details=details,
        detail_vertices=detail_vertices,
        detail_triangles=detail_triangles,
        nodes=nodes,
    )


Broken = tuple[str, str]
"""What was expected, and what came."""


def _check_vertices(tile: Tile) -> Broken | None:
    for vertices in (tile.vertices, tile.detail_vertices):
        # Not "> limit": a comparison with nan is false, and nan must fail.
        bad = ~(np.abs(vertices) <= FARTHEST_M).all(axis=1)
        if bad.any():
            return f"vertices within ±{FARTHEST_M:g} m", f"{vertices[bad][0]}"
    return None


def _check_polygons(tile: Tile) -> Broken | None:
    polygons = tile.polygons[tile.ground]
    count = polygons["corner_count"]
    if ((count < 3) | (count > MAX_CORNERS)).any():
        return f"polygons of 3 to {MAX_CORNERS} corners", f"{count[(count < 3) | (count > 6)][0]}"
    used = np.arange(MAX_CORNERS) < count[:, None]
    corners = polygons["corners"][used]
    if (corners >= len(tile.vertices)).any():
        return f"corners below {len(tile.vertices)}", f"{corners.max()}"
    neighbours = polygons["neighbours"][used].astype(np.int64)
    inside = neighbours[(neighbours != 0) & (neighbours & BORDER == 0)] - 1
    if (inside >= len(tile.polygons)).any():
        return f"neighbours below {len(tile.polygons)}", f"{inside.max()}"
    if not tile.ground[inside].all():
        return "surface polygons as neighbours", "an off-mesh connection"
    return None


def _check_details(tile: Tile) -> Broken | None:
    ground = np.flatnonzero(tile.ground)
    if ground.size and ground[-1] >= len(tile.details):
        return f"a detail mesh for each of {ground[-1] + 1} polygons", f"{len(tile.details)}"
    details = tile.details[ground]
    count = details["triangle_count"].astype(np.int64)
    first = details["triangle_base"].astype(np.int64)
    if (first + count > len(tile.detail_triangles)).any():
        return f"detail triangles below {len(tile.detail_triangles)}", f"{(first + count).max()}"
    # Every polygon has its own; sharing would let a small file ask for any amount of memory.
    if count.sum() > len(tile.detail_triangles):
        return f"{len(tile.detail_triangles)} detail triangles in all", f"{count.sum()}"
    owner = np.repeat(np.arange(len(details)), count)
    inside = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    vertex = tile.detail_triangles[first[owner] + inside, :3].astype(np.int64)
    beyond = vertex - tile.polygons["corner_count"][ground][owner][:, None]
    sample = beyond + details["vertex_base"].astype(np.int64)[owner][:, None]
    wrong = (beyond >= 0) & (sample >= len(tile.detail_vertices))
    if wrong.any():
        return f"detail vertices below {len(tile.detail_vertices)}", f"{sample[wrong][0]}"
    return None


def _check_nodes(tile: Tile) -> Broken | None:
    leaves = tile.nodes["item"][tile.nodes["item"] >= 0]
    if (leaves >= len(tile.polygons)).any():
        return f"bounding volumes of polygons below {len(tile.polygons)}", f"{leaves.max()}"
    if not tile.ground[leaves].all():
        return "bounding volumes of surface polygons", "an off-mesh connection"
    return None
