"""How the map is looked at: free, following, through the robot's camera, from above."""

from __future__ import annotations

import math

import numpy as np
import viser

from app.inspector.scene import frames
from app.session.snapshot import Snapshot
from c2nav_engine.geometry import Point, Pose

_PITCH = math.radians(58.0)
"""Of the first view: steep enough to look over walls, flat enough to read furniture."""

_FOV = math.radians(50.0)
_MARGIN = 1.25
_NEAREST_M = 4.0


class Cameras:
    """Moves the clients' cameras; a free camera is framed once and then left to the person."""

    def __init__(self, server: viser.ViserServer) -> None:
        """Start above the origin until something is known."""
        self._server = server
        self._framed = ""
        self._mode = ""

    def update(self, snapshot: Snapshot) -> None:
        """Frame at first, follow after."""
        mode = snapshot.view.camera
        key = f"{snapshot.branches[0].branch_id}"
        if key != self._framed:
            self._framed = key
            self._frame(framed_points(snapshot))
        changed, self._mode = mode != self._mode, mode
        if mode == "free":
            if changed:
                self._frame(framed_points(snapshot))
            return
        for client in self._server.get_clients().values():
            _place(client, snapshot, mode)

    def greet(self, client: viser.ClientHandle, snapshot: Snapshot) -> None:
        """Give a new page the view that the others have."""
        if snapshot.view.camera == "free":
            position, target = overview(framed_points(snapshot))
            _look(client, position, target)
        else:
            _place(client, snapshot, snapshot.view.camera)

    def _frame(self, points_m: list[Point]) -> None:
        position, target = overview(points_m)
        initial = self._server.initial_camera
        initial.position = position
        initial.look_at = target
        initial.up = (0.0, 1.0, 0.0)
        initial.fov = _FOV
        for client in self._server.get_clients().values():
            _look(client, position, target)


def framed_points(snapshot: Snapshot) -> list[Point]:
    """Start, body and goal."""
    episode = snapshot.story.header.episode
    body = snapshot.story.track.footsteps[snapshot.here.step].pose.position_m
    points = [episode.start.position_m, body]
    if episode.goal_m is not None:
        points.append(episode.goal_m)
    return points


def overview(points_m: list[Point]) -> tuple[Point, Point]:
    """Camera position and target from which all points are seen, looking along −Z and down."""
    array = np.array(points_m)
    low, high = array.min(axis=0), array.max(axis=0)
    target = (low + high) / 2.0
    span_m = max(float(np.linalg.norm((high - low)[[0, 2]])), _NEAREST_M)
    distance_m = _MARGIN * span_m / (2.0 * math.tan(_FOV / 2.0)) + 2.0
    back = np.array([0.0, math.sin(_PITCH), math.cos(_PITCH)]) * distance_m
    x, y, z = (target + back).tolist()
    tx, ty, tz = target.tolist()
    return (x, y, z), (tx, ty, tz)


def _place(client: viser.ClientHandle, snapshot: Snapshot, mode: str) -> None:
    pose = snapshot.story.track.footsteps[snapshot.here.step].pose
    height_m = snapshot.story.header.profile.camera_height_m
    if mode == "ego":
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
