"""A navigation mesh written by habitat-sim, answering as habitat-sim does."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from jaxtyping import Float, Float32

from c2nav_engine.episodes.profile import Profile
from c2nav_engine.geometry import Point
from c2nav_engine.world.navmesh import settings as navmesh_settings
from c2nav_engine.world.navmesh.arrays import MeshArrays
from c2nav_engine.world.navmesh.assemble import assemble, restricted
from c2nav_engine.world.navmesh.corridor import workspace
from c2nav_engine.world.navmesh.field import NavMeshField, Sights, field_to, sights_of
from c2nav_engine.world.navmesh.file import NavMeshFile, read_file
from c2nav_engine.world.navmesh.islands import Island, describe_islands, polygon_areas_m2
from c2nav_engine.world.navmesh.queries import find_line, snap, try_step
from c2nav_engine.world.navmesh.settings import NavMeshSettings

WALKABLE_FLAG = 1
_LEAST_AREA_M2 = 1e-5
_KEPT_FIELDS = 64


@dataclass(frozen=True, slots=True, eq=False)
class NavMesh:
    """A `Surface` read from a `.navmesh` file.

    Snapping, paths and moves equal habitat-sim's path finder: Detour's rules in single precision,
    walking only on polygons that carry the walk flag and have some area. Safe to share between
    threads.

    Attributes:
        file: Where it was read from.
        settings: The body that the mesh was built for.
        notes: What a user should know about this file, one sentence each.
        islands: Its connected parts; `island_at` numbers them.
        arrays: The mesh as habitat-sim walks it.
        as_filed: The same with every polygon open that has any flag, as plain Detour walks it.
    """

    file: Path
    settings: NavMeshSettings
    notes: tuple[str, ...]
    islands: tuple[Island, ...]
    arrays: MeshArrays
    as_filed: MeshArrays
    _sights: list[Sights] = field(default_factory=list[Sights])
    _fields: dict[Point, NavMeshField] = field(default_factory=dict[Point, NavMeshField])

    @property
    def source(self) -> str:
        """`navmesh`: run records say which kind of surface measured."""
        return "navmesh"

    @property
    def bounds_m(self) -> tuple[Point, Point]:
        """Lowest and highest corner of the box around all tiles."""
        low = self.arrays.tiles["low"].min(axis=0)
        high = self.arrays.tiles["high"].max(axis=0)
        return _point(low), _point(high)

    def snap(self, point_m: Point) -> Point | None:
        """Nearest surface point within (2, 4, 2) m half extents; None where there is none."""
        point = _single(point_m)
        if point is None:
            return None
        snapped = np.empty(3, np.float32)
        return _point(snapped) if snap(self.arrays, point[0], snapped) >= 0 else None

    def island_at(self, point_m: Point) -> int | None:
        """Index into `islands` of the nearest surface point; None where there is none."""
        point = _single(point_m)
        if point is None:
            return None
        polygon = snap(self.arrays, point[0], np.empty(3, np.float32))
        return int(self.arrays.island[polygon]) if polygon >= 0 else None

    def geodesic_m(self, start_m: Point, end_m: Point) -> float:
        """Length of habitat-sim's shortest path; `inf` where it finds none.

        Points that hover over the surface keep their height, as in habitat-sim: the climb down to
        the first corner counts. Snap them first for the distance along the floor.
        """
        return self._line(start_m, end_m)[1]

    def path(self, start_m: Point, end_m: Point) -> list[Point] | None:
        """Corners of that path, both ends included; None where there is none."""
        return self._line(start_m, end_m)[0]

    def slide(self, start_m: Point, end_m: Point, *, sliding: bool = True) -> Point:
        """Where habitat-sim's step from start towards end ends, at the surface's height.

        The start itself comes back where the step is refused: off the surface, or towards another
        island.
        """
        move = _single(start_m, end_m)
        if move is None:
            return start_m
        ended = np.empty(3, np.float32)
        try_step(self.arrays, move, sliding, ended)
        return start_m if np.array_equal(ended, move[0]) else _point(ended)

    def distance_field(self, target_m: Point) -> NavMeshField:
        """Distances to one target; the last 64 targets are kept."""
        if _single(target_m) is None:
            message = f"expected a finite target, came {target_m}"
            raise ValueError(message)
        known = self._fields.get(target_m)
        if known is None:
            if not self._sights:
                self._sights.append(sights_of(self.arrays))
            known = field_to(self.arrays, self._sights[0], target_m)
            while len(self._fields) >= _KEPT_FIELDS:
                self._fields.pop(next(iter(self._fields)), None)
            self._fields[target_m] = known
        return known

    def triangles(self) -> Float[np.ndarray, "n 3 3"]:
        """The walkable surface as triangles, for display."""
        polygons = self.arrays.polygons
        count = polygons["end_triangle"] - polygons["first_triangle"]
        shown = np.repeat(self.arrays.passable.astype(bool), count)
        return self.arrays.triangles["points"][shown].astype(np.float64)

    def _line(self, start_m: Point, end_m: Point) -> tuple[list[Point] | None, float]:
        ends = _single(start_m, end_m)
        if ends is None:
            return None, math.inf
        work = workspace(self.arrays)
        snapped = np.empty((2, 3), np.float32)
        count, length = find_line(self.arrays, work, ends, snapped)
        if count == 0:
            return None, math.inf
        if np.array_equal(snapped[0], snapped[1]):
            return [_point(snapped[0]), _point(snapped[1])], 0.0
        return [_point(corner) for corner in work.corners[:count]], float(length)


def read_navmesh(path: Path) -> NavMesh:
    """Read a `.navmesh` file, version 1 or 2; raises `NavMeshError` for anything unsound."""
    return prepare(read_file(path), path)


def prepare(file: NavMeshFile, path: Path) -> NavMesh:
    """Prepare a parsed file for questions."""
    ground, dropped = assemble(file)
    flags = np.concatenate([tile.polygons["flags"] for tile in file.tiles])
    walkable = flags & WALKABLE_FLAG != 0
    flat = walkable & (ground.passable != 0) & (polygon_areas_m2(ground) < _LEAST_AREA_M2)
    notes = list(file.notes)
    if dropped:
        notes.append(f"{dropped} links found no room in their tile and are left out, as in Detour")
    if flat.any():
        notes.append(f"{flat.sum()} polygons without area are closed, as habitat-sim closes them")
    arrays = restricted(ground, (ground.passable != 0) & walkable & ~flat)
    return NavMesh(
        file=path,
        settings=file.settings,
        notes=tuple(notes),
        islands=describe_islands(arrays),
        arrays=arrays,
        as_filed=restricted(ground, (ground.passable != 0) & (flags != 0)),
    )


def profile_note(mesh: NavMesh, profile: Profile) -> str:
    """What habitat-sim would do with this mesh and that body; empty where they agree."""
    return navmesh_settings.profile_note(mesh.settings, profile)


def _single(*points_m: Point) -> Float32[np.ndarray, "n 3"] | None:
    """Points in single precision, or None where one is not finite there."""
    with np.errstate(over="ignore"):
        points = np.array(points_m, np.float32)
    return points if np.isfinite(points).all() else None


def _point(row: Float32[np.ndarray, " xyz"]) -> Point:
    return float(row[0]), float(row[1]), float(row[2])
