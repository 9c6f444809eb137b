"""Shortest distances over a built surface: one any-angle field per target.

Dijkstra's order over the cells, with every cell hanging on the last corner that it sees instead of
on its neighbour (basic Theta*): lengths and paths are straight where the way is free, and path,
distance and field come from the same numbers. On the layered grid line of sight is a straight walk
over links, so storeys need no special case.
"""

from __future__ import annotations

import heapq
import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from c2nav_engine.geometry import Point
from c2nav_engine.world.walkable_compiled import compiled
from c2nav_engine.world.walkable_places import places
from c2nav_engine.world.walkable_spans import NONE, Cells, Place, Spans
from c2nav_engine.world.walkable_walk import column_of, walk

_Field = tuple[Float[np.ndarray, " n"], Int[np.ndarray, " n"]]

ROOT = -2
"""The parent that stands for the target point itself, which lies anywhere in its cell."""

_GAIN_M = 1e-7  # improvements below this are rounding


@compiled
def solve_field(spans: Spans, target_span: int, target: Cells) -> _Field:
    """Distances of all spans' middles to the target at (x, z) in cells.

    Returns:
        (distances in metres, inf where there is no way; parents: a span whose middle is the next
        corner, `ROOT` for the target itself, or `NONE`)
    """
    count = spans.column.shape[0]
    distance_m = np.full(count, np.inf)
    parent = np.full(count, NONE, np.int64)
    middle = _middle(spans, target_span)
    _, _, distance_m[target_span] = walk(spans, target_span, target, middle)
    parent[target_span] = ROOT
    unseen = np.full(count, NONE, np.int64)  # the corner that a span was last found not to see
    heap = [(distance_m[target_span], target_span)]
    while heap:
        reached_m, span = heapq.heappop(heap)
        if reached_m > distance_m[span]:
            continue
        hung = parent[span]
        corner_span, corner, corner_m = _corner(spans, hung, (target_span, target), distance_m)
        for side in range(8):
            other = _neighbour(spans.links, span, side)
            if other == NONE or parent[other] == hung:
                continue
            middle = _middle(spans, other)
            least_m = corner_m + _flat_m(spans, corner, middle)
            if least_m >= distance_m[other] - _GAIN_M:
                continue
            length_m, by = np.inf, hung
            if unseen[other] != hung:
                reached, _, length_m = walk(spans, corner_span, corner, middle)
                length_m = corner_m + (length_m if reached == other else np.inf)
            if length_m == np.inf:
                unseen[other] = hung
                rise_m = spans.floor_m[other] - spans.floor_m[span]
                flat_m = _flat_m(spans, _middle(spans, span), middle)
                length_m = reached_m + math.sqrt(flat_m * flat_m + rise_m * rise_m)
                by = span
            if length_m < distance_m[other] - _GAIN_M:
                distance_m[other] = length_m
                parent[other] = by
                heapq.heappush(heap, (length_m, other))
    return distance_m, parent


@compiled
def _corner(
    spans: Spans, parent: int, root: Place, distance_m: Float[np.ndarray, " n"]
) -> tuple[int, Cells, float]:
    """(span, position, distance to the target) of what a parent stands for."""
    if parent == ROOT:
        return root[0], root[1], 0.0
    return parent, _middle(spans, parent), distance_m[parent]


@compiled
def _flat_m(spans: Spans, start: Cells, end: Cells) -> float:
    """Straight distance in plan, in metres."""
    return math.sqrt((end[0] - start[0]) ** 2 + (end[1] - start[1]) ** 2) * spans.cell_m


@compiled
def _middle(spans: Spans, span: int) -> Cells:
    """The middle of a span's cell."""
    x, z = column_of(spans, span)
    return x + 0.5, z + 0.5


