"""A family of runs in its scene as one document, by viser's own `as_html`."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Sequence
from dataclasses import replace

import viser

from app.inspector.scene import frames
from app.inspector.scene.body import Body
from app.inspector.scene.cameras import framed_points, overview
from app.inspector.scene.colours import GREY
from app.inspector.scene.cutting import CUT_M
from app.inspector.scene.goal import Goal
from app.inspector.scene.mesh import Cut, cutaway_of, send
from app.inspector.scene.storey import storey_of
from app.inspector.scene.trajectory import Trajectory
from app.inspector.still.lighter import Lightness, lighter
from app.session.branches import Branch
from app.session.opened import Choice
from app.session.snapshot import Chooser, Snapshot
from app.session.story import Story
from c2nav_engine.world.scene import Scene

_LAYERS = frozenset(("scene", "trajectory", "goal", "reference"))


def still_page(
    runs: Sequence[tuple[Branch, Story]], scene: Scene, *, lightness: Lightness | None = None
) -> str:
    """A complete page of the scene with the ways walked; the body stands at `/body`.

    A viser server on a loopback port stands for as long as this takes: viser serialises a
    server's scene, and has no other way to make one.

    Args:
        runs: The first is drawn by leg, the others dashed.
        scene: The mesh; it is cut open and made light.
        lightness: The budget.
    """
    snapshot = _snapshot(runs)
    height_m = storey_of(snapshot) + CUT_M
    light = lighter(scene, below_m=height_m, lightness=lightness)
    # viser prints its own address, which is nobody's business here.
    with contextlib.redirect_stdout(io.StringIO()):
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    try:
        _dress(server, snapshot)
        for layer in (Trajectory(server.scene), Body(server.scene), Goal(server.scene)):
            layer.update(snapshot)
        list(send(server.scene, cutaway_of(Cut(light, height_m), whole=scene)))
        for branch, other in runs[1:]:
            _draw_other(server.scene, branch, other)
        server.flush()
        return server.scene.as_html()
    finally:
        with contextlib.redirect_stdout(io.StringIO()):
            server.stop()


def _dress(server: viser.ViserServer, snapshot: Snapshot) -> None:
    scene = server.scene
    scene.set_up_direction("+y")
    scene.configure_environment_map(hdri=None)
    scene.configure_default_lights(enabled=True, cast_shadow=False)
    scene.world_axes.visible = False
    camera = server.initial_camera
    camera.position, camera.look_at = overview(framed_points(snapshot), 1.2)
    camera.up = (0.0, 1.0, 0.0)


def _snapshot(runs: Sequence[tuple[Branch, Story]]) -> Snapshot:
    branch, story = runs[0]
    plain = Snapshot(
        version=0,
        chooser=Chooser("", (), Choice("")),
        branches=tuple(each for each, _ in runs),
        branch=branch,
        story=story,
        stop=len(story.stops) - 1,
        scene_serial=1,
    )
    return replace(plain, view=replace(plain.view, layers=_LAYERS))


def _draw_other(scene: viser.SceneApi, branch: Branch, story: Story) -> None:
    points = [footstep.pose.position_m for footstep in story.track.footsteps]
    if len(points) < 2:
        return
    dashes = frames.dashes(points, dash_m=0.16, gap_m=0.12)
    scene.add_line_segments(
        f"/other/{branch.branch_id}", dashes, GREY, thickness=3.0, thickness_units="screen"
    )
