"""Which polygon leads into which: edges inside a tile, and edges that two tiles share.

Files hold no links; Detour makes them while it adds tile after tile, and that order decides ties
later on. A polygon's links are therefore listed as Detour lists them: the newest first.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.navmesh.arrays import INSIDE, LINK, Records
from c2nav_engine.world.navmesh.plane import ONE, ZERO, Real
from c2nav_engine.world.navmesh.tile import BORDER, Tile

EDGE = np.dtype(
    [
        ("polygon", np.int32),
        ("edge", np.int32),
        ("side", np.int32),
        ("a", np.float32, (3,)),
        ("b", np.float32, (3,)),
    ],
    align=True,
)
MATCH = np.dtype(
    [("mine", np.int32), ("theirs", np.int32), ("low", np.int32), ("high", np.int32)], align=True
)
_MOST_PER_EDGE = 4
_MOST_LAYERS = 32
_NEIGHBOUR_CELLS = ((1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1))
_REACH_M = np.float32(0.01)

Cell = tuple[int, int]
Slab = tuple[Real, Real, Real, Real]


@dataclass(frozen=True, slots=True)
class Links:
    """The links of all polygons.

    Attributes:
        records: Records of `LINK`, those of one polygon in a row.
        first: Where each polygon's links start, and the end of the last one's.
        dropped: Links that did not fit into the room that a tile's header reserves.
    """

    records: Records
    first: NDArray[np.int64]
    dropped: int


@dataclass(slots=True)
class _Builder:
    tiles: tuple[Tile, ...]
    bases: list[int]
    borders: list[Records] = field(default_factory=list[Records])
    room: list[int] = field(default_factory=list[int])
    lists: dict[int, list[tuple[int, int, int, int, int]]] = field(
        default_factory=lambda: defaultdict(list)
    )
    dropped: int = 0

    def add(self, tile: int, polygon: int, link: tuple[int, int, int, int, int]) -> None:
        # A header reserves room for a fixed number of links; Detour silently drops the rest.
        if self.room[tile] == 0:
            self.dropped += 1
            return
        self.room[tile] -= 1
        self.lists[self.bases[tile] + polygon].append(link)


def build_links(tiles: tuple[Tile, ...], bases: list[int]) -> Links:
    """Connect tiles in their order; `bases` numbers each tile's first polygon."""
    builder = _Builder(tiles, bases)
    at: dict[Cell, list[int]] = defaultdict(list)
    for index, tile in enumerate(tiles):
        builder.borders.append(_border_edges(tile))
        builder.room.append(int(tile.header["links"]))
        _connect_inside(builder, index)
        x, z = int(tile.header["x"]), int(tile.header["y"])
        for other in at[x, z][::-1][:_MOST_LAYERS]:
            _connect(builder, index, other)
            _connect(builder, other, index)
        at[x, z].append(index)
        for side, (dx, dz) in enumerate(_NEIGHBOUR_CELLS):
            for other in at.get((x + dx, z + dz), [])[::-1][:_MOST_LAYERS]:
                _connect(builder, index, other, side=side)
                _connect(builder, other, index, side=_opposite(side))
    return _packed(builder, bases[-1] + len(tiles[-1].polygons))


def _opposite(side: int) -> int:
    return (side + 4) % 8


def _packed(builder: _Builder, polygons: int) -> Links:
    first = np.zeros(polygons + 1, np.int64)
    rows: list[tuple[int, int, int, int, int]] = []
    for polygon in range(polygons):
        rows.extend(reversed(builder.lists.get(polygon, [])))
        first[polygon + 1] = len(rows)
    return Links(np.array(rows, LINK), first, builder.dropped)


def _connect_inside(builder: _Builder, index: int) -> None:
    tile, base = builder.tiles[index], builder.bases[index]
    for polygon in np.flatnonzero(tile.ground).tolist():
        record = tile.polygons[polygon]
        neighbours = record["neighbours"].tolist()
        for edge in range(int(record["corner_count"]) - 1, -1, -1):
            neighbour = neighbours[edge]
            if neighbour and not neighbour & BORDER:
                builder.add(index, polygon, (base + neighbour - 1, edge, INSIDE, 0, 0))


