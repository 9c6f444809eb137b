from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from app.session.assessing import Assessor
from app.session.placing import DepthSight, SceneSight, looks_of, place_of, point_at
from app.session.snapshot import suspects_of
from app.session.story import Story, story_of
from c2nav_engine.contract.prompt import Ranked
from c2nav_engine.contract.question import Question, Slot
from c2nav_engine.geometry import Point, Pose, world_from_camera, wrap_rad
from c2nav_engine.metrics.off_path import off_path_m
from c2nav_engine.sensing.encode import depth_png
from c2nav_engine.world.scene import Material, Piece, Scene, scene_of
from tests.helpers import stage
from tests.helpers.meshes import slab, surface_of

GREY = Material("grey")


# ---------------------------------------------------------------- suspects


@pytest.fixture(scope="module")
def surface():
    return surface_of([slab(-9.0, -6.0, 9.0, 6.0)])


def toward_goal(question: Question, pose: Pose) -> list[str]:
    """Keys by how little they turn away from the goal; other slots as scripted."""
    if question.slot is not Slot.SEEING:
        return list(stage.scripted_answer(question).queries[0].outcome.keys)  # type: ignore[union-attr]
    bearing_rad = pose.bearing_rad(stage.PATH[-1])
    return sorted(question.keys, key=lambda k: abs(wrap_rad(stage.OFFSETS[k] - bearing_rad)))


