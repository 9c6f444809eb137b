"""A walkable surface built from any mesh: several storeys, stairs, clearance, the body's radius."""

from __future__ import annotations

import math
from collections import OrderedDict
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np
from jaxtyping import Float, Integer

from c2nav_engine.errors import SceneError, StartError
from c2nav_engine.geometry import Point
from c2nav_engine.world.geodesic import BuiltDistanceField
from c2nav_engine.world.walkable_display import rectangles
from c2nav_engine.world.walkable_links import linked_spans
from c2nav_engine.world.walkable_places import (
    between,
    cell_of,
    nearest_place,
    place,
    place_within,
    point_of,
)
from c2nav_engine.world.walkable_raster import open_spans
from c2nav_engine.world.walkable_spans import Place, Spans
from c2nav_engine.world.walkable_walk import CHUNK_M, slide_along, walk

MIN_ISLAND_M2 = 1.0
"""Smaller parts are dropped, as Recast does with habitat's settings: chair seats, wall tops."""

_FORMAT = 1
_FIELDS_KEPT = 8
_SAME_CELLS = 1e-4
_BEND_M = 0.02  # a path gets a point where half a metre's rise changes by more


def build_surface(
    vertices_m: Float[np.ndarray, "n 3"],
    triangles: Integer[np.ndarray, "m 3"],
    *,
    height_m: float,
    radius_m: float,
    climb_m: float,
    slope_rad: float,
    cell_m: float = 0.05,
    min_island_m2: float = MIN_ISLAND_M2,
) -> WalkableSurface:
    """Find where a body can stand and roll, on every storey of a mesh.

    Args:
        vertices_m: Mesh vertices in the world frame, Y up.
        triangles: Vertex indices; winding does not matter.
        height_m: Clearance that the body needs.
        radius_m: The body's radius: its centre keeps this distance from everything.
        climb_m: Highest step between neighbouring cells.
        slope_rad: Steepest triangle that carries.
        cell_m: Side of a cell; edges are exact to about one cell.
        min_island_m2: Smaller disconnected parts are dropped; the largest part always stays.

    Raises:
        SceneError: There is no triangle, or nowhere to stand.
    """
    if len(triangles) == 0 or not np.isfinite(vertices_m).all():
        message = (
            "expected a mesh with triangles and finite vertices, came "
            f"{len(triangles)} triangles and {len(vertices_m)} vertices; export the scene again"
        )
        raise SceneError(message)
    opened = open_spans(
        np.asarray(vertices_m, np.float64),
        np.asarray(triangles, np.int64),
        height_m=height_m,
        climb_m=climb_m,
        slope_rad=slope_rad,
        cell_m=cell_m,
    )
    spans = linked_spans(
        opened,
        cell_m=cell_m,
        height_m=height_m,
        radius_m=radius_m,
        climb_m=climb_m,
        min_island_m2=min_island_m2,
    )
    if spans.column.size == 0:
        message = (
            f"expected a floor with {height_m} m of room above and {radius_m} m around, came a "
            "mesh without one; check that Y is up and that its unit is the metre"
        )
        raise SceneError(message)
    return WalkableSurface(spans)


