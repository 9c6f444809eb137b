"""The way on the map: a fork's parent is a ghost only where it went elsewhere."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from app.inspector.scene.trajectory import Trajectory, leaves_at
from app.session.snapshot import Snapshot
from app.session.story import Story
from app.session.worker import Session
from c2nav_engine.geometry import Pose
from tests.helpers import stage


@pytest.fixture(scope="module")
def whole() -> Snapshot:
    snapshot = Session(stage.opened_recording()).snapshot
    return replace(snapshot, stop=len(snapshot.story.stops) - 1)


def turned_off(story: Story, step: int) -> Story:
    """The same way up to a step, and then another one."""
    feet = tuple(
        foot
        if number <= step
        else replace(foot, pose=Pose(foot.pose.turned(1.0).ahead(2.0), foot.pose.yaw_rad))
        for number, foot in enumerate(story.track.footsteps)
    )
    return replace(story, track=replace(story.track, footsteps=feet))


def drawn(snapshot: Snapshot) -> dict[str, np.ndarray]:
    lines: dict[str, np.ndarray] = {}
    scene = SimpleNamespace(
        add_line_segments=lambda name, points, *_, **__: (
            lines.update({name: points}) or SimpleNamespace(name=name)
        ),
        add_label=lambda name, *_, **__: SimpleNamespace(name=name),
    )
    Trajectory(cast("Any", scene)).update(snapshot)
    return lines


@pytest.mark.parametrize("step", [0, 5, 20])
def test_a_parents_way_is_dashed_from_where_the_fork_leaves_it(whole: Snapshot, step: int):
    parent = turned_off(whole.story, step)
    assert leaves_at(whole.story, parent) == step
    x, _, z = whole.story.track.footsteps[step].pose.position_m
    ghost = drawn(replace(whole, parent=parent))["/rest/parent"]
    assert ghost[0, 0, [0, 2]] == pytest.approx((x, z), abs=1e-5)


def test_a_parent_that_went_the_same_way_is_no_ghost(whole: Snapshot):
    assert "/rest/parent" not in drawn(replace(whole, parent=whole.story))
