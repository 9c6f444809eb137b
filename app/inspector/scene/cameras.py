"""How the map is looked at: free, following, through the robot's camera, from above."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import viser

from app.inspector.scene import frames
from app.session.snapshot import Snapshot
from c2nav_engine.geometry import Point, Pose

_PITCH = math.radians(66.0)
"""Of the first view: steep enough to look over walls, flat enough to read furniture."""

_RIGHT = np.array([1.0, 0.0, 0.0])
_UP = np.array([0.0, math.cos(_PITCH), -math.sin(_PITCH)])
_BACK = np.array([0.0, math.sin(_PITCH), math.cos(_PITCH)])
"""Axes of the first view in the world."""

_FOV = math.radians(50.0)
_HALF = math.tan(_FOV / 2.0)
_USED = 0.85
"""Share of the uncovered picture that the framed points may fill."""

_AROUND_M = 1.5
"""So far around the body its views stand."""

_COVERED_MOST = 0.4
"""However long the instruction, the map keeps more than half of its height."""

_ROW_PX, _LETTER_PX, _BELOW_PX = 26, 10, 94
"""Of the strip: height of a row, width of a letter at most, its margins with the line below it."""

_CARD_LETTERS, _CARD_PX = 80, 16
"""Of a card below it: letters and buttons in letters, its margins."""

_NEAREST_M = 6.0

_STILL_M = 0.01
"""A camera nearer than this to where it was put has not been moved by a person."""


@dataclass(frozen=True, slots=True)
class _Framed:
    """What a page's map was framed for, and from where."""

    size_px: tuple[int, int]
    eye_m: Point


class Cameras:
    """Moves the clients' cameras; a free camera keeps all in view until a person moves it."""

    def __init__(self, server: viser.ViserServer, here: Callable[[], Snapshot]) -> None:
        """Start above the origin until something is known.

        Args:
            server: Whose clients are moved.
            here: What the pages show.
        """
        self._server = server
        self._here = here
        self._opened: str = ""
        self._mode: str = ""
        self._framed: dict[int, _Framed] = {}

    def update(self, snapshot: Snapshot) -> None:
        """Follow what is shown, a free camera only where it would lose it."""
        mode = snapshot.view.camera
        opened = snapshot.branches[0].branch_id
        changed: bool = mode != self._mode or opened != self._opened
        self._mode, self._opened = mode, opened
        for client in self._server.get_clients().values():
            if mode != "free" or changed or self._loses(client, snapshot):
                self._show(client, snapshot)

    def greet(self, client: viser.ClientHandle) -> None:
        """Give a page the view that the others have, now and once its map has its size."""
        self._show(client, self._here())
        client.camera.on_update(lambda _: self._refit(client))

    def forget(self, client: viser.ClientHandle) -> None:
        """A page is gone."""
        self._framed.pop(client.client_id, None)

    def _show(self, client: viser.ClientHandle, snapshot: Snapshot) -> None:
        if snapshot.view.camera != "free":
            self.forget(client)
            _place(client, snapshot, snapshot.view.camera)
            return
        camera = client.camera
        width_px, height_px = camera.image_width, camera.image_height
        camera.fov = _FOV
        covered = covered_share(snapshot, width_px, height_px)
        eye, target = overview(framed_points(snapshot), width_px / height_px, covered=covered)
        self._framed[client.client_id] = _Framed((width_px, height_px), eye)
        _look(client, eye, target)

    def _loses(self, client: viser.ClientHandle, snapshot: Snapshot) -> bool:
        """Whether the body or its views are out of a view that nobody has moved."""
        framed = self._framed.get(client.client_id)
        if framed is None or _moved(client, framed):
            return False
        width_px, height_px = framed.size_px
        covered = covered_share(snapshot, width_px, height_px)
        points = framed_points(snapshot)
        return not in_view(points, framed.eye_m, width_px / height_px, covered=covered)

    def _refit(self, client: viser.ClientHandle) -> None:
        """Frame anew where the map has another size and nobody has moved the camera yet.

        A page connects while its map is still small, and docks can be widened.
        """
        framed = self._framed.get(client.client_id)
        camera = client.camera
        if framed is None or framed.size_px == (camera.image_width, camera.image_height):
            return
        if not _moved(client, framed):
            self._show(client, self._here())


