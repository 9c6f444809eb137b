"""The body as a wedge on the floor, and its radius."""

from __future__ import annotations

import viser

from app.inspector.scene import frames
from app.inspector.scene.colours import INK
from app.session.snapshot import Snapshot

_LENGTH_M = 0.22


class Body:
    """A wedge that looks where the body looks."""

    def __init__(self, scene: viser.SceneApi) -> None:
        """Draw at /body."""
        vertices, faces = frames.wedge(_LENGTH_M)
        self._wedge = scene.add_mesh_simple(
            "/body", vertices, faces, color=INK, side="double", cast_shadow=False
        )

    def update(self, snapshot: Snapshot) -> None:
        """Stand where the snapshot stands."""
        pose = snapshot.story.track.footsteps[snapshot.here.step].pose
        self._wedge.position = frames.raised(pose.position_m, 0.06)
        self._wedge.wxyz = frames.yaw_wxyz(pose.yaw_rad)
