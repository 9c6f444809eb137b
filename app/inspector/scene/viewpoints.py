"""Matterport's panoramas and the ways between them, as the connectivity graph knows them."""

from __future__ import annotations

import numpy as np
import viser

from app.inspector.scene.colours import SLATE
from app.inspector.scene.cutting import CUT_M
from app.inspector.scene.frames import raised
from app.inspector.scene.layer import Group
from app.inspector.scene.storey import storey_of
from app.session.snapshot import Snapshot
from c2nav_engine.world.connectivity import ConnectivityGraph

_LIFT_M = 0.15
"""Tripod heights differ from the floor by more than lines that were walked."""

_DOT_M = 0.1


class Viewpoints:
    """A dot at each panorama's foot point and a thin line to each neighbour."""

    def __init__(self, scene: viser.SceneApi) -> None:
        """Draw below /viewpoints."""
        self._scene = scene
        self._group = Group(scene, "/viewpoints")

    def update(self, snapshot: Snapshot) -> None:
        """Follow the layer's switch and the storey."""
        graph = snapshot.overlays.viewpoints
        if graph is None or "viewpoints" not in snapshot.view.layers:
            self._group.draw(None, list)
            return
        height_m = storey_of(snapshot) + CUT_M
        self._group.draw((snapshot.overlays, height_m), lambda: self._draw(graph, height_m))

    def _draw(self, graph: ConnectivityGraph, height_m: float) -> list[viser.SceneNodeHandle]:
        feet_m = {
            name: raised(viewpoint.foot_m, _LIFT_M)
            for name, viewpoint in graph.viewpoints.items()
            if viewpoint.foot_m[1] < height_m
        }
        ways = [
            (feet_m[here], feet_m[there])
            for here in feet_m
            for there in graph.ways_m[here]
            if here < there and there in feet_m
        ]
        nodes: list[viser.SceneNodeHandle] = []
        if feet_m:
            nodes.append(
                self._scene.add_point_cloud(
                    "/viewpoints/feet",
                    np.array(list(feet_m.values()), np.float32),
                    SLATE,
                    point_size=_DOT_M,
                    point_shape="circle",
                    precision="float32",
                    point_shading="flat",
                )
            )
        if ways:
            nodes.append(
                self._scene.add_line_segments(
                    "/viewpoints/ways",
                    np.array(ways, np.float32),
                    SLATE,
                    thickness=1.5,
                    thickness_units="screen",
                )
            )
        return nodes
