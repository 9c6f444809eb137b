"""The walkable floor that kinematics and distances go by, below the cut."""

from __future__ import annotations

import numpy as np
import viser
from jaxtyping import Float

from app.inspector.scene.colours import SLATE
from app.inspector.scene.cutting import CUT_M
from app.inspector.scene.flat import add_flat
from app.inspector.scene.layer import Group
from app.inspector.scene.storey import storey_of
from app.session.snapshot import Snapshot

_LIFT_M = 0.08
"""Navigation meshes run through the floor of a model as often as above it."""


class Floor:
    """A translucent sheet, read from a `.navmesh` or built."""

    def __init__(self, scene: viser.SceneApi) -> None:
        """Draw below /walkable."""
        self._scene = scene
        self._group = Group(scene, "/walkable")

    def update(self, snapshot: Snapshot) -> None:
        """Follow the layer's switch and the storey."""
        floor_m = snapshot.overlays.floor_m
        if floor_m is None or "floor" not in snapshot.view.layers:
            self._group.draw(None, list)
            return
        height_m = storey_of(snapshot) + CUT_M
        self._group.draw((snapshot.overlays, height_m), lambda: self._draw(floor_m, height_m))

    def _draw(
        self, floor_m: Float[np.ndarray, "n 3 3"], height_m: float
    ) -> list[viser.SceneNodeHandle]:
        shown = floor_m[floor_m[:, :, 1].max(axis=1) < height_m]
        if not len(shown):
            return []
        corners = shown.reshape(-1, 3)
        return [
            add_flat(
                self._scene,
                "/walkable/sheet",
                (
                    corners.astype(np.float32),
                    np.arange(len(corners), dtype=np.uint32).reshape(-1, 3),
                ),
                SLATE,
                opacity=0.45,
                position_m=(0.0, _LIFT_M, 0.0),
            )
        ]
