"""From checked tiles to the flat records that queries walk."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool
from numpy.typing import NDArray

from c2nav_engine.world.navmesh.arrays import (
    MAX_CORNERS,
    NODE,
    POLYGON,
    PORTAL,
    TILE,
    TRIANGLE,
    WALL,
    MeshArrays,
    Records,
)
from c2nav_engine.world.navmesh.file import NavMeshFile
from c2nav_engine.world.navmesh.islands import label_islands
from c2nav_engine.world.navmesh.links import build_links
from c2nav_engine.world.navmesh.tile import BORDER, Tile


def assemble(file: NavMeshFile) -> tuple[MeshArrays, int]:
    """The mesh's arrays, every surface polygon passable; and how many links had no room."""
    tiles = file.tiles
    bases = np.cumsum([0, *(len(tile.polygons) for tile in tiles)]).tolist()
    links = build_links(tiles, bases[:-1])
    polygons = np.concatenate([_polygons(tile, bases[i]) for i, tile in enumerate(tiles)])
    polygons["first_link"], polygons["end_link"] = links.first[:-1], links.first[1:]
    triangles = _all_triangles(tiles, polygons)
    nodes, node_bases = _nodes(tiles)
    # Detour meets tiles row by row, and of several layers in one cell the newest first.
    order = sorted(range(len(tiles)), key=lambda i: (*_cell(tiles[i]), -i))
    for place, index in enumerate(order):
        polygons["tile"][bases[index] : bases[index + 1]] = place
    arrays = MeshArrays(
        polygons=polygons,
        links=links.records,
        triangles=triangles,
        nodes=nodes,
        tiles=_tiles(tiles, bases, node_bases)[order],
        grid=np.array(
            [file.grid.origin_m[0], file.grid.origin_m[2], file.grid.width_m, file.grid.depth_m],
            np.float32,
        ),
        passable=np.empty(0, np.uint8),
        island=np.empty(0, np.int32),
    )
    ground = np.concatenate([tile.ground for tile in tiles])
    return restricted(arrays, ground), links.dropped


def restricted(mesh: MeshArrays, passable: Bool[np.ndarray, " p"]) -> MeshArrays:
    """The same mesh with these polygons open, and its islands numbered anew."""
    opened = mesh._replace(passable=passable.astype(np.uint8))
    return opened._replace(island=label_islands(opened).astype(np.int32))


def _cell(tile: Tile) -> tuple[int, int]:
    return int(tile.header["y"]), int(tile.header["x"])


def _polygons(tile: Tile, base: int) -> Records:
    source = tile.polygons
    records = np.zeros(len(source), POLYGON)
    count = np.where(tile.ground, source["corner_count"], 0).astype(np.int64)
    used = np.arange(MAX_CORNERS) < count[:, None]
    corners = np.where(used, source["corners"], 0)
    if len(tile.vertices):
        records["points"] = np.where(used[..., None], tile.vertices[corners], 0.0)
    neighbours = source["neighbours"].astype(np.int64)
    records["neighbours"] = np.select(
        [~used | (neighbours == 0), neighbours & BORDER != 0],
        [WALL, PORTAL],
        base + neighbours - 1,
    )
    records["corners"] = count
    return records


def _all_triangles(tiles: tuple[Tile, ...], polygons: Records) -> Records:
    parts: list[Records] = []
    counts: list[NDArray[np.int64]] = []
    first = 0
    for tile in tiles:
        points = polygons["points"][first : first + len(tile.polygons)]
        part, count = _triangles(tile, points)
        parts.append(part)
        counts.append(count)
        first += len(tile.polygons)
    ends = np.cumsum(np.concatenate(counts))
    polygons["end_triangle"] = ends
    polygons["first_triangle"] = ends - np.concatenate(counts)
    return np.concatenate(parts)


def _triangles(tile: Tile, points: NDArray[np.float32]) -> tuple[Records, NDArray[np.int64]]:
    """Detail triangles of one tile, those of one polygon in a row, and how many each has."""
    count = np.zeros(len(tile.polygons), np.int64)
    ground = np.flatnonzero(tile.ground)
    details = tile.details[ground]
    count[ground] = details["triangle_count"]
    owner = np.repeat(ground, count[ground])
    within = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    rows = tile.detail_triangles[
        tile.details["triangle_base"][owner].astype(np.int64) + within
    ].astype(np.int64)
    records = np.zeros(len(owner), TRIANGLE)
    order = rows[:, :3]
    corners = tile.polygons["corner_count"][owner].astype(np.int64)[:, None]
    of_polygon = points[owner[:, None], np.minimum(order, MAX_CORNERS - 1)]
    sample = order - corners + tile.details["vertex_base"][owner].astype(np.int64)[:, None]
    # One row of zeros stands where no sample is meant, so that the look-up is always in range.
    samples = np.concatenate([tile.detail_vertices, np.zeros((1, 3), np.float32)])
    is_sample = order >= corners
    of_detail = samples[np.where(is_sample, sample, len(samples) - 1)]
    records["points"] = np.where(is_sample[..., None], of_detail, of_polygon)
    records["order"] = order
    flags = rows[:, 3]
    records["boundary"] = (flags & 1) | (flags >> 1 & 2) | (flags >> 2 & 4)
    return records, count


def _nodes(tiles: tuple[Tile, ...]) -> tuple[Records, list[int]]:
    bases = np.cumsum([0, *(len(tile.nodes) for tile in tiles)]).tolist()
    records = np.zeros(bases[-1], NODE)
    for name in ("low", "high", "item"):
        records[name] = np.concatenate([tile.nodes[name] for tile in tiles])
    return records, bases


def _tiles(tiles: tuple[Tile, ...], bases: list[int], node_bases: list[int]) -> Records:
    records = np.zeros(len(tiles), TILE)
    for record, tile in zip(records, tiles, strict=True):
        header = tile.header
        record["x"], record["z"] = header["x"], header["y"]
        record["low"], record["high"] = header["low_m"], header["high_m"]
        record["quantum"], record["climb"] = header["quantum"], header["climb_m"]
    records["first_polygon"], records["end_polygon"] = bases[:-1], bases[1:]
    records["first_node"], records["end_node"] = node_bases[:-1], node_bases[1:]
    return records
