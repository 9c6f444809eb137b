"""What the rest of the engine may ask of a walkable surface, whoever built it.

Two implementations: `world.walkable` (built from any mesh) and `world.navmesh` (read from a
habitat `.navmesh`). Both answer in the world frame, in metres.
"""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from c2nav_engine.geometry import Point


@runtime_checkable
class DistanceField(Protocol):
    """Geodesic distances to one fixed target, prepared once and asked often."""

    def distance_m(self, point_m: Point) -> float:
        """Shortest walkable distance from a point; `inf` where there is no way."""
        ...

    def distances_m(self, points_m: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        """The same for many points at once."""
        ...


@runtime_checkable
class Surface(Protocol):
    """The floor a body can stand on."""

    @property
    def source(self) -> str:
        """`navmesh` or `built`: run records say which one measured."""
        ...

    def snap(self, point_m: Point) -> Point | None:
        """Nearest surface point within (2, 4, 2) m half extents; None where there is none."""
        ...

    def geodesic_m(self, start_m: Point, end_m: Point) -> float:
        """Length of the shortest walkable path; `inf` where there is none."""
        ...

    def path(self, start_m: Point, end_m: Point) -> list[Point] | None:
        """Corners of the shortest path, both ends included; None where there is none."""
        ...

    def slide(self, start_m: Point, end_m: Point, *, sliding: bool = True) -> Point:
        """Where a straight move from start towards end ends up on the surface.

        Blocked moves slide along the edge, or stop at it when `sliding` is off.
        """
        ...

    def distance_field(self, target_m: Point) -> DistanceField:
        """Distances to one target, for metrics and evaluation."""
        ...

    def triangles(self) -> Float[np.ndarray, "n 3 3"]:
        """The surface as triangles, for display."""
        ...
