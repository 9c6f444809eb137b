"""The container that habitat-sim writes: magic MSET, one grid, and its tiles."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from c2nav_engine.errors import NavMeshError
from c2nav_engine.world.navmesh.cursor import Cursor
from c2nav_engine.world.navmesh.settings import BLOCK_BYTES, NavMeshSettings, read_block
from c2nav_engine.world.navmesh.tile import FARTHEST_M, MAGIC, Tile, read_tile

SET_MAGIC = int.from_bytes(b"MSET", "big")
VERSIONS = (1, 2)
_TILE_MAGIC = MAGIC.to_bytes(4, "little")
_BOUNDS_BYTES = 24
_LARGEST_BYTES = 2**31


@dataclass(frozen=True, slots=True)
class Grid:
    """Where tiles lie: cell (0, 0) starts at the origin, cells grow along +X and +Z.

    Attributes:
        origin_m: World position of the grid's corner.
        width_m: A tile's extent along X.
        depth_m: A tile's extent along Z.
    """

    origin_m: tuple[float, float, float]
    width_m: float
    depth_m: float


@dataclass(frozen=True, slots=True)
class NavMeshFile:
    """What a `.navmesh` file says, before any query.

    Attributes:
        version: 1, or 2 with a settings block.
        grid: Where tiles lie.
        tiles: In file order, which is the order in which Detour connects them.
        settings: The body the mesh was built for.
        notes: What a reader should know, one sentence each.
    """

    version: int
    grid: Grid
    tiles: tuple[Tile, ...]
    settings: NavMeshSettings
    notes: tuple[str, ...]


def read_file(path: Path) -> NavMeshFile:
    """Parse a `.navmesh` file; raises `NavMeshError` for anything else than a sound one."""
    try:
        data = path.read_bytes()
    except OSError as error:
        message = f"{path}: expected a readable .navmesh file, came {error.strerror or error}"
        raise NavMeshError(message) from error
    return parse(data, path)


def parse(data: bytes, path: Path) -> NavMeshFile:
    """The same from bytes; `path` only names them in complaints."""
    cursor = Cursor(data, path)
    magic, version, count = cursor.integers("set header", 3)
    if magic != SET_MAGIC:
        raise cursor.error(f"the magic MSET ({SET_MAGIC:#x})", f"{magic:#x}", offset=0)
    if version not in VERSIONS:
        raise cursor.error("version 1 or 2", f"version {version}", offset=4)
    if count < 1:
        raise cursor.error("at least one tile", f"{count}", offset=8)
    grid, most_tiles = _read_grid(cursor)
    recorded = _read_settings(cursor) if version > 1 else {}
    notes: list[str] = []
    tiles = _read_tiles(cursor, count, notes)
    if len(tiles) > most_tiles:
        raise cursor.error(f"at most {most_tiles} tiles", f"{len(tiles)}", offset=28)
    settings = _settings(tiles, recorded, notes)
    return NavMeshFile(version, grid, tiles, settings, tuple(notes))


def _read_grid(cursor: Cursor) -> tuple[Grid, int]:
    start = cursor.offset
    x, y, z, width, depth = cursor.floats("grid", 5)
    most_tiles, _most_polygons = cursor.integers("grid limits", 2)
    if not all(abs(value) <= FARTHEST_M for value in (x, y, z)):
        raise cursor.error("a finite grid origin", f"({x}, {y}, {z})", offset=start)
    if not (1e-3 <= width <= FARTHEST_M and 1e-3 <= depth <= FARTHEST_M):
        raise cursor.error("tiles of 1 mm or more", f"{width} × {depth} m", offset=start + 12)
    return Grid((x, y, z), width, depth), most_tiles


def _read_settings(cursor: Cursor) -> dict[str, float]:
    """The settings block, with the scene bounds that some versions of habitat-sim put into it."""
    for extra in (0, _BOUNDS_BYTES):
        if cursor.peek(BLOCK_BYTES + extra + 8, 4) == _TILE_MAGIC:
            return read_block(cursor, bounds_bytes=extra)
    raise cursor.error(
        f"a settings block of {BLOCK_BYTES} bytes and a tile after it",
        f"{cursor.peek(BLOCK_BYTES + 8, 4)!r} where the tile should start",
    )


def _read_tiles(cursor: Cursor, count: int, notes: list[str]) -> tuple[Tile, ...]:
    tiles: list[Tile] = []
    places: set[tuple[int, int, int]] = set()
    for index in range(count):
        start = cursor.offset
        reference, size = (int(n) for n in cursor.array("tile reference", "<u4", 2))
        if reference == 0 or size == 0:
            notes.append(f"the list of tiles ends after {index} of {count}")
            break
        if size >= _LARGEST_BYTES:
            raise cursor.error("a tile below 2 GiB", f"{size} bytes", offset=start + 4)
        tile = read_tile(cursor, size)
        place = (int(tile.header["x"]), int(tile.header["y"]), int(tile.header["layer"]))
        if place in places:
            raise cursor.error("one tile a place", f"a second tile at {place}", offset=start)
        places.add(place)
        tiles.append(tile)
    if not any(tile.ground.any() for tile in tiles):
        raise cursor.error("at least one polygon to walk on", "none")
    if cursor.offset < cursor.end:
        notes.append(f"{cursor.end - cursor.offset} bytes after the last tile were not read")
    return tuple(tiles)


def _settings(
    tiles: tuple[Tile, ...], recorded: dict[str, float], notes: list[str]
) -> NavMeshSettings:
    connections = sum(int(tile.header["connections"]) for tile in tiles)
    if connections:
        notes.append(f"{connections} off-mesh connections are ignored: a body walks, never jumps")
    bodies = {
        tuple(float(tile.header[name]) for name in ("height_m", "radius_m", "climb_m"))
        for tile in tiles
    }
    if len(bodies) > 1:
        notes.append("tiles were built for different bodies; the first tile's is reported")
    first = tiles[0].header
    height, radius, climb = (float(first[name]) for name in ("height_m", "radius_m", "climb_m"))
    written = tuple(
        recorded.get(name, value)
        for name, value in (
            ("agent_height_m", height),
            ("agent_radius_m", radius),
            ("agent_climb_m", climb),
        )
    )
    if not all(math.isclose(a, b) for a, b in zip(written, (height, radius, climb), strict=True)):
        notes.append(f"the settings block says {written}, the tiles {(height, radius, climb)}")
    return NavMeshSettings(written[0], written[1], written[2], recorded)
