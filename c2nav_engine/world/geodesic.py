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
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from c2nav_engine.geometry import Point
from c2nav_engine.world.compiled import compiled
from c2nav_engine.world.walkable_places import places
from c2nav_engine.world.walkable_spans import NONE, Cells, Place, Spans
from c2nav_engine.world.walkable_walk import column_of, inside, walk

ROOT = -2
"""The parent that stands for the target point itself, which lies anywhere in its cell."""

_GAIN_M = 1e-7  # improvements below this are rounding


class FieldArrays(NamedTuple):
    """One solved field; a named tuple because kernels read it directly.

    Attributes:
        span: The target's span.
        x: The target's x in cells.
        z: The target's z in cells.
        distance_m: (n,) distance from the middle of each span's cell; inf where there is no way.
        parent: (n,) the span in which a walk turns next, `ROOT` for the target, or `NONE`.
        turn_x: (n,) where walks turn that turn in this span: its middle or a corner of its cell.
        turn_z: (n,) z of the same.
        turn_m: (n,) distance from there.
    """

    span: int
    x: float
    z: float
    distance_m: Float[np.ndarray, " n"]
    parent: Int[np.ndarray, " n"]
    turn_x: Float[np.ndarray, " n"]
    turn_z: Float[np.ndarray, " n"]
    turn_m: Float[np.ndarray, " n"]


@compiled
def solve_field(spans: Spans, target_span: int, target: Cells) -> FieldArrays:
    """Distances from everywhere to the target at (x, z) in cells."""
    field = _unsolved(spans, target_span, target)
    distance_m, parent = field.distance_m, field.parent
    _, _, distance_m[target_span] = walk(spans, target_span, target, _middle(spans, target_span))
    parent[target_span] = ROOT
    unseen = np.full(parent.shape[0], NONE, np.int64)  # the turn that a span was found not to see
    heap = [(distance_m[target_span], target_span)]
    while heap:
        reached_m, span = heapq.heappop(heap)
        if reached_m > distance_m[span]:
            continue
        for side in range(8):
            other = _neighbour(spans.links, span, side)
            if other == NONE or parent[other] == parent[span]:
                continue
            length_m, by = _reach(spans, field, (span, other), unseen)
            if length_m < distance_m[other] - _GAIN_M and not _hangs_on(field, by, other):
                distance_m[other], parent[other] = length_m, by
                field.turn_m[other] = np.inf
                heapq.heappush(heap, (length_m, other))
    for span in range(parent.shape[0]):
        if field.turn_m[span] == np.inf:
            field.turn_m[span] = distance_m[span]
            field.turn_x[span], field.turn_z[span] = _middle(spans, span)
    return field


@compiled
def _reach(
    spans: Spans, field: FieldArrays, step: tuple[int, int], unseen: Int[np.ndarray, " n"]
) -> tuple[float, int]:
    """A neighbour's distance, and its parent: what a span hangs on if it sees that, or the span.

    inf where the neighbour already has a way that is no longer.
    """
    span, other = step
    hung = field.parent[span]
    turn_span, turn, turn_m = _turn(field, hung)
    middle = _middle(spans, other)
    if turn_m + _flat_m(spans, turn, middle) >= field.distance_m[other] - _GAIN_M:
        return np.inf, NONE
    if unseen[other] != hung:
        reached, _, length_m = walk(spans, turn_span, turn, middle)
        if reached == other and length_m < np.inf:
            return turn_m + length_m, hung
    unseen[other] = hung
    if field.turn_m[span] == np.inf:
        _choose_turn(spans, field, span, other)
    return _via(spans, field, span, other), span


@compiled
def _hangs_on(field: FieldArrays, span: int, other: int) -> bool:
    """Whether the way from a span leads through another.

    Lengths follow the floor, so that on rough ground a way over two sides of a triangle can be
    shorter than the third; without this a span could come to hang on itself.
    """
    while span >= 0:
        if span == other:
            return True
        span = field.parent[span]
    return False


@compiled
def _unsolved(spans: Spans, span: int, target: Cells) -> FieldArrays:
    """A field in which nothing is reached yet."""
    count = spans.column.shape[0]
    return FieldArrays(
        span,
        target[0],
        target[1],
        np.full(count, np.inf),
        np.full(count, NONE, np.int64),
        np.empty(count),
        np.empty(count),
        np.full(count, np.inf),
    )