@compiled
def _neighbour(links: Int[np.ndarray, "n 4"], span: int, side: int) -> int:
    """One of eight neighbours: four links, then four diagonals around either side."""
    if side < 4:
        return links[span, side]
    first, second = side - 4, (side - 3) % 4
    beside = links[span, first]
    if beside != NONE and links[beside, second] != NONE:
        return links[beside, second]
    beside = links[span, second]
    if beside != NONE:
        return links[beside, first]
    return NONE


@compiled
def read_field(spans: Spans, root: Place, field: _Field, place: Place) -> tuple[float, int]:
    """Distance of a point anywhere on the surface, and the corner it walks to first.

    Args:
        spans: The surface.
        root: (target span, target position).
        field: (distances, parents) of `solve_field`.
        place: (span, position) of the point.

    Returns:
        (distance in metres, parent as in the field)
    """
    distance_m, parent = field
    span, position = place
    best_m, hung = np.inf, NONE
    for side in range(-1, 8):
        near = span if side < 0 else _neighbour(spans.links, span, side)
        if near == NONE or distance_m[near] == np.inf:
            continue
        for own in range(2):
            candidate = parent[near] if own == 0 else near
            corner_span, corner, base_m = _corner(spans, candidate, root, distance_m)
            flat = math.sqrt((corner[0] - position[0]) ** 2 + (corner[1] - position[1]) ** 2)
            if candidate == hung or base_m + flat * spans.cell_m >= best_m:
                continue
            # Walked from the corner, as the field is: lengths agree to the last bit.
            reached, _, length_m = walk(spans, corner_span, corner, position)
            if reached == span and base_m + length_m < best_m:
                best_m, hung = base_m + length_m, candidate
    return best_m, hung


@compiled
def read_many(
    spans: Spans, root: Place, field: _Field, places: Float[np.ndarray, "n 3"]
) -> Float[np.ndarray, " n"]:
    """`read_field` at many places: rows of (span, x, z); inf where the span is `NONE`."""
    distances_m = np.full(places.shape[0], np.inf)
    for i in range(places.shape[0]):
        span = int(places[i, 0])
        if span != NONE:
            place = (span, (places[i, 1], places[i, 2]))
            distances_m[i], _ = read_field(spans, root, field, place)
    return distances_m


@dataclass(frozen=True, slots=True, eq=False)
class BuiltDistanceField:
    """Distances over a built surface to one target; implements `DistanceField`.

    Attributes:
        spans: The layered grid.
        target: The target's place.
        cell_distance_m: (n,) distance from the middle of each span's cell.
        parent: (n,) next corner of each span.
    """

    spans: Spans
    target: Place
    cell_distance_m: Float[np.ndarray, " n"]
    parent: Int[np.ndarray, " n"]

    @staticmethod
    def to(spans: Spans, target: Place) -> BuiltDistanceField:
        """Prepare the field: one pass over the connected floor."""
        return BuiltDistanceField(spans, target, *solve_field(spans, target[0], target[1]))

    def distance_m(self, point_m: Point) -> float:
        """Shortest walkable distance from a point; `inf` where there is no way."""
        return float(self.distances_m(np.array([point_m], np.float64))[0])

    def distances_m(self, points_m: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        """The same for many points at once."""
        return read_many(self.spans, self.target, self._field, places(self.spans, points_m))

    def read(self, start: Place) -> float:
        """Distance from a place in metres."""
        return float(read_field(self.spans, self.target, self._field, start)[0])

    def corners(self, start: Place) -> list[Place]:
        """Corners of the shortest path from a place with a finite distance, both ends included."""
        _, parent = read_field(self.spans, self.target, self._field, start)
        corners = [start]
        while parent != ROOT:
            column = int(self.spans.column[parent])
            z, x = divmod(column, self.spans.columns_x)
            corners.append((int(parent), (x + 0.5, z + 0.5)))
            parent = self.parent[parent]
        return [*corners, self.target]

    @property
    def _field(self) -> _Field:
        return self.cell_distance_m, self.parent
