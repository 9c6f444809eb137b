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

from app.inspector.scene.cameras import Cameras, covered_share, framed_points, in_view, overview
from app.session.snapshot import ForkOffer, PlaceAnswer, Snapshot
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


@given(POINTS, POINTS, st.floats(0.5, 2.5), st.floats(0.0, 0.4))
def test_in_view_is_what_the_picture_shows_where_nothing_covers(
    framed_m: list[Point], points_m: list[Point], aspect: float, covered: float
):
    eye, target = overview(framed_m, aspect, covered=covered)
    assert in_view(framed_m, eye, aspect, covered=covered)
    if (np.subtract(points_m, eye) @ np.subtract(target, eye) <= 1e-6).any():
        assert not in_view(points_m, eye, aspect, covered=covered)
        return
    across, up = pictured(eye, target, points_m, aspect).T
    margin = np.minimum(1.0 - np.abs(across), np.minimum(up + 1.0, 1.0 - 2.0 * covered - up)).min()
    if abs(margin) > 1e-6:
        assert in_view(points_m, eye, aspect, covered=covered) == (margin > 0.0)


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


def test_cards_below_the_instruction_are_covered_map_too():
    bare = Session(stage.opened_live()).snapshot
    offered = replace(bare, offer=ForkOffer(3, 17, 51, 35.0, 0.4))
    both = replace(offered, place=PlaceAnswer((0.0, 0.0, 0.0), (), {}, "by the scene"))
    shares = [covered_share(snapshot, 1100, 970) for snapshot in (bare, offered, both)]
    assert shares[0] < shares[1] < shares[2] < 0.4


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

    def __setattr__(self, name: str, value: Any) -> None:
        object.__setattr__(self, name, np.array(value) if name == "position" else value)

    def on_update(self, callback: Callable[[Any], None]) -> None:
        self.heard.append(callback)

    def report(self, **seen: Any) -> None:
        """What a page says whenever its camera or its size changes."""
        for name, value in seen.items():
            setattr(self, name, value)
        self.position = self.position.astype(np.float32).astype(np.float64)
        for callback in self.heard:
            callback(self)


@dataclass
class Client:
    """A page."""

    camera: Camera
    client_id: int = 7

    def atomic(self) -> nullcontext[None]:
        return nullcontext()


@dataclass
class Pages:
    """A server with one page, which connected while its map was small."""

    here: Snapshot = field(default_factory=lambda: Session(stage.opened_live()).snapshot)
    camera: Camera = field(default_factory=lambda: Camera(64, 64))

    def __post_init__(self) -> None:
        self._client = Client(self.camera)
        self._cameras = Cameras(cast("Any", self), lambda: self.here)
        self._cameras.greet(cast("Any", self._client))
        self.step_to(0.0)

    def get_clients(self) -> dict[int, Client]:
        return {7: self._client}

    def step_to(self, east_m: float) -> list[Point]:
        """Show the body so far from where it was; gives what should be in the picture."""
        track = self.here.story.track
        body = track.footsteps[self.here.here.step]
        x, y, z = body.pose.position_m
        moved = replace(body, pose=replace(body.pose, position_m=(x + east_m, y, z)))
        story = replace(self.here.story, track=replace(track, footsteps=(moved,)))
        self.here = replace(self.here, story=story)
        self._cameras.update(self.here)
        return framed_points(self.here)


@pytest.fixture
def greeted() -> tuple[Camera, list[Point]]:
    """Such a page, and what must be in the picture."""
    pages = Pages()
    return pages.camera, framed_points(pages.here)


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


def test_a_body_that_walks_out_of_the_view_takes_an_unmoved_camera_along():
    pages = Pages()
    camera = pages.camera
    camera.report(image_width=772, image_height=788)
    at_first = tuple(camera.position)
    pages.step_to(0.2)
    assert tuple(camera.position) == at_first
    points_m = pages.step_to(12.0)
    assert np.abs(pictured(camera.position, camera.look_at, points_m, 772 / 788)).max() <= 1.0
    moved = np.add(camera.position, (0.0, -0.5, 0.0))
    camera.report(position=moved)
    pages.step_to(30.0)
    assert np.allclose(camera.position, moved)
