"""Writes small `.navmesh` files with known answers: rooms made of rectangles, on a grid of tiles.

Polygons run as Detour's do: seen from above with X to the right and Z down, against the clock.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

import numpy as np

Corner = tuple[float, float, float]

SET_MAGIC = int.from_bytes(b"MSET", "big")
TILE_MAGIC = int.from_bytes(b"DNAV", "big")
QUANTUM = 20.0
_SIDES = ((0, 0, True), (2, 2, True), (4, 0, False), (6, 2, False))


def rectangle(
    low: tuple[float, float], high: tuple[float, float], *, y: float = 0.0, rise: float = 0.0
) -> list[Corner]:
    """A floor from low to high (x, z) at height y, climbing by `rise` towards +X."""
    (x0, z0), (x1, z1) = low, high
    return [(x0, y, z0), (x0, y, z1), (x1, y + rise, z1), (x1, y + rise, z0)]


@dataclass(frozen=True)
class TileSpec:
    """One tile: its cell and layer, its polygons, and what is unusual about it.

    `bumps` adds a detail vertex in the middle of a polygon, that much above its corners' mean.
    """

    polygons: list[list[Corner]]
    cell: tuple[int, int] = (0, 0)
    layer: int = 0
    flags: dict[int, int] = field(default_factory=dict)
    bumps: dict[int, float] = field(default_factory=dict)
    tree: bool = True
    connections: int = 0
    room_for_links: int | None = None


@dataclass(frozen=True)
class MeshSpec:
    """A whole file."""

    tiles: list[TileSpec]
    tile_size_m: float = 4.0
    version: int = 1
    body: tuple[float, float, float] = (1.5, 0.1, 0.2)
    bounds_in_settings: bool = False


def write_navmesh(spec: MeshSpec) -> bytes:
    """The file's bytes."""
    count = len(spec.tiles)
    header = struct.pack("<3i5f2i", SET_MAGIC, spec.version, count, 0.0, 0.0, 0.0,
                         spec.tile_size_m, spec.tile_size_m, max(count, 1), 1 << 10)  # fmt: skip
    parts = [header]
    if spec.version > 1:
        height, radius, climb = spec.body
        parts.append(
            struct.pack("<13f", 0.05, 0.2, height, radius, climb, 45, 20, 20, 12, 1.3, 6, 6, 1)
        )
        if spec.bounds_in_settings:
            parts.append(struct.pack("<6f", *[0.0] * 6))
        parts.append(bytes([1, 1, 1, 0]))
    for index, tile in enumerate(spec.tiles):
        data = _tile_bytes(tile, spec)
        parts += [struct.pack("<Ii", _reference(index, count), len(data)), data]
    return b"".join(parts)


def _reference(index: int, count: int) -> int:
    """Salt 1, then the tile's number, then ten bits for polygons."""
    return 1 << (10 + (count - 1).bit_length()) | index << 10


def _tile_bytes(tile: TileSpec, spec: MeshSpec) -> bytes:
    vertices = sorted({corner for polygon in tile.polygons for corner in polygon})
    number = {vertex: index for index, vertex in enumerate(vertices)}
    size = spec.tile_size_m
    box = (tile.cell[0] * size, tile.cell[1] * size, size)
    records = [_polygon_bytes(tile, index, number, box) for index in range(len(tile.polygons))]
    details, samples, triangles = _details(tile)
    nodes = _tree(tile, box) if tile.tree else []
    heights = [y for _, y, _ in vertices] + [y for _, y, _ in samples]
    low = (box[0], min(heights, default=0.0), box[1])
    high = (box[0] + size, max(heights, default=0.0), box[1] + size)
    edges = sum(len(polygon) for polygon in tile.polygons)
    room = 4 * edges if tile.room_for_links is None else tile.room_for_links
    ground = len(tile.polygons)
    jumps = [_jump_polygon() for _ in range(tile.connections)]
    header = struct.pack(
        "<5iI9i3f6ff", TILE_MAGIC, 7, tile.cell[0], tile.cell[1], tile.layer, 0,
        ground + len(jumps), len(vertices), room, ground, len(samples), len(triangles),
        len(nodes), tile.connections, ground, *spec.body, *low, *high, QUANTUM,
    )  # fmt: skip
    return b"".join(
        [
            header,
            *(struct.pack("<3f", *vertex) for vertex in vertices),
            *records,
            *jumps,
            bytes(12 * room),
            *details,
            *(struct.pack("<3f", *sample) for sample in samples),
            *(bytes(triangle) for triangle in triangles),
            *nodes,
            bytes(36 * tile.connections),
        ]
    )


