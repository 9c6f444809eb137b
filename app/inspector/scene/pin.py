"""The asked place, and the clicks that ask for one."""

from __future__ import annotations

import viser

from app.inspector.panels.protocol import Dispatch
from app.inspector.scene.colours import BLUE
from app.inspector.scene.layer import Group
from app.session import commands as c
from app.session.snapshot import Snapshot


class Pin:
    """A blue ball at the asked place; clicking the map asks for another, or goes to a step."""

    def __init__(self, scene: viser.SceneApi, dispatch: Dispatch) -> None:
        """Draw below /asked."""
        self._scene = scene
        self._group = Group(scene, "/asked")

        @scene.on_click()
        def _(event: viser.SceneClickEvent) -> None:
            dispatch(c.Place(ray_from_m=event.ray_origin, ray_along=event.ray_direction))

    def update(self, snapshot: Snapshot) -> None:
        """Follow the asked place."""
        place = snapshot.place
        self._group.draw(None if place is None else place.point_m, lambda: self._draw(snapshot))

    def _draw(self, snapshot: Snapshot) -> list[viser.SceneNodeHandle]:
        place = snapshot.place
        if place is None:
            return []
        x, y, z = place.point_m
        return [
            self._scene.add_icosphere(
                "/asked/ball", radius=0.09, color=BLUE, position=place.point_m, cast_shadow=False
            ),
            # High enough to stand clear of the goal's name, where the goal was asked for.
            self._scene.add_label(
                "/asked/name", "asked", position=(x, y + 0.6, z), anchor="center-center"
            ),
        ]
