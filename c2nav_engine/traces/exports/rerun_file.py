"""A trace, or two side by side, as a Rerun recording with a layout."""

from __future__ import annotations

import importlib
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from c2nav_engine.errors import MissingExtra
from c2nav_engine.geometry import Point
from c2nav_engine.traces.attachments import task_of
from c2nav_engine.traces.exports.rerun_log import RerunLog
from c2nav_engine.traces.moments import moments
from c2nav_engine.traces.reader import TraceFile
from c2nav_engine.world.scene import Scene

APPLICATION = "c2nav"
FIRST_RGB = (96, 164, 236)
SECOND_RGB = (236, 140, 84)


def export_rrd(
    trace: TraceFile, out: Path, *, other: TraceFile | None = None, scene: Scene | None = None
) -> None:
    """Write a `.rrd` that opens with views, depth, map, ladder and decision text in place.

    Args:
        trace: The run.
        out: The file to write.
        other: A second run; then the entities stand below `/run_a` and `/run_b`, and both share
            one 3-D view and one clock, the step.
        scene: The mesh to draw around them; a trace holds none.

    Raises:
        MissingExtra: The extra `rerun` is not installed.
    """
    rr, rrb = _rerun()
    recording = rr.RecordingStream(APPLICATION, recording_id=trace.sha256, send_properties=False)
    runs = [("", trace)] if other is None else [("/run_a", trace), ("/run_b", other)]
    layout = _blueprint(rrb, [root for root, _ in runs], eye=_eye(trace))
    recording.save(str(out), default_blueprint=layout)
    for (root, each), colour in zip(runs, (FIRST_RGB, SECOND_RGB), strict=False):
        log = RerunLog(rr, recording, root=root, colour=colour)
        log.log(each, task_of(each))
        if scene is not None and root in ("", "/run_a"):
            log.scene(scene)
    recording.disconnect()


def _rerun() -> tuple[Any, Any]:
    try:
        return importlib.import_module("rerun"), importlib.import_module("rerun.blueprint")
    except ImportError as error:
        message = "expected the package rerun-sdk for `rrd`: install it with the extra `rerun`"
        raise MissingExtra(message) from error


@dataclass(frozen=True, slots=True)
class _Eye:
    """Where the world is seen from at first, in metres."""

    position_m: Point
    target_m: Point


def _eye(trace: TraceFile) -> _Eye:
    """From above and behind the middle of the way, far enough to see all of it."""
    points_m = [pose.position_m for moment in moments(trace) for _, pose in moment.poses()]
    points_m = points_m or [(0.0, 0.0, 0.0)]
    low = [min(point[axis] for point in points_m) for axis in range(3)]
    high = [max(point[axis] for point in points_m) for axis in range(3)]
    x, y, z = ((a + b) / 2.0 for a, b in zip(low, high, strict=True))
    reach_m = 4.0 + math.dist(low, high)
    return _Eye((x, y + 1.1 * reach_m, z + 0.7 * reach_m), (x, y, z))


def _blueprint(rrb: Any, roots: list[str], *, eye: _Eye) -> Any:
    """Pictures above, the world with the whole trail beside what was decided."""
    world = rrb.Spatial3DView(
        origin="/",
        contents=[f"+ {root}/world/**" for root in roots],
        name="World",
        eye_controls=rrb.EyeControls3D(
            position=eye.position_m, look_target=eye.target_m, eye_up=(0.0, 1.0, 0.0)
        ),
    )
    pictures = [_pictures(rrb, root) for root in roots]
    words = rrb.Tabs(
        *(_text(rrb, f"{root}/decision", f"Decision{_of(root)}") for root in roots),
        *(_text(rrb, f"{root}/ladder/verdict", f"Ladder{_of(root)}") for root in roots),
        *(_text(rrb, f"{root}/sketch", f"Sketch{_of(root)}") for root in roots),
        _text(rrb, f"{roots[0]}/instruction", "Instruction"),
    )
    curves = rrb.Tabs(
        rrb.TimeSeriesView(
            origin="/",
            contents=[f"+ {root}/goal_distance_m" for root in roots],
            name="Distance to the goal (m), unknown to the agent",
        ),
        rrb.TimeSeriesView(
            origin="/",
            contents=[
                f"+ {root}/ladder/{name}"
                for root in roots
                for name in ("ground", "journey", "lookback")
            ],
            name="Evidence",
        ),
        rrb.TextLogView(
            origin="/", contents=[f"+ {root}/log" for root in roots], name="What happened"
        ),
    )
    return rrb.Blueprint(
        rrb.Vertical(
            rrb.Vertical(*pictures),
            rrb.Horizontal(world, words, column_shares=[3, 2]),
            curves,
            row_shares=[3 * len(roots), 5, 2],
        ),
        rrb.TimePanel(timeline="step", state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
    )


def _pictures(rrb: Any, root: str) -> Any:
    fan = [
        rrb.Spatial2DView(
            origin=f"{root}/world/camera/{key}", contents="$origin/image", name=f"{key}{_of(root)}"
        )
        for key in ("left", "front", "right")
    ]
    depth = rrb.Spatial2DView(
        origin=f"{root}/world/depth/front", contents="$origin/image", name=f"depth{_of(root)}"
    )
    glance = rrb.Horizontal(
        *(rrb.Spatial2DView(origin=f"{root}/glance/{place}") for place in range(6)), name="Glance"
    )
    lookback = rrb.Horizontal(
        *(rrb.Spatial2DView(origin=f"{root}/lookback/{key}") for key in ("back", "now")),
        name="Look-back",
    )
    return rrb.Tabs(rrb.Horizontal(*fan, depth, name="Views"), glance, lookback)


def _text(rrb: Any, origin: str, name: str) -> Any:
    return rrb.TextDocumentView(origin=origin, name=name)


def _of(root: str) -> str:
    return f" · {root[1:].replace('_', ' ')}" if root else ""
