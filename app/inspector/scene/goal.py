"""Evaluation side, on demand: the goal with its success radius, and the reference path."""

from __future__ import annotations

import viser

from app.inspector.scene import frames
from app.inspector.scene.colours import GREEN, GREY
from app.inspector.scene.flat import add_flat
from app.inspector.scene.layer import Group
from app.session.snapshot import Snapshot

_DISC_M = 0.07
"""Of the disc above the goal: floors of models lie a little above the surface walked on."""


class Goal:
    """A green disc of the success radius; a dashed reference path."""

    def __init__(self, scene: viser.SceneApi) -> None:
        """Draw below /goal and /reference."""
        self._scene = scene
        self._disc = Group(scene, "/goal")
        self._path = Group(scene, "/reference")

    def update(self, snapshot: Snapshot) -> None:
        """Follow the layers' switches."""
        episode = snapshot.story.header.episode
        layers = snapshot.view.layers
        branch = snapshot.branches[0].branch_id
        goal_on = "goal" in layers and episode.goal_m is not None
        self._disc.draw(branch if goal_on else None, lambda: self._draw_goal(snapshot))
        path_on = "reference" in layers and len(episode.reference_path_m) > 1
        self._path.draw(branch if path_on else None, lambda: self._draw_path(snapshot))

    def _draw_goal(self, snapshot: Snapshot) -> list[viser.SceneNodeHandle]:
        episode = snapshot.story.header.episode
        if episode.goal_m is None:
            return []
        centre_m = frames.raised(episode.goal_m, _DISC_M - frames.LIFT_M)
        ring = frames.ring_points(centre_m, episode.goal_radius_m)
        return [
            add_flat(
                self._scene,
                "/goal/disc",
                frames.disc(episode.goal_radius_m),
                GREEN,
                opacity=0.25,
                position_m=frames.raised(episode.goal_m, _DISC_M),
            ),
            self._scene.add_line_segments(
                "/goal/rim", frames.polyline(ring), GREEN, thickness=3.0, thickness_units="screen"
            ),
            self._scene.add_label(
                "/goal/name",
                "goal",
                position=frames.raised(episode.goal_m, 0.1),
                anchor="center-center",
            ),
        ]

    def _draw_path(self, snapshot: Snapshot) -> list[viser.SceneNodeHandle]:
        path = list(snapshot.story.header.episode.reference_path_m)
        segments = frames.dashes(path, dash_m=0.3, gap_m=0.2)
        return [
            self._scene.add_line_segments(
                "/reference/path", segments, GREY, thickness=3.0, thickness_units="screen"
            )
        ]