def _polygon_bytes(
    tile: TileSpec, index: int, number: dict[Corner, int], box: tuple[float, float, float]
) -> bytes:
    polygon = tile.polygons[index]
    edges = list(zip(polygon, polygon[1:] + polygon[:1], strict=True))
    neighbours = [_neighbour(tile, index, edge, box) for edge in edges]
    padding = [0] * (6 - len(polygon))
    corners = [number[corner] for corner in polygon]
    flags = tile.flags.get(index, 1)
    return struct.pack(
        "<I6H6HHBB", 0, *corners, *padding, *neighbours, *padding, flags, len(polygon), 0
    )


def _jump_polygon() -> bytes:
    return struct.pack("<I6H6HHBB", 0, *[0] * 12, 1, 2, 1 << 6)


def _neighbour(
    tile: TileSpec, index: int, edge: tuple[Corner, Corner], box: tuple[float, float, float]
) -> int:
    for other, polygon in enumerate(tile.polygons):
        if other != index and (edge[1], edge[0]) in zip(
            polygon, polygon[1:] + polygon[:1], strict=True
        ):
            return other + 1
    low, size = box[:2], box[2]
    for side, axis, upper in _SIDES:
        plane = low[axis // 2] + (size if upper else 0.0)
        if edge[0][axis] == plane == edge[1][axis]:
            return 0x8000 | side
    return 0


def _details(tile: TileSpec) -> tuple[list[bytes], list[Corner], list[tuple[int, int, int, int]]]:
    details: list[bytes] = []
    samples: list[Corner] = []
    triangles: list[tuple[int, int, int, int]] = []
    for index, polygon in enumerate(tile.polygons):
        count = len(polygon)
        first_sample, first_triangle = len(samples), len(triangles)
        if index in tile.bumps:
            x, y, z = (sum(values) / count for values in zip(*polygon, strict=True))
            samples.append((x, y + tile.bumps[index], z))
            # Edge 0 of each (corner, next corner, middle) is the polygon's own.
            triangles += [(k, (k + 1) % count, count, 1) for k in range(count)]
        else:
            triangles += [
                (0, k, k + 1, 4 | (1 if k == 1 else 0) | (16 if k == count - 2 else 0))
                for k in range(1, count - 1)
            ]
        counts = (len(samples) - first_sample, len(triangles) - first_triangle)
        details.append(struct.pack("<IIBBH", first_sample, first_triangle, *counts, 0))
    return details, samples, triangles


def _tree(tile: TileSpec, box: tuple[float, float, float]) -> list[bytes]:
    bottom = min(corner[1] for polygon in tile.polygons for corner in polygon)
    origin = np.array([box[0], bottom, box[1]])
    leaves: list[tuple[np.ndarray, np.ndarray, int]] = []
    for index, polygon in enumerate(tile.polygons):
        points = (np.array(polygon) - origin) * QUANTUM
        top = points.max(axis=0) + QUANTUM * max(tile.bumps.get(index, 0.0), 0.0)
        leaves.append((np.floor(points.min(axis=0)), np.ceil(top), index))
    return [struct.pack("<3H3Hi", *map(int, low), *map(int, high), item)
            for low, high, item in _subtree(leaves)]  # fmt: skip


def _subtree(
    leaves: list[tuple[np.ndarray, np.ndarray, int]],
) -> list[tuple[np.ndarray, np.ndarray, int]]:
    if len(leaves) == 1:
        return leaves
    middle = len(leaves) // 2
    inner = _subtree(leaves[:middle]) + _subtree(leaves[middle:])
    low = np.min([leaf[0] for leaf in leaves], axis=0)
    high = np.max([leaf[1] for leaf in leaves], axis=0)
    return [(low, high, -(len(inner) + 1)), *inner]
