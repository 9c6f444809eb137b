"""Arriving in the map: the look-back pair, the markers held, and the way back walked."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import viser

from app.inspector.panels.ladder import ladders_in_view
from app.inspector.scene import frames
from app.inspector.scene.colours import BLUE, SLATE
from app.inspector.scene.layer import Group
from app.inspector.scene.thumbnails import pixels
from app.session.decisions import Decision
from app.session.snapshot import Snapshot
from app.session.story import Story
from c2nav_engine.contract.question import Picture, Slot
from c2nav_engine.geometry import Point, Pose

WALK_BACK = "walk-back"
"""Purpose of the motion that returns to a marker."""

_SCALE_M = 0.6

_ABOVE = np.array([0.0, 0.05, 0.0], dtype=np.float32)
"""The way back is drawn over the way there."""


class LookBack:
    """Frames of the question in view; a flag per marker; the way back dotted."""

    def __init__(self, scene: viser.SceneApi) -> None:
        """Draw below /lookback, /markers and /return."""
        self._scene = scene
        self._pair = Group(scene, "/lookback")
        self._markers = Group(scene, "/markers")
        self._return = Group(scene, "/return")

    def update(self, snapshot: Snapshot) -> None:
        """Follow the place where one stands."""
        shown = "markers" in snapshot.view.layers
        decision = snapshot.decision
        branch = snapshot.branch.branch_id
        asked = decision is not None and decision.slot is Slot.LOOKBACK
        self._pair.draw(
            (branch, decision.number) if shown and asked and decision else None,
            lambda: self._draw_pair(snapshot, decision) if decision else [],
        )
        markers = tuple(ladders[-1].markers) if (ladders := ladders_in_view(snapshot)) else ()
        poses = tuple(marker.odometry for marker in markers)
        self._markers.draw(poses if shown and poses else None, lambda: self._draw_markers(poses))
        step = snapshot.here.step
        ways = ways_back(snapshot.story, step)
        self._return.draw((branch, step) if shown and ways else None, lambda: self._draw_ways(ways))

    def _draw_pair(self, snapshot: Snapshot, decision: Decision) -> list[viser.SceneNodeHandle]:
        question = decision.question
        nodes: list[viser.SceneNodeHandle] = []
        for alternative in question.alternatives if question else ():
            picture = alternative.picture
            pose = taken_at(snapshot.story, picture) if picture else None
            if picture is None or pose is None:
                continue
            won = alternative.key == decision.elected
            nodes += self._frame(snapshot, alternative.key, picture, pose=pose, won=won)
        return nodes

    def _frame(
        self, snapshot: Snapshot, key: str, picture: Picture, *, pose: Pose, won: bool
    ) -> list[viser.SceneNodeHandle]:
        profile = snapshot.story.header.profile
        aspect = picture.width_px / picture.height_px
        letter = snapshot.decision.letters.get(key, "") if snapshot.decision else ""
        return [
            self._scene.add_camera_frustum(
                f"/lookback/{key}",
                fov=frames.vertical_fov(profile.rgb.hfov_rad, aspect),
                aspect=aspect,
                scale=_SCALE_M,
                color=BLUE if won else SLATE,
                thickness=4.0 if won else 2.0,
                thickness_units="screen",
                image=pixels(picture),
                wxyz=frames.camera_wxyz(pose.yaw_rad),
                position=frames.raised(pose.position_m, profile.camera_height_m * 0.35),
                cast_shadow=False,
                receive_shadow=False,
            ),
            self._scene.add_label(
                f"/lookback/letter_{key}",
                f"{letter} {key}".strip(),
                position=frames.raised(pose.ahead(1.45 * _SCALE_M), 0.9),
                anchor="center-center",
            ),
        ]

    def _draw_markers(self, poses: tuple[Pose, ...]) -> list[viser.SceneNodeHandle]:
        nodes: list[viser.SceneNodeHandle] = []
        for index, pose in enumerate(poses):
            ring = frames.ring_points(pose.position_m, 0.3, 24)
            nodes.append(
                self._scene.add_line_segments(
                    f"/markers/{index}",
                    frames.polyline(ring),
                    SLATE,
                    thickness=3.0,
                    thickness_units="screen",
                )
            )
            nodes.append(
                self._scene.add_label(
                    f"/markers/name{index}",
                    f"⚑ marker {index + 1}",
                    position=frames.raised(pose.position_m, 0.4),
                    anchor="center-center",
                )
            )
        return nodes

    def _draw_ways(self, ways: list[list[Point]]) -> list[viser.SceneNodeHandle]:
        return [
            self._scene.add_line_segments(
                f"/return/{index}",
                np.add(frames.dashes(way, dash_m=0.06, gap_m=0.1), _ABOVE),
                SLATE,
                thickness=6.0,
                thickness_units="screen",
            )
            for index, way in enumerate(ways)
        ]


def taken_at(story: Story, picture: Picture) -> Pose | None:
    """Where a front picture was taken."""
    for glimpse in reversed(story.track.glimpses):
        for view in glimpse.seen.views:
            if view.picture.sha256 == picture.sha256:
                return glimpse.pose.turned(view.offset_rad)
    return None


def ways_back(story: Story, step: int) -> list[list[Point]]:
    """Runs of walk-back motion up to a step, long enough to be drawn."""
    ways: list[list[Point]] = []
    footsteps = story.track.footsteps[: step + 1]
    for before, after in pairwise(footsteps):
        if after.purpose != WALK_BACK:
            continue
        if before.purpose != WALK_BACK or not ways:
            ways.append([before.pose.position_m])
        ways[-1].append(after.pose.position_m)
    return [way for way in ways if way[0] != way[-1]]
