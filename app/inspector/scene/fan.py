"""The views of the decision in view as frusta, with their letters and thumbnails."""

from __future__ import annotations

import math

import viser

from app.inspector.panels.protocol import Dispatch
from app.inspector.scene import frames
from app.inspector.scene.colours import BLUE, GREY, SLATE, Rgb
from app.inspector.scene.layer import Group
from app.inspector.scene.thumbnails import pixels
from app.session import commands as c
from app.session.cards import ranks_of, said_of
from app.session.decisions import Decision
from app.session.snapshot import Snapshot
from c2nav_engine.contract.question import Slot
from c2nav_engine.geometry import Point, Pose

_SCALE_M = 0.95
_GLANCE_SCALE_M = 0.7
_GLANCE = math.radians(30.0)


class Fan:
    """Blue for the first, slate for the others, grey for the vetoed; clicking one ranks it."""

    def __init__(self, scene: viser.SceneApi, dispatch: Dispatch) -> None:
        """Draw below /fan."""
        self._scene = scene
        self._dispatch = dispatch
        self._group = Group(scene, "/fan")

    def update(self, snapshot: Snapshot) -> None:
        """Show the decision's views where they were taken."""
        decision = snapshot.decision
        layers = snapshot.view.layers
        ego = snapshot.view.camera == "ego"
        if decision is None or ego or "fan" not in layers or not _fanned(decision):
            self._group.draw(None, list)
            return
        pose = pose_of(snapshot, decision)
        first = {key for key, rank in ranks_of(said_of(snapshot, decision)).items() if rank == 1}
        lit = snapshot.view.hovered
        thumbnails = "thumbnails" in layers
        key = (snapshot.branch.branch_id, decision.number, frozenset(first), lit, thumbnails)
        self._group.draw(key, lambda: self._draw(snapshot, decision, pose, first | {lit}))

    def _draw(
        self, snapshot: Snapshot, decision: Decision, pose: Pose, lit: set[str]
    ) -> list[viser.SceneNodeHandle]:
        profile = snapshot.story.header.profile
        nodes: list[viser.SceneNodeHandle] = []
        glance = decision.slot is Slot.GLANCE
        for candidate in decision.facts.candidates:
            if candidate.offset_rad is None:
                continue
            # A sector joins two ring views: it is drawn around the middle of both.
            offset_rad = candidate.offset_rad + (_GLANCE / 2.0 if glance else 0.0)
            yaw_rad = pose.yaw_rad + offset_rad
            colour = _colour(candidate.key in lit, candidate.feasible)
            picture = candidate.picture
            aspect = picture.width_px / picture.height_px if picture else 1.0
            scale = _GLANCE_SCALE_M if glance else _SCALE_M
            frustum = self._scene.add_camera_frustum(
                f"/fan/{candidate.key}",
                fov=frames.vertical_fov(
                    profile.rgb.hfov_rad if not glance else 2 * _GLANCE, aspect
                ),
                aspect=aspect,
                scale=scale,
                color=colour,
                thickness=4.0 if candidate.key in lit else 2.0,
                thickness_units="screen",
                image=pixels(picture, vetoed=not candidate.feasible)
                if picture and "thumbnails" in snapshot.view.layers
                else None,
                wxyz=frames.camera_wxyz(yaw_rad),
                position=frames.raised(pose.position_m, profile.camera_height_m * 0.35),
                cast_shadow=False,
                receive_shadow=False,
            )
            nodes.append(frustum)
            letter = decision.letters.get(candidate.key, "✕")
            far_m = pose.turned(offset_rad).ahead(1.45 * scale)
            nodes.append(self._label(letter, candidate.key, frames.raised(far_m, 0.95)))
            self._make_clickable(frustum, candidate.key, candidate.feasible)
        return nodes

    def _label(self, letter: str, key: str, point_m: Point) -> viser.SceneNodeHandle:
        return self._scene.add_label(
            f"/fan/letter_{key}",
            letter,
            position=point_m,
            anchor="center-center",
            font_screen_scale=1.15,
        )

    def _make_clickable(self, frustum: viser.CameraFrustumHandle, key: str, feasible: bool) -> None:
        if not feasible:
            return

        @frustum.on_click
        def _(_: object) -> None:
            self._dispatch(c.Press(key=key))


def _fanned(decision: Decision) -> bool:
    return any(candidate.offset_rad is not None for candidate in decision.facts.candidates)


def pose_of(snapshot: Snapshot, decision: Decision) -> Pose:
    """Where the body stood when it decided; the believed pose is not always the true one."""
    return snapshot.story.track.footsteps[decision.step].pose


def _colour(lit: bool, feasible: bool) -> Rgb:
    if not feasible:
        return GREY
    return BLUE if lit else SLATE