@compiled
def _choose_turn(spans: Spans, field: FieldArrays, span: int, other: int) -> None:
    """Where to turn inside a span on the way from `other`: shortest paths touch cell corners."""
    x, z = _middle(spans, span)
    field.turn_x[span], field.turn_z[span], field.turn_m[span] = x, z, field.distance_m[span]
    for side in range(8):
        if _neighbour(spans.links, span, side) == NONE:
            break
    else:
        return  # amid free floor nothing forces a turn
    before_span, before, before_m = _turn(field, field.parent[span])
    best_m = _via(spans, field, span, other)
    middle_turn = field.turn_x[span], field.turn_z[span], field.turn_m[span]
    for corner in range(4):
        to_x = inside(int(x), x + (0.5 if corner % 2 else -0.5))
        to_z = inside(int(z), z + (0.5 if corner // 2 else -0.5))
        reached, _, length_m = walk(spans, before_span, before, (to_x, to_z))
        if reached != span or length_m == np.inf:
            continue
        field.turn_x[span], field.turn_z[span] = to_x, to_z
        field.turn_m[span] = before_m + length_m
        via_m = _via(spans, field, span, other)
        if via_m < best_m:
            best_m = via_m
            middle_turn = field.turn_x[span], field.turn_z[span], field.turn_m[span]
    field.turn_x[span], field.turn_z[span], field.turn_m[span] = middle_turn


@compiled
def _via(spans: Spans, field: FieldArrays, span: int, other: int) -> float:
    """Distance of a neighbour's middle through the turn of a span; inf if it does not see that."""
    turn = field.turn_x[span], field.turn_z[span]
    reached, _, length_m = walk(spans, span, turn, _middle(spans, other))
    return field.turn_m[span] + length_m if reached == other else np.inf


@compiled
def _turn(field: FieldArrays, parent: int) -> tuple[int, Cells, float]:
    """(span, position, distance to the target) of what a parent stands for."""
    if parent == ROOT:
        return field.span, (field.x, field.z), 0.0
    return parent, (field.turn_x[parent], field.turn_z[parent]), field.turn_m[parent]


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
def read_field(spans: Spans, field: FieldArrays, place: Place) -> tuple[float, int]:
    """Distance of a point anywhere on the surface, and the parent that it walks to first."""
    span, position = place
    best_m, hung = np.inf, NONE
    for side in range(-1, 8):
        near = span if side < 0 else _neighbour(spans.links, span, side)
        if near == NONE or field.distance_m[near] == np.inf:
            continue
        for own in range(2):
            parent = field.parent[near] if own == 0 else near
            turn_span, turn, turn_m = _turn(field, parent)
            if parent == hung or turn_m + _flat_m(spans, turn, position) >= best_m:
                continue
            # Walked away from the target, as in the field: lengths agree to the last bit.
            reached, _, length_m = walk(spans, turn_span, turn, position)
            if reached == span and turn_m + length_m < best_m:
                best_m, hung = turn_m + length_m, parent
    return best_m, hung


@compiled
def read_many(
    spans: Spans, field: FieldArrays, places: Float[np.ndarray, "n 3"]
) -> Float[np.ndarray, " n"]:
    """`read_field` at many places: rows of (span, x, z); inf where the span is `NONE`."""
    distances_m = np.full(places.shape[0], np.inf)
    for i in range(places.shape[0]):
        span = int(places[i, 0])
        if span != NONE:
            distances_m[i], _ = read_field(spans, field, (span, (places[i, 1], places[i, 2])))
    return distances_m


@dataclass(frozen=True, slots=True, eq=False)
class BuiltDistanceField:
    """Distances over a built surface to one target; implements `DistanceField`.

    Attributes:
        spans: The layered grid.
        field: The solved field.
    """

    spans: Spans
    field: FieldArrays

    @staticmethod
    def to(spans: Spans, target: Place) -> BuiltDistanceField:
        """Prepare the field: one pass over the connected floor."""
        return BuiltDistanceField(spans, solve_field(spans, target[0], target[1]))

    def distance_m(self, point_m: Point) -> float:
        """Shortest walkable distance from a point; `inf` where there is no way."""
        return float(self.distances_m(np.array([point_m], np.float64))[0])

    def distances_m(self, points_m: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        """The same for many points at once."""
        return read_many(self.spans, self.field, places(self.spans, points_m))

    def read(self, start: Place) -> float:
        """Distance from a place in metres."""
        return float(read_field(self.spans, self.field, start)[0])

    def corners(self, start: Place) -> list[Place]:
        """Corners of the shortest path from a place with a finite distance, both ends included."""
        field = self.field
        parent = int(read_field(self.spans, field, start)[1])
        corners = [start]
        while parent != ROOT:
            turn = float(field.turn_x[parent]), float(field.turn_z[parent])
            corners.append((parent, turn))
            parent = int(field.parent[parent])
        return [*corners, (int(field.span), (float(field.x), float(field.z)))]
