"""What the first view of the map shows."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.inspector.scene.cameras import Cameras, covered_share, framed_points, overview
from app.session.worker import Session
from c2nav_engine.geometry import Point
from tests.helpers import stage

FOV_RAD = math.radians(50.0)
METRES = st.floats(-30.0, 30.0)
POINTS = st.lists(st.tuples(METRES, st.floats(-0.5, 0.5), METRES), min_size=1, max_size=4)


def pictured(eye: Point, target: Point, points_m: list[Point], aspect: float) -> np.ndarray:
    """(n, 2) places in the picture, from −1 at the left and below to 1."""
    forward = np.subtract(target, eye)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, (0.0, 1.0, 0.0))
    right /= np.linalg.norm(right)
    rays = np.array(points_m) - eye
    across, up = rays @ right, rays @ np.cross(right, forward)
    depth = rays @ forward
    assert (depth > 0.0).all()
    half = math.tan(FOV_RAD / 2.0)
    return np.stack([across / (depth * half * aspect), up / (depth * half)], axis=1)


@given(POINTS, st.floats(0.5, 2.5), st.floats(0.0, 0.4))
def test_every_point_is_framed_in_what_nothing_covers(
    points_m: list[Point], aspect: float, covered: float
):
    eye, target = overview(points_m, aspect, covered=covered)
    places = pictured(eye, target, points_m, aspect)
    assert np.abs(places[:, 0]).max() <= 1.0
    assert places[:, 1].min() >= -1.0
    assert places[:, 1].max() <= 1.0 - 2.0 * covered


@pytest.mark.parametrize(("width_px", "height_px"), [(1100, 970), (460, 608)])
def test_a_longer_instruction_covers_more_but_never_most_of_the_map(width_px: int, height_px: int):
    snapshot = Session(stage.opened_live()).snapshot
    header = snapshot.story.header

    def covered(words: int) -> float:
        episode = replace(header.episode, instruction="go on " * words)
        story = replace(snapshot.story, header=replace(header, episode=episode))
        return covered_share(replace(snapshot, story=story), width_px, height_px)

    shares = [covered(words) for words in (1, 20, 60, 2000)]
    assert shares == sorted(shares)
    assert 0.0 < shares[0] < shares[2] <= shares[-1] == 0.4


@dataclass
class Camera:
    """A page's camera, as far as it is read and set here."""

    image_width: int
    image_height: int
    position: Any = (0.0, 0.0, 1.0)
    look_at: Any = (0.0, 0.0, 0.0)
    up_direction: Any = (0.0, 1.0, 0.0)
    fov: float = 1.0
    heard: list[Callable[[Any], None]] = field(default_factory=list)

    def on_update(self, callback: Callable[[Any], None]) -> None:
        self.heard.append(callback)

    def report(self, **seen: Any) -> None:
        """What a page says whenever its camera or its size changes."""
        for name, value in seen.items():
            setattr(self, name, value)
        self.position = np.asarray(self.position, np.float32).astype(np.float64)
        for callback in self.heard:
            callback(self)


@dataclass
class Client:
    """A page."""

    camera: Camera
    client_id: int = 7

    def atomic(self) -> nullcontext[None]:
        return nullcontext()


@pytest.fixture
def greeted() -> tuple[Camera, list[Point]]:
    """A page that connected while its map was small, and what must be in the picture."""
    session = Session(stage.opened_live())
    camera = Camera(64, 64)
    cameras = Cameras(cast("Any", None), lambda: session.snapshot)
    cameras.greet(cast("Any", Client(camera)))
    return camera, framed_points(session.snapshot)


@pytest.mark.parametrize(("width_px", "height_px"), [(772, 788), (400, 900), (1700, 968)])
def test_the_map_is_framed_anew_once_it_has_its_size(greeted, width_px: int, height_px: int):
    camera, points_m = greeted
    camera.report(image_width=width_px, image_height=height_px)
    places = pictured(camera.position, camera.look_at, points_m, width_px / height_px)
    assert np.abs(places).max() <= 1.0
    # Not from farther away than it must be: something comes close to an edge.
    assert np.abs(places).max() > 0.4


def test_a_camera_that_was_moved_stays_where_it_is(greeted):
    camera, _ = greeted
    camera.report(image_width=772, image_height=788)
    moved = np.add(camera.position, (0.0, -0.5, 0.0))
    camera.report(position=moved)
    camera.report(image_width=600, image_height=788)
    assert np.allclose(camera.position, moved)
