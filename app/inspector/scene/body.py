"""The body as a wedge on the floor, and its radius."""

from __future__ import annotations

import viser

from app.inspector.scene import frames
from app.inspector.scene.colours import INK
from app.inspector.scene.flat import add_flat
from app.session.snapshot import Snapshot

_LENGTH_M = 0.22


class Body:
    """A wedge that looks where the body looks."""

    def __init__(self, scene: viser.SceneApi) -> None:
        """Draw at /body, from the first update on."""
        self._scene = scene
        self._wedge: viser.SceneNodeHandle | None = None

    def update(self, snapshot: Snapshot) -> None:
        """Stand where the snapshot stands."""
        if self._wedge is None:
            self._wedge = add_flat(self._scene, "/body", frames.wedge(_LENGTH_M), INK)
        pose = snapshot.story.track.footsteps[snapshot.here.step].pose
        self._wedge.position = frames.raised(pose.position_m, 0.06)
        self._wedge.wxyz = frames.yaw_wxyz(pose.yaw_rad)
