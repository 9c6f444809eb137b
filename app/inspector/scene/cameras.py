"""How the map is looked at: free, following, through the robot's camera, from above."""

from __future__ import annotations

import math

import numpy as np
import viser

from app.inspector.scene import frames
from app.session.snapshot import Snapshot
from c2nav_engine.geometry import Point, Pose

_PITCH = math.radians(66.0)
"""Of the first view: steep enough to look over walls, flat enough to read furniture."""

_FOV = math.radians(50.0)
_USED = 0.75
"""Share of the uncovered picture that the framed points may fill: views stand around the body."""

_COVERED_MOST = 0.4
"""However long the instruction, the map keeps more than half of its height."""

_ROW_PX, _LETTER_PX, _BELOW_PX = 26, 10, 94
"""Of the strip: height of a row, width of a letter at most, its margins with the line below it."""

_NEAREST_M = 6.0

_LEAST_PX = 400
"""No window is so narrow that the docks leave less: then they were subtracted already."""


class Cameras:
    """Moves the clients' cameras; a free camera is framed once and then left to the person."""

    def __init__(self, server: viser.ViserServer, *, covered_px: int) -> None:
        """Start above the origin until something is known.

        Args:
            server: Whose clients are moved.
            covered_px: Width of the docks. A page connects before they take their place, so its
                first picture is as wide as the window.
        """
        self._server = server
        self._covered_px = covered_px
        self._framed: str = ""
        self._mode: str = ""

    def update(self, snapshot: Snapshot) -> None:
        """Frame at first, follow after."""
        mode = snapshot.view.camera
        opened = snapshot.branches[0].branch_id
        changed: bool = mode != self._mode or opened != self._framed
        self._mode, self._framed = mode, opened
        if mode != "free" or changed:
            for client in self._server.get_clients().values():
                self.greet(client, snapshot)

    def greet(self, client: viser.ClientHandle, snapshot: Snapshot) -> None:
        """Give a page the view that the others have."""
        if snapshot.view.camera == "free":
            camera = client.camera
            width_px = uncovered_px(camera.image_width, self._covered_px)
            camera.fov = _FOV
            covered = covered_share(snapshot, width_px, camera.image_height)
            aspect = width_px / camera.image_height
            _look(client, *overview(framed_points(snapshot), aspect, covered=covered))
        else:
            _place(client, snapshot, snapshot.view.camera)


def uncovered_px(width_px: int, covered_px: int) -> int:
    """Width of the map once the docks stand, whether or not they do already."""
    left = width_px - covered_px
    return left if left > _LEAST_PX else width_px


def framed_points(snapshot: Snapshot) -> list[Point]:
    """Start, body and goal."""
    episode = snapshot.story.header.episode
    body = snapshot.story.track.footsteps[snapshot.here.step].pose.position_m
    points = [episode.start.position_m, body]
    if episode.goal_m is not None:
        points.append(episode.goal_m)
    return points


def covered_share(snapshot: Snapshot, width_px: int, height_px: int) -> float:
    """About which share of the map's height the instruction and the line below it cover."""
    letters = len(snapshot.story.header.episode.instruction)
    rows = math.ceil(letters * _LETTER_PX / width_px)
    return min(_COVERED_MOST, (rows * _ROW_PX + _BELOW_PX) / height_px)


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
    x, y, z = (points - target).T
    sin, cos = math.sin(_PITCH), math.cos(_PITCH)
    up, nearer = y * cos - z * sin, y * sin + z * cos
    half = math.tan(_FOV / 2.0)
    wide, tall = half * aspect * _USED, half * (1.0 - covered) * _USED
    needed = np.maximum(np.abs(x) / wide, np.abs(up) / tall) + nearer
    distance_m = max(float(needed.max()), _NEAREST_M)
    # What is framed moves down by lifting the aim.
    target = target + np.array([0.0, cos, -sin]) * (covered * distance_m * half)
    eye = target + np.array([0.0, sin, cos]) * distance_m
    return _point(eye), _point(target)


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