@dataclass(frozen=True, slots=True, eq=False)
class WalkableSurface:
    """The floor a body's centre can stand on, as linked square cells; implements `Surface`.

    Positions on the surface are continuous; heights are interpolated between cells. Lengths follow
    the floor, read every half metre. Everything is deterministic.

    Attributes:
        spans: The layered grid.
    """

    spans: Spans
    _fields: OrderedDict[tuple[int, float, float], BuiltDistanceField] = field(
        default_factory=OrderedDict[tuple[int, float, float], BuiltDistanceField], repr=False
    )

    @property
    def source(self) -> str:
        """`built`, whatever the mesh."""
        return "built"

    @property
    def area_m2(self) -> float:
        """Area of the floor in plan, all storeys together."""
        return self.spans.column.size * self.spans.cell_m**2

    @property
    def islands(self) -> int:
        """How many disconnected parts there are."""
        return int(self.spans.island.max()) + 1

    def snap(self, point_m: Point) -> Point | None:
        """Nearest surface point within (2, 4, 2) m half extents; None where there is none."""
        nearest = nearest_place(self.spans, point_m)
        return None if nearest is None else point_of(self.spans, nearest)

    def geodesic_m(self, start_m: Point, end_m: Point) -> float:
        """Length of the shortest walkable path; `inf` where there is none."""
        start, end = self.place(start_m), self.place(end_m)
        if start is None or end is None or not self._connected(start, end):
            return math.inf
        return self._field_to(end).read(start)

    def path(self, start_m: Point, end_m: Point) -> list[Point] | None:
        """Corners of the shortest path, with further points where the floor's slope changes."""
        start, end = self.place(start_m), self.place(end_m)
        if start is None or end is None or not self._connected(start, end):
            return None
        places = self._field_to(end).corners(start)
        points = [point_of(self.spans, places[0])]
        for here, there in pairwise(places):
            # A corner touches several cells: one point is enough.
            if math.dist(here[1], there[1]) > _SAME_CELLS or there is places[-1]:
                points += self._profile(here, there)
        return points

    def slide(self, start_m: Point, end_m: Point, *, sliding: bool = True) -> Point:
        """Where a straight move from start towards end ends up on the surface.

        Blocked moves slide along the edge to the connected point nearest to the end, never outside
        the circle around start and end; or they stop at the edge when `sliding` is off.

        Raises:
            StartError: The start is nowhere near the surface.
        """
        at = self.place(start_m)
        if at is None:
            message = f"expected a move that starts on the floor, came {start_m}; snap it first"
            raise StartError(message)
        span, start = at
        end_x, _, end_z = cell_of(self.spans, end_m)
        end = (end_x, end_z)
        reached, share, _ = walk(self.spans, span, start, end)
        if share == 1.0:
            return point_of(self.spans, place_within(self.spans, reached, end))
        if sliding:
            rest, x, z = slide_along(self.spans, span, start, end)
            return point_of(self.spans, (rest, (x, z)))
        return point_of(self.spans, place_within(self.spans, reached, between(start, end, share)))

    def distance_field(self, target_m: Point) -> BuiltDistanceField:
        """Distances to one target; the same numbers as `geodesic_m` gives.

        Raises:
            StartError: The target is nowhere near the surface.
        """
        target = self.place(target_m)
        if target is None:
            message = f"expected a target near the floor, came {target_m}"
            raise StartError(message)
        return self._field_to(target)

    def triangles(self) -> Float[np.ndarray, "n 3 3"]:
        """The surface as triangles, for display: level cells are joined to rectangles."""
        return rectangles(self.spans)

    def save(self, path: Path) -> None:
        """Write the surface as a compressed `.npz`."""
        np.savez_compressed(path, format=np.array(_FORMAT), **self.spans._asdict())

    @staticmethod
    def load(path: Path) -> WalkableSurface:
        """Read what `save` wrote; the mesh is not needed.

        Raises:
            SceneError: The file is not such a surface.
        """
        try:
            with np.load(path) as file:
                stored = {name: file[name] for name in (*Spans._fields, "format")}
        except (OSError, ValueError, KeyError) as error:
            message = f"expected a stored walkable surface, came {path} ({error}); build it again"
            raise SceneError(message) from error
        if int(stored.pop("format")) != _FORMAT:
            message = (
                f"expected a walkable surface of format {_FORMAT}, came another; build it again"
            )
            raise SceneError(message)
        scalars = {name: value.item() for name, value in stored.items() if value.ndim == 0}
        return WalkableSurface(Spans(**(stored | scalars)))

    def place(self, point_m: Point) -> Place | None:
        """The cell under a point, else the nearest within the search box, else None."""
        return place(self.spans, point_m)

    def _profile(self, here: Place, there: Place) -> list[Point]:
        """Points of a straight walk where its slope changes, without its start."""
        span, start = here
        steps = max(1, int(math.dist(start, there[1]) * self.spans.cell_m / CHUNK_M))
        points = [point_of(self.spans, here)]
        for step in range(1, steps):
            stop = between(start, there[1], step / steps)
            reached, _, _ = walk(self.spans, span, start, stop)
            points.append(point_of(self.spans, (int(reached), stop)))
        points.append(point_of(self.spans, there))
        rises_m = [b[1] - a[1] for a, b in pairwise(points)]
        bends = [abs(b - a) > _BEND_M for a, b in pairwise(rises_m)]
        return [point for point, bend in zip(points[1:], [*bends, True], strict=True) if bend]

    def _connected(self, start: Place, end: Place) -> bool:
        return bool(self.spans.island[start[0]] == self.spans.island[end[0]])

    def _field_to(self, target: Place) -> BuiltDistanceField:
        span, (x, z) = target
        key = (span, x, z)
        found = self._fields.pop(key, None)
        if found is None:
            found = BuiltDistanceField.to(self.spans, target)
        self._fields[key] = found
        while len(self._fields) > _FIELDS_KEPT:
            self._fields.popitem(last=False)
        return found