def _moved(client: viser.ClientHandle, framed: _Framed) -> bool:
    return math.dist(client.camera.position.tolist(), framed.eye_m) > _STILL_M


def framed_points(snapshot: Snapshot) -> list[Point]:
    """Start, goal, and the body with its views around it."""
    episode = snapshot.story.header.episode
    x, y, z = snapshot.story.track.footsteps[snapshot.here.step].pose.position_m
    sides = ((_AROUND_M, 0.0), (-_AROUND_M, 0.0), (0.0, _AROUND_M), (0.0, -_AROUND_M))
    points = [episode.start.position_m, *((x + dx, y, z + dz) for dx, dz in sides)]
    if episode.goal_m is not None:
        points.append(episode.goal_m)
    return points


def covered_share(snapshot: Snapshot, width_px: int, height_px: int) -> float:
    """About which share of the map's height the instruction and what stands below it cover."""
    letters = len(snapshot.story.header.episode.instruction)
    covered_px = _rows(letters, width_px) * _ROW_PX + _BELOW_PX
    cards = (snapshot.offer is not None) + (snapshot.place is not None)
    covered_px += cards * (_rows(_CARD_LETTERS, width_px) * _ROW_PX + _CARD_PX)
    return min(_COVERED_MOST, covered_px / height_px)


def _rows(letters: int, width_px: int) -> int:
    return math.ceil(letters * _LETTER_PX / width_px)


def overview(
    points_m: list[Point], aspect: float = 1.0, *, covered: float = 0.12
) -> tuple[Point, Point]:
    """Camera position and target from which all points are seen, looking along −Z and down.

    Args:
        points_m: What must be in the picture.
        aspect: Width over height of the part of the page that no dock covers.
        covered: Share of the height that is covered from above.
    """
    points = np.array(points_m)
    target = (points.min(axis=0) + points.max(axis=0)) / 2.0
    around = points - target
    wide, tall = _HALF * aspect * _USED, _HALF * (1.0 - covered) * _USED
    needed = np.maximum(np.abs(around @ _RIGHT) / wide, np.abs(around @ _UP) / tall)
    distance_m = max(float((needed + around @ _BACK).max()), _NEAREST_M)
    # What is framed moves down by lifting the aim.
    target = target + _UP * (covered * distance_m * _HALF)
    return _point(target + _BACK * distance_m), _point(target)


def in_view(points_m: list[Point], eye_m: Point, aspect: float, *, covered: float) -> bool:
    """Whether all points are seen from an eye that looks as `overview` does; see there."""
    rays = np.array(points_m) - eye_m
    reach = -(rays @ _BACK) * _HALF
    across, up = np.abs(rays @ _RIGHT), rays @ _UP
    inside = (across < reach * aspect) & (-reach < up) & (up < reach * (1.0 - 2.0 * covered))
    return bool(inside.all())


def _point(array: np.ndarray) -> Point:
    x, y, z = array.tolist()
    return (x, y, z)


def _place(client: viser.ClientHandle, snapshot: Snapshot, mode: str) -> None:
    pose = snapshot.story.track.footsteps[snapshot.here.step].pose
    profile = snapshot.story.header.profile
    height_m = profile.camera_height_m
    client.camera.fov = _FOV
    if mode == "ego":
        # The page is wider than the robot's picture: as tall an angle shows all that it saw.
        rgb = profile.rgb
        client.camera.fov = frames.vertical_fov(rgb.hfov_rad, rgb.width_px / rgb.height_px)
        eye = frames.raised(pose.position_m, height_m)
        _look(client, eye, frames.raised(pose.ahead(1.0), height_m))
    elif mode == "top":
        above = frames.raised(pose.position_m, 9.0)
        # Straight down has no heading: a hair's breadth off it keeps −Z up.
        _look(client, (above[0], above[1], above[2] + 0.01), pose.position_m)
    else:
        _look(client, _behind(pose), frames.raised(pose.ahead(1.2), 0.3))


def _behind(pose: Pose) -> Point:
    return frames.raised(pose.ahead(-3.2), 4.2)


def _look(client: viser.ClientHandle, position: Point, target: Point) -> None:
    with client.atomic():
        client.camera.up_direction = (0.0, 1.0, 0.0)
        client.camera.position = position
        client.camera.look_at = target