@pytest.mark.parametrize("episode", range(20))
def test_a_planted_wrong_answer_stands_first(surface, episode: int):
    planted = 1 + 2 * (episode % 4)  # all three views are offered at the odd elections
    asked: list[int] = []

    def answer(question: Question, pose: Pose) -> Ranked:
        best = toward_goal(question, pose)
        if question.slot is Slot.SEEING:
            asked.append(len(asked))
            if asked[-1] == planted:
                best = best[::-1]
        return stage.ranked_as(question, best)

    run = stage.live_run(11 + episode // 4, answer=answer)
    while run.pending is not None:
        run.advance()
    story = story_of(run.header, run.exchanges, pending=None, footer=run.footer)
    found = Assessor(run.header, lambda: surface).assess(story, ())
    seeing = [d.number for d in story.decisions if d.slot is Slot.SEEING]
    assert suspects_of(found)[0].decision == seeing[planted]


def test_only_new_decisions_are_measured(surface):
    run = stage.finished_run(8)
    story = story_of(run.header, run.exchanges, pending=None, footer=run.footer)
    assessor = Assessor(run.header, lambda: surface)
    first = assessor.assess(story, ())
    assert set(first) == {d.number for d in story.decisions}
    assert assessor.assess(story, first) == {}


def test_distance_from_a_path_is_to_its_nearest_segment():
    path = ((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (4.0, 0.0, 4.0))
    assert off_path_m((2.0, 1.0, 1.5), path) == pytest.approx(1.5)
    assert off_path_m((5.0, 0.0, 2.0), path) == pytest.approx(1.0)
    assert off_path_m((-3.0, 0.0, 4.0), path) == pytest.approx(5.0)
    assert off_path_m((0.0, 0.0, 0.0), ()) is None


# ---------------------------------------------------------------- places


def panel(x: float, z0: float, z1: float, top_m: float) -> Piece:
    """An upright rectangle across the way."""
    vertices = np.array(
        [[x, 0.0, z0], [x, 0.0, z1], [x, top_m, z1], [x, top_m, z0]], dtype=np.float32
    )
    return Piece("panel", GREY, vertices, np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32))


PANEL_X = -2.0


@pytest.fixture(scope="module")
def scene() -> Scene:
    return scene_of("panel", [panel(PANEL_X, -1.0, 1.0, 2.0)])


@pytest.fixture(scope="module")
def story() -> Story:
    run = stage.finished_run(14)
    return story_of(run.header, run.exchanges, pending=None, footer=run.footer)


LANDMARKS: list[Point] = [(2.0, 1.0, 0.5), (-4.0, 1.2, 3.0), (-9.0, 1.0, 0.5), (1.0, 0.2, -3.0)]


def expected(story: Story, point: Point) -> list[str]:
    """By another way: bearing and elevation of each view, and a crossing of the panel's plane."""
    profile = story.header.profile
    half = profile.rgb.hfov_rad / 2.0
    statuses: list[str] = []
    for look in looks_of(story):
        eye = np.array(look.eye_m)
        inside = []
        for view in look.views:
            bearing = wrap_rad(look.glimpse.pose.bearing_rad(point) - view.offset_rad)
            away = math.hypot(point[0] - eye[0], point[2] - eye[2]) * math.cos(bearing)
            rise = abs(point[1] - eye[1])
            if abs(bearing) < half and rise < away * math.tan(half):
                inside.append(view)
        part = (PANEL_X - eye[0]) / (point[0] - eye[0])
        across = eye + part * (np.array(point) - eye)
        blocked = 0.0 < part < 1.0 and abs(across[2]) <= 1.0 and 0.0 <= across[1] <= 2.0
        if not inside:
            statuses.append("away")
        elif blocked:
            statuses.append("hidden")
        else:
            statuses.append("vetoed" if all(v.vetoed for v in inside) else "seen")
    return statuses


@pytest.mark.parametrize("point", LANDMARKS)
def test_a_landmarks_lane_equals_an_independent_projection(
    story: Story, scene: Scene, point: Point
):
    answer = place_of(story, SceneSight(scene), point)
    assert [s.status for s in answer.sightings] == expected(story, point)


def test_all_statuses_occur(story: Story):
    found = {status for point in LANDMARKS for status in expected(story, point)}
    assert {"seen", "hidden", "away"} <= found


def test_a_pixel_leads_back_to_its_point(story: Story, scene: Scene):
    sight = SceneSight(scene)
    point = (PANEL_X, 1.1, 0.4)
    answer = place_of(story, sight, point)
    assert answer.marks
    for sha256, (column, row) in answer.marks.items():
        back = point_at(story, sight, sha256, column=column, row=row)
        assert back is not None
        assert np.allclose(back, point, atol=0.02)


def test_without_the_scene_recorded_depth_serves_and_says_so(story: Story):
    answer = place_of(story, DepthSight(story.header.profile), LANDMARKS[0])
    assert "depth" in answer.basis
    assert {s.status for s in answer.sightings} <= {"away", "unsure"}  # the play keeps no depth


@pytest.mark.parametrize("shape", [(16, 16), (16, 24), (256, 256)])
def test_depth_that_was_kept_coarser_is_read_where_the_point_lies(story: Story, shape):
    profile, look = story.header.profile, looks_of(story)[0]
    depth_m = np.full(shape, 9.0, np.float32)
    depth_m[:, : shape[1] // 2] = 2.0  # a wall stands on the left
    kept = replace(look, glimpse=replace(look.glimpse, depth_png=depth_png(depth_m)))
    pose = look.glimpse.pose
    ahead = Pose(pose.ahead(4.0), pose.yaw_rad)
    for turn_rad, clear in ((math.pi / 2.0, False), (-math.pi / 2.0, True)):
        x, y, z = ahead.turned(turn_rad).ahead(1.0)
        point = (x, y + profile.camera_height_m, z)
        assert DepthSight(profile).clear([kept], point) == [clear]


def test_marks_lie_where_the_camera_sees_the_point(story: Story, scene: Scene):
    point = LANDMARKS[0]
    answer = place_of(story, SceneSight(scene), point)
    profile = story.header.profile
    for look in looks_of(story):
        for view in look.views:
            if view.sha256 not in answer.marks:
                continue
            world = world_from_camera(
                look.glimpse.pose, height_m=profile.camera_height_m, offset_rad=view.offset_rad
            )
            column, row = answer.marks[view.sha256]
            pixel = np.array([[column * profile.rgb.width_px, row * profile.rgb.height_px]])
            ray = world[:3, :3] @ profile.rgb.unproject(pixel, np.ones(1))[0]
            toward = np.array(point) - world[:3, 3]
            cosine = ray @ toward / np.linalg.norm(ray) / np.linalg.norm(toward)
            assert cosine > 0.9999
