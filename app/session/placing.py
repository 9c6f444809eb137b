"""Ask a place: which recorded views saw a point, and which could not.

One ray per camera position tells whether something stands between; all views of one look share
their position. Without the scene the recorded front depth serves, and the answer says so.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from jaxtyping import Float

from app.session.snapshot import PlaceAnswer, Sighting
from app.session.story import Story
from app.session.track import Glimpse
from c2nav_engine.episodes.profile import Profile
from c2nav_engine.geometry import Point, world_from_camera
from c2nav_engine.navigator.requests import Rig
from c2nav_engine.sensing.encode import depth_from_png
from c2nav_engine.world.scene import Scene

MARGIN_M = 0.05
"""A point lies on a surface: what stands this close before it is that surface [C]."""

SEEN, VETOED, HIDDEN, AWAY, UNSURE = "seen", "vetoed", "hidden", "away", "unsure"
"""In a view that was offered; only in one that was vetoed; behind something; in no view; in a view
whose depth was not recorded."""


class Sight(Protocol):
    """Answers what stands between a camera and a point."""

    @property
    def basis(self) -> str:
        """What the answer rests on, for people."""
        ...

    def clear(self, looks: Sequence[Look], point_m: Point) -> list[bool | None]:
        """Per look, whether the point is seen; None where that is not known."""
        ...

    def first_hit(self, origin_m: Point, direction: Point) -> Point | None:
        """Where a ray first meets a surface."""
        ...


@dataclass(frozen=True, slots=True)
class View:
    """One picture of a look, as a camera.

    Attributes:
        key: As in the look.
        sha256: Digest of the picture.
        offset_rad: Left of the heading.
        vetoed: Whether it was taken out before the question.
        shift_px: Columns to its left, for a picture that is joined from two.
        width_px: Columns of the joined picture.
    """

    key: str
    sha256: str
    offset_rad: float
    vetoed: bool = False
    shift_px: int = 0
    width_px: int = 0


@dataclass(frozen=True, slots=True)
class Look:
    """A glimpse with its views as cameras."""

    glimpse: Glimpse
    eye_m: Point
    views: tuple[View, ...]


class SceneSight:
    """Casts rays into the scene; Open3D is imported with the first one."""

    basis = "by the scene"

    def __init__(self, scene: Scene) -> None:
        """Build the acceleration structure."""
        from c2nav_engine.sensing.caster import Caster

        self._caster = Caster(scene)

    def clear(self, looks: Sequence[Look], point_m: Point) -> list[bool | None]:
        """One ray per look."""
        eyes = np.array([look.eye_m for look in looks], dtype=np.float64)
        directions = np.array(point_m) - eyes
        lengths_m = np.linalg.norm(directions, axis=1)
        units = directions / np.maximum(lengths_m, 1e-9)[:, None]
        rays = np.concatenate([eyes, units], axis=1).astype(np.float32)
        return [bool(hit) for hit in self._caster.cast(rays).t_hit >= lengths_m - MARGIN_M]

    def first_hit(self, origin_m: Point, direction: Point) -> Point | None:
        """Where a ray first meets a surface."""
        ray = np.array([[*origin_m, *direction]], dtype=np.float32)
        distance = float(self._caster.cast(ray).t_hit[0])
        if not np.isfinite(distance):
            return None
        return _point(np.array(origin_m) + distance * np.array(direction))


@dataclass(frozen=True)
class DepthSight:
    """Reads the recorded front depth."""

    profile: Profile
    basis: str = field(default="by recorded depth of the front views", init=False)

    def clear(self, looks: Sequence[Look], point_m: Point) -> list[bool | None]:
        """Known only where the point lies in the front picture."""
        return [self._clear(look, point_m) for look in looks]

    def _clear(self, look: Look, point_m: Point) -> bool | None:
        if not look.glimpse.depth_png:
            return None
        depth_m = depth_from_png(look.glimpse.depth_png)
        column, row, ahead_m = _projected(look, 0.0, point_m, self.profile, rgb=False)
        pinhole = self.profile.depth
        if ahead_m <= 0 or not (0 <= column < pinhole.width_px and 0 <= row < pinhole.height_px):
            return None
        # What was kept may be coarser than what the camera gave.
        rows, columns = depth_m.shape
        kept = int(row / pinhole.height_px * rows), int(column / pinhole.width_px * columns)
        seen_m = float(depth_m[kept])
        return None if seen_m == 0.0 else seen_m >= ahead_m - 2.0 * MARGIN_M

    def first_hit(self, origin_m: Point, direction: Point) -> Point | None:  # noqa: ARG002
        """A ray needs the scene."""
        return None


def looks_of(story: Story) -> tuple[Look, ...]:
    """Every glimpse of a branch with its cameras."""
    vetoed = {
        candidate.picture.sha256
        for decision in story.decisions
        for candidate in decision.facts.candidates
        if not candidate.feasible and candidate.picture is not None
    }
    profile = story.header.profile
    return tuple(_look(glimpse, profile, frozenset(vetoed)) for glimpse in story.track.glimpses)


def _look(glimpse: Glimpse, profile: Profile, vetoed: frozenset[str]) -> Look:
    x, y, z = glimpse.pose.position_m
    views: list[View] = []
    for index, view in enumerate(glimpse.seen.views):
        sha256, shift_px, width_px = view.picture.sha256, 0, view.picture.width_px
        if glimpse.rig is Rig.RING and glimpse.seen.sectors:
            # People see the joined sector: the view further left stands left in it.
            sector = glimpse.seen.sectors[index // 2]
            shift_px = 0 if index % 2 else view.picture.width_px
            sha256, width_px = sector.sha256, sector.width_px
        views.append(View(view.key, sha256, view.offset_rad, sha256 in vetoed, shift_px, width_px))
    return Look(glimpse, (x, y + profile.camera_height_m, z), tuple(views))


def place_of(story: Story, sight: Sight, point_m: Point) -> PlaceAnswer:
    """Where a point was seen."""
    looks = looks_of(story)
    clear = sight.clear(looks, point_m) if looks else []
    sightings: list[Sighting] = []
    marks: dict[str, tuple[float, float]] = {}
    for look, free in zip(looks, clear, strict=True):
        inside = _inside(look, point_m, story.header.profile)
        if free is not False:
            marks |= {view.sha256: at for view, at in inside}
        sightings.append(Sighting(look.glimpse.step, _status([v for v, _ in inside], free)))
    return PlaceAnswer(point_m, tuple(sightings), marks, sight.basis)


def _status(views: list[View], free: bool | None) -> str:
    if not views:
        return AWAY
    if free is False:
        return HIDDEN
    if free is None:
        return UNSURE
    return VETOED if all(view.vetoed for view in views) else SEEN


def _inside(look: Look, point_m: Point, profile: Profile) -> list[tuple[View, tuple[float, float]]]:
    """Views whose picture holds the point, with where: fractions of the shown picture."""
    found: list[tuple[View, tuple[float, float]]] = []
    pinhole = profile.rgb
    for view in look.views:
        column, row, ahead_m = _projected(look, view.offset_rad, point_m, profile, rgb=True)
        if ahead_m > 0 and 0 <= column < pinhole.width_px and 0 <= row < pinhole.height_px:
            across = (column + view.shift_px) / max(view.width_px, 1)
            found.append((view, (round(across, 4), round(row / pinhole.height_px, 4))))
    return found


def _projected(
    look: Look, offset_rad: float, point_m: Point, profile: Profile, *, rgb: bool
) -> tuple[float, float, float]:
    """(column, row, depth) of a world point in one camera of a look."""
    world = world_from_camera(
        look.glimpse.pose, height_m=profile.camera_height_m, offset_rad=offset_rad
    )
    local = world[:3, :3].T @ (np.array(point_m) - world[:3, 3])
    if local[2] >= 0.0:
        return (0.0, 0.0, -1.0)
    pinhole = profile.rgb if rgb else profile.depth
    column, row, depth_m = pinhole.project(local[None])[0].tolist()
    return (column, row, depth_m)


def point_at(story: Story, sight: Sight, sha256: str, *, column: float, row: float) -> Point | None:
    """The world point that a pixel of a recorded picture shows.

    Args:
        story: Which branch.
        sight: Scene or recorded depth.
        sha256: Digest of the picture.
        column: As a fraction of its width.
        row: As a fraction of its height.
    """
    profile = story.header.profile
    for look in looks_of(story):
        for view in look.views:
            if view.sha256 != sha256:
                continue
            local_px = column * view.width_px - view.shift_px
            if not 0.0 <= local_px < profile.rgb.width_px:
                continue
            pixel = np.array([[local_px, row * profile.rgb.height_px]])
            return _behind_pixel(look, view, sight, pixel_px=pixel, profile=profile)
    return None


def _behind_pixel(
    look: Look, view: View, sight: Sight, *, pixel_px: Float[np.ndarray, "1 2"], profile: Profile
) -> Point | None:
    world = world_from_camera(
        look.glimpse.pose, height_m=profile.camera_height_m, offset_rad=view.offset_rad
    )
    ray = world[:3, :3] @ profile.rgb.unproject(pixel_px, np.ones(1))[0]
    hit = sight.first_hit(look.eye_m, _point(ray / np.linalg.norm(ray)))
    if hit is not None or view.offset_rad != 0.0 or not look.glimpse.depth_png:
        return hit
    depth_m = depth_from_png(look.glimpse.depth_png)
    row = int(pixel_px[0, 1] / profile.rgb.height_px * depth_m.shape[0])
    column = int(pixel_px[0, 0] / profile.rgb.width_px * depth_m.shape[1])
    found_m = float(depth_m[row, column])
    return None if found_m == 0.0 else _point(np.array(look.eye_m) + ray * found_m)


def _point(array: np.ndarray) -> Point:
    x, y, z = array.tolist()
    return (x, y, z)


def nearest_step(story: Story, origin_m: Point, direction: Point, *, within_m: float) -> int | None:
    """The step whose foot point a ray passes, if any is near enough."""
    points = np.array([f.pose.position_m for f in story.track.footsteps])
    unit = np.array(direction) / np.linalg.norm(direction)
    offset = points - np.array(origin_m)
    apart = np.linalg.norm(offset - (offset @ unit)[:, None] * unit, axis=1)
    best = int(apart.argmin())
    return best if apart[best] <= within_m else None
