"""What answers the core's `Look` and `Move`: a simulated body in a rendered scene, or a record.

The shell is the only one that knows the true pose. The core receives believed poses, free space
and pictures; the truth goes to the record beside them.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Float32

from c2nav_engine.controller.free_space import FreeSpaceMemory
from c2nav_engine.controller.sensed import Action, DepthStats, Step, View
from c2nav_engine.episodes.profile import Profile
from c2nav_engine.geometry import Point, Pose, world_from_camera
from c2nav_engine.navigator.requests import Look, Move, Moved, Rig, Seen
from c2nav_engine.runner.exchange import Truth
from c2nav_engine.sensing.depth import depth_facts, depth_points
from c2nav_engine.sensing.encode import depth_png, encode, sectors, thumbnail
from c2nav_engine.sensing.renderer import Image, Renderer
from c2nav_engine.sensing.ring import DEPTH_STRIDE, CameraOffset, SensorRing
from c2nav_engine.world.kinematics import Body
from c2nav_engine.world.surface import Surface

Depth = Float32[np.ndarray, "rows columns"]
Depths = Sequence[Float32[np.ndarray, "_ _"]]
"""Of one look: cameras are sensed at strides of their own."""


@runtime_checkable
class Shell(Protocol):
    """Answers what the core asks of the body."""

    def look(self, request: Look) -> tuple[Seen, Truth]:
        """Read cameras at the present pose."""
        ...

    def move(self, request: Move) -> tuple[Moved, Truth]:
        """Execute actions until they are done, collide, or use up the step budget."""
        ...


GoalDistance = Callable[[Point], float]
"""Geodesic metres from a point to the goal; evaluation side only."""


@runtime_checkable
class Sensors(Protocol):
    """Noise between the world and what the robot believes; absent by default."""

    def odometry(self, believed: Pose, before: Pose, after: Pose) -> Pose:
        """The believed pose after a true motion."""
        ...

    def depth(self, depth_m: Depth) -> Depth:
        """The sensed depth of a true depth picture."""
        ...


class LiveShell:
    """A body on a surface, seen through a renderer.

    Attributes:
        pose: True pose.
        odometry: Believed pose; equal to the true one without odometry noise.
        steps: Executed low-level actions.
    """

    def __init__(
        self,
        *,
        start: Pose,
        surface: Surface,
        renderer: Renderer,
        profile: Profile,
        goal_distance: GoalDistance | None,
        sensors: Sensors | None = None,
    ) -> None:
        self.pose = start
        self.odometry = start
        self.steps = 0
        self._travelled_m = 0.0
        self._body = Body(surface, profile)
        self._renderer = renderer
        self._profile = profile
        self._ring = SensorRing(profile)
        self._memory = FreeSpaceMemory(profile)
        self._goal_distance = goal_distance
        self._sensors = sensors

    def copy(self) -> LiveShell:
        """The same body at the same moment, to go on independently; scene and floor are shared."""
        twin = copy.copy(self)
        twin._memory = copy.deepcopy(self._memory)
        twin._sensors = copy.deepcopy(self._sensors)
        return twin

    def look(self, request: Look) -> tuple[Seen, Truth]:
        """Render the rig's cameras, update the free-space memory, and read every heading."""
        cameras = self._cameras(request.rig)
        images = self._ring.capture(self._renderer, self.pose, cameras)
        depths_m = [self._sensed(image) for image in images]
        self._remember(cameras, depths_m)
        views = tuple(
            self._view(camera, image, depth_m)
            for camera, image, depth_m in zip(cameras, images, depths_m, strict=True)
        )
        is_ring = request.rig is Rig.RING
        joined = sectors([image.rgb for image in images]) if is_ring else []
        front = next((i for i, camera in enumerate(cameras) if camera.key == "front"), None)
        seen = Seen(
            views=views,
            odometry=self.odometry,
            sectors=tuple(encode(picture) for picture in joined),
            thumbnail=None if front is None else encode(thumbnail(images[front].rgb)),
        )
        png = b"" if front is None else depth_png(depths_m[front])
        return seen, Truth((self.pose,), self._distances([self.pose]), png)

    def move(self, request: Move) -> tuple[Moved, Truth]:
        """Execute actions; a collision ends the run, sliding within that step included."""
        steps: list[Step] = []
        poses: list[Pose] = []
        for action in request.actions:
            if self.steps >= self._profile.max_steps:
                break
            step = self._step(action)
            steps.append(step)
            poses.append(self.pose)
            if step.collided:
                break
        exhausted = self.steps >= self._profile.max_steps
        return Moved(tuple(steps), exhausted), Truth(tuple(poses), self._distances(poses))

    def _step(self, action: Action) -> Step:
        before = self.pose
        moved_m, collided = 0.0, False
        if action is Action.FORWARD:
            self.pose, moved_m, collided = self._body.forward(before)
        else:
            self.pose = self._body.turn(before, left=action is Action.LEFT)
        self.steps += 1
        if self._sensors is None:
            self.odometry = self.pose
        else:
            self.odometry = self._sensors.odometry(self.odometry, before, self.pose)
        self._travelled_m += moved_m
        return Step(action, self.odometry, moved_m, collided)

    def _cameras(self, rig: Rig) -> Sequence[CameraOffset]:
        rigs = {Rig.FRONT: self._ring.front, Rig.FAN: self._ring.fan, Rig.RING: self._ring.ring}
        return rigs[rig]

    def _sensed(self, image: Image) -> Depth:
        return image.depth_m if self._sensors is None else self._sensors.depth(image.depth_m)

    def _remember(self, cameras: Sequence[CameraOffset], depths_m: Depths) -> None:
        seen = [
            self._points(camera, depth_m) for camera, depth_m in zip(cameras, depths_m, strict=True)
        ]
        # Where views overlap, the later one counts.
        points_m = np.concatenate(seen[::-1])
        self._memory.observe(points_m, travelled_m=self._travelled_m)

    def _points(self, camera: CameraOffset, depth_m: Depth) -> Float[np.ndarray, "points 3"]:
        # Points are placed where the robot believes it is: the memory lives in odometry.
        profile = self._profile
        thinned = DEPTH_STRIDE // camera.depth_stride
        return depth_points(
            depth_m[::thinned, ::thinned],
            profile.depth,
            world_from_camera(
                self.odometry, height_m=profile.camera_height_m, offset_rad=camera.offset_rad
            ),
            near_m=profile.depth_near_m,
            far_m=profile.depth_far_m,
            stride=DEPTH_STRIDE,
        )

    def _view(self, camera: CameraOffset, image: Image, depth_m: Depth) -> View:
        profile = self._profile
        median_m, holes = depth_facts(
            depth_m, near_m=profile.depth_near_m, far_m=profile.depth_far_m
        )
        return View(
            key=camera.key,
            offset_rad=camera.offset_rad,
            picture=encode(image.rgb),
            free_m=self._memory.free_m(self.odometry, camera.offset_rad),
            depth=DepthStats(median_m, holes),
        )

    def _distances(self, poses: Sequence[Pose]) -> tuple[float, ...]:
        if self._goal_distance is None:
            return ()
        return tuple(self._goal_distance(pose.position_m) for pose in poses)
