"""The way walked, by leg; the recorded rest; where each leg began."""

from __future__ import annotations

import math

import viser

from app.inspector.scene import frames
from app.inspector.scene.colours import BLUE, GREY, SLATE, Rgb
from app.inspector.scene.layer import Group
from app.session.snapshot import Snapshot
from app.session.story import Story
from c2nav_engine.geometry import Point

_WIDTH_PX = 5.0

_SAME_M = 1e-3
"""Ways nearer than this to each other are one line."""


class Trajectory:
    """Active leg blue, earlier legs slate, what comes later dashed grey; each leg's number.

    The way of a fork's parent is dashed too, from where the fork leaves it.
    """

    def __init__(self, scene: viser.SceneApi) -> None:
        """Draw below /way."""
        self._scene = scene
        self._way = Group(scene, "/way")
        self._rest = Group(scene, "/rest")

    def update(self, snapshot: Snapshot) -> None:
        """Follow the place where one stands."""
        story, step = snapshot.story, snapshot.here.step
        shown = "trajectory" in snapshot.view.layers
        leg = snapshot.decision.facts.leg if snapshot.decision else 0
        branch = snapshot.branch.branch_id
        self._way.draw(
            (branch, step, leg) if shown else None, lambda: self._draw_way(story, step, leg)
        )
        parent = snapshot.parent
        ahead = story.track.last_step > step or parent is not None
        self._rest.draw(
            (branch, step, story.track.last_step, parent and parent.length)
            if shown and ahead
            else None,
            lambda: self._draw_rest(story, parent, step),
        )

    def _draw_way(self, story: Story, step: int, leg: int) -> list[viser.SceneNodeHandle]:
        nodes: list[viser.SceneNodeHandle] = []
        for index, start, stop in _legs_of(story, step):
            points = _points(story, start, stop)
            nodes.extend(self._labelled(points[0], index))
            if len(points) > 1:
                colour = BLUE if index == leg else SLATE
                nodes.append(self._line(f"/way/leg{index}_{start}", points, colour))
        return nodes

    def _labelled(self, point_m: Point, leg: int) -> list[viser.SceneNodeHandle]:
        return [
            self._scene.add_label(
                f"/way/number{leg}",
                str(leg + 1),
                position=frames.raised(point_m, 0.1),
                anchor="center-center",
                font_screen_scale=0.9,
            )
        ]

    def _line(self, name: str, points_m: list[Point], colour: Rgb) -> viser.SceneNodeHandle:
        return self._scene.add_line_segments(
            name,
            frames.polyline(points_m),
            colour,
            thickness=_WIDTH_PX,
            thickness_units="screen",
        )

    def _draw_rest(
        self, story: Story, parent: Story | None, step: int
    ) -> list[viser.SceneNodeHandle]:
        nodes: list[viser.SceneNodeHandle] = []
        left = 0 if parent is None else leaves_at(story, parent)
        for name, rest, start in (("own", story, step), ("parent", parent, left)):
            if rest is None or rest.track.last_step <= start:
                continue
            points = _points(rest, start, rest.track.last_step)
            segments = frames.dashes(points, dash_m=0.16, gap_m=0.12)
            if len(segments):
                nodes.append(
                    self._scene.add_line_segments(
                        f"/rest/{name}", segments, GREY, thickness=3.0, thickness_units="screen"
                    )
                )
        return nodes


def leaves_at(story: Story, parent: Story) -> int:
    """The last step at which a fork still stands where its parent stood."""
    shared = 0
    ways = zip(story.track.footsteps, parent.track.footsteps, strict=False)
    for step, (own, other) in enumerate(ways):
        if math.dist(own.pose.position_m, other.pose.position_m) > _SAME_M:
            break
        shared = step
    return shared


def _points(story: Story, start: int, stop: int) -> list[Point]:
    return [f.pose.position_m for f in story.track.footsteps[start : stop + 1]]


def _legs_of(story: Story, step: int) -> list[tuple[int, int, int]]:
    """(leg, first step, last step) up to a step, in order; a leg's end is the next one's start."""
    starts: list[tuple[int, int]] = []
    for decision in story.decisions:
        if decision.step <= step and (not starts or starts[-1][0] != decision.facts.leg):
            starts.append((decision.facts.leg, decision.step))
    starts = starts or [(0, 0)]
    starts[0] = (starts[0][0], 0)
    stops = [start for _, start in starts[1:]] + [step]
    return [(leg, start, stop) for (leg, start), stop in zip(starts, stops, strict=True)]
