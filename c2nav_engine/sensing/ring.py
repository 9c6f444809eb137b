"""The fixed sensor ring: which cameras a fan and a full look consist of.

Views cost no action, turns do: the cameras are there all around the body, a look reads some.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from c2nav_engine.episodes.profile import Profile
from c2nav_engine.geometry import Pose, world_from_camera
from c2nav_engine.sensing.renderer import Image, Renderer

RING_VIEWS = 12
"""Cameras of a full look, 30° apart."""

DEPTH_STRIDE = 4
"""Every n-th row and column of a depth picture is read [C]; only the view ahead is sensed whole.

Rays of colour and depth cost the same, and there are more of depth: sensing only what is read
leaves less than half of the rays of a full look.
"""

SECTORS = 6
"""Joined pictures of a full look; sector k shows ring views 2k and 2k + 1."""


@dataclass(frozen=True, slots=True)
class CameraOffset:
    """One camera of the ring.

    Attributes:
        key: "left", "front", "right" or "ring0" … "ring11".
        offset_rad: Left of the heading.
        depth_stride: Every n-th row and column of its depth picture is sensed.
    """

    key: str
    offset_rad: float
    depth_stride: int = DEPTH_STRIDE


AHEAD = CameraOffset("front", 0.0, depth_stride=1)
"""The view ahead: its depth picture is recorded, so it is sensed whole."""


def ring_offset_rad(view: int) -> float:
    """How far left of the heading ring view `view` looks: counter-clockwise from the front."""
    return view * math.tau / RING_VIEWS


@dataclass(frozen=True, slots=True)
class SensorRing:
    """The cameras of one embodiment.

    Attributes:
        profile: Body and pinholes.
    """

    profile: Profile

    @property
    def front(self) -> tuple[CameraOffset, ...]:
        """The view ahead."""
        return (AHEAD,)

    @property
    def fan(self) -> tuple[CameraOffset, ...]:
        """Left, front and right."""
        side_rad = self.profile.fan_offset_rad
        return (
            CameraOffset("left", side_rad),
            AHEAD,
            CameraOffset("right", -side_rad),
        )

    @property
    def ring(self) -> tuple[CameraOffset, ...]:
        """Twelve views, counter-clockwise from the front."""
        return tuple(
            CameraOffset(f"ring{view}", ring_offset_rad(view)) for view in range(RING_VIEWS)
        )

    def capture(
        self, renderer: Renderer, pose: Pose, cameras: Sequence[CameraOffset]
    ) -> list[Image]:
        """Read cameras at the true pose, in the order given."""
        profile = self.profile
        images: dict[CameraOffset, Image] = {}
        for stride in sorted({camera.depth_stride for camera in cameras}):
            alike = [camera for camera in cameras if camera.depth_stride == stride]
            rendered = renderer.render(
                [
                    world_from_camera(
                        pose, height_m=profile.camera_height_m, offset_rad=camera.offset_rad
                    )
                    for camera in alike
                ],
                rgb=profile.rgb,
                depth=profile.depth,
                near_m=profile.depth_near_m,
                far_m=profile.depth_far_m,
                depth_stride=stride,
            )
            images |= zip(alike, rendered, strict=True)
        return [images[camera] for camera in cameras]