def _border_edges(tile: Tile) -> Records:
    rows: list[tuple[object, ...]] = []
    for polygon in np.flatnonzero(tile.ground).tolist():
        record = tile.polygons[polygon]
        count = int(record["corner_count"])
        corners = record["corners"]
        for edge, neighbour in enumerate(record["neighbours"][:count].tolist()):
            side = neighbour & 0xFF
            if neighbour & BORDER and side in (0, 2, 4, 6):
                a, b = tile.vertices[corners[[edge, (edge + 1) % count]]]
                rows.append((polygon, edge, side, a, b))
    return np.array(rows, EDGE)


def _connect(builder: _Builder, mine: int, theirs: int, *, side: int = -1) -> None:
    edges, others = builder.borders[mine], builder.borders[theirs]
    if len(edges) == 0 or len(others) == 0:
        return
    climb = builder.tiles[theirs].header["climb_m"]
    matches = np.empty(len(edges) * _MOST_PER_EDGE, MATCH)
    for match in matches[: _match(edges, others, (side, climb), matches)]:
        edge, other = edges[match["mine"]], others[match["theirs"]]
        target = builder.bases[theirs] + int(other["polygon"])
        link = (target, int(edge["edge"]), int(edge["side"]), int(match["low"]), int(match["high"]))
        builder.add(mine, int(edge["polygon"]), link)


@compiled
def _slab(edge: Records) -> Slab:
    """An edge seen from the side: (along, height) of its lower end, then of its upper end."""
    axis = 2 if edge["side"] % 4 == 0 else 0
    a, b = edge["a"], edge["b"]
    if a[axis] < b[axis]:
        return a[axis], a[1], b[axis], b[1]
    return b[axis], b[1], a[axis], a[1]


@compiled
def _overlap(
    a: Slab,
    b: Slab,
    climb: Real,
) -> bool:
    """Whether two edges in one plane touch: along it by 2 cm or more, in height by two climbs."""
    low = max(a[0] + _REACH_M, b[0] + _REACH_M)
    high = min(a[2] - _REACH_M, b[2] - _REACH_M)
    if low > high:
        return False
    slope_a = (a[3] - a[1]) / (a[2] - a[0])
    base_a = a[1] - slope_a * a[0]
    slope_b = (b[3] - b[1]) / (b[2] - b[0])
    base_b = b[1] - slope_b * b[0]
    at_low = (slope_b * low + base_b) - (slope_a * low + base_a)
    at_high = (slope_b * high + base_b) - (slope_a * high + base_a)
    if at_low * at_high < ZERO:
        return True
    limit = (climb * np.float32(2.0)) * (climb * np.float32(2.0))
    return at_low * at_low <= limit or at_high * at_high <= limit


@compiled
def _byte(share: Real) -> int:
    if share > ONE:
        share = ONE
    # A share of an edge without length is nan, and counts as its start.
    if not share > ZERO:
        return 0
    return int(share * np.float32(255.0))


@compiled
def _match(edges: Records, others: Records, rule: tuple[int, Real], matches: Records) -> int:
    """Fill `matches` with the pairs of edges that two tiles share; their number.

    `rule` is the side to look at (-1: all) and the climb of the other tile. An edge has at most
    four partners, a polygon offers at most one edge to it.
    """
    side, climb = rule
    total = 0
    for mine in range(len(edges)):
        edge = edges[mine]
        if side != -1 and edge["side"] != side:
            continue
        across = 0 if edge["side"] % 4 == 0 else 2
        along = 2 - across
        slab = _slab(edge)
        count, done = 0, -1
        for theirs in range(len(others)):
            other = others[theirs]
            if other["side"] != (edge["side"] + 4) % 8 or other["polygon"] == done:
                continue
            if abs(edge["a"][across] - other["a"][across]) > _REACH_M:
                continue
            slab_other = _slab(other)
            if not _overlap(slab, slab_other, climb):
                continue
            done = other["polygon"]
            if count == _MOST_PER_EDGE:
                continue
            start, length = edge["a"][along], edge["b"][along] - edge["a"][along]
            one = (max(slab[0], slab_other[0]) - start) / length
            two = (min(slab[2], slab_other[2]) - start) / length
            if one > two:
                one, two = two, one
            match = matches[total]
            match["mine"], match["theirs"] = mine, theirs
            match["low"], match["high"] = _byte(one), _byte(two)
            count += 1
            total += 1
    return total
