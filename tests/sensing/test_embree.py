"""The default renderer: light, filtering, cut-outs, rays, and views of the furnished house."""

from __future__ import annotations

import math
import os
from dataclasses import replace

import numpy as np
import pytest

from c2nav_engine.episodes.profile import LAVIRA, VLNCE
from c2nav_engine.geometry import Pinhole, Pose, world_from_camera
from c2nav_engine.sensing.caster import NO_TRIANGLE
from c2nav_engine.sensing.conformance import room_depth_m
from c2nav_engine.sensing.conformance_scenes import LEFT, Room, quad, textured_wall
from c2nav_engine.sensing.embree import EmbreeRenderer, Light, granted_threads
from c2nav_engine.world.load import load_scene
from c2nav_engine.world.scene import Material, Piece, scene_of

PINHOLE = Pinhole(32, 32, math.radians(90.0))
EYE = world_from_camera(Pose((0.0, 0.0, 0.0), 0.0), height_m=1.0)


def wall(material: Material, distance_m: float = 1.0, half_m: float = 1.0) -> Piece:
    d, h = -distance_m, half_m
    corners = [(-h, 1.0 - h, d), (h, 1.0 - h, d), (h, 1.0 + h, d), (-h, 1.0 + h, d)]
    return quad("wall", corners, material)


def view(*pieces: Piece, light: Light | None = None, pinhole: Pinhole = PINHOLE):
    renderer = EmbreeRenderer(scene_of("scene", pieces), light=light)
    return renderer.render([EYE], rgb=pinhole, depth=pinhole, near_m=0.0, far_m=50.0)[0]


def checker(size: int, light: int, dark: int, alpha: int = 255) -> np.ndarray:
    board = np.where(np.indices((size, size)).sum(axis=0) % 2, light, dark)
    return np.dstack([board, board, board, np.full_like(board, alpha)]).astype(np.uint8)


# ---------------------------------------------------------------- colour


@pytest.mark.parametrize("level", [0, 1, 60, 128, 200, 254, 255])
def test_an_unlit_texture_comes_back_as_it_was(level):
    texture = np.full((4, 4, 4), 255, np.uint8)
    texture[..., :3] = level
    rgb = view(wall(Material("grey", texture=texture, unlit=True))).rgb
    assert (np.abs(rgb.astype(int) - level) <= 1).all()


def test_colours_multiply_in_linear_light():
    half = Material("half", (0.5, 0.25, 1.0, 1.0), np.full((2, 2, 4), 255, np.uint8), unlit=True)
    colours = np.asarray([[255, 255, 188, 255]] * 4, np.uint8)
    rgb = view(replace(wall(half), colours=colours)).rgb[16, 16]
    # sRGB levels of one half, one quarter, and of the vertices' own blue.
    assert np.abs(rgb.astype(int) - [188, 137, 188]).max() <= 1


def test_vertex_colours_blend_across_a_triangle():
    colours = np.asarray([[255, 0, 0, 255], [255, 0, 0, 255], [0, 0, 255, 255], [0, 0, 255, 255]])
    piece = replace(wall(Material("plain", unlit=True)), colours=colours.astype(np.uint8))
    rgb = view(piece).rgb.astype(int)
    assert (np.diff(rgb[:, 16, 0]) >= 0).all()
    assert (np.diff(rgb[:, 16, 2]) <= 0).all()


def test_light_falls_on_both_sides_alike():
    ahead = wall(Material("white"))
    turned_over = replace(ahead, triangles=np.ascontiguousarray(ahead.triangles[:, ::-1]))
    assert np.array_equal(view(ahead).rgb, view(turned_over).rgb)


def test_a_surface_seen_head_on_is_brightest_and_none_is_black():
    rgb = view(wall(Material("white"), half_m=5.0)).rgb.astype(int)
    middle, corner = rgb[16, 16], rgb[0, 0]
    assert (middle >= corner).all()
    assert corner.min() > 100
    assert (view(wall(Material("white")), light=Light(0.0, 1.0, 0.0)).rgb[16, 16] >= 254).all()


def test_floors_are_lighter_than_ceilings():
    renderer = EmbreeRenderer(grey_room())
    eye = world_from_camera(Pose((0.0, 0.0, 0.0), 0.0), height_m=1.25)
    rgb = renderer.render([eye], rgb=PINHOLE, depth=PINHOLE, near_m=0.0, far_m=50.0)[0].rgb
    assert (rgb[-1, 16] > rgb[0, 16]).all()


def grey_room():
    room = Room().scene()
    grey = Material("grey", (0.5, 0.5, 0.5, 1.0))
    return replace(room, materials=tuple(grey for _ in room.materials))


def test_views_are_cast_one_by_one_and_are_what_each_is_alone(monkeypatch: pytest.MonkeyPatch):
    renderer = EmbreeRenderer(grey_room())
    eyes = [
        world_from_camera(Pose((0.0, 0.0, 0.0), 0.0), height_m=1.0, offset_rad=k) for k in range(5)
    ]
    counts: list[int] = []
    cast = renderer.caster.cast
    monkeypatch.setattr(
        renderer.caster, "cast", lambda rays: (counts.append(len(rays)), cast(rays))[1]
    )

    def seen(eyes: list[np.ndarray]) -> list[bytes]:
        images = renderer.render(eyes, rgb=PINHOLE, depth=PINHOLE, near_m=0.0, far_m=50.0)
        return [image.rgb.tobytes() + image.depth_m.tobytes() for image in images]

    together = seen(eyes)
    # What a look takes of memory, a process keeps: a ring takes no more than a view.
    assert counts == [32 * 32] * len(eyes)
    assert len(set(together)) == len(eyes)
    assert together == [seen([eye])[0] for eye in eyes]


def test_nothing_hit_shows_the_background():
    image = view(wall(Material("white"), half_m=0.2), light=Light(background=(1, 2, 3)))
    assert image.rgb[0, 0].tolist() == [1, 2, 3]
    assert image.depth_m[0, 0] == 0.0


# ---------------------------------------------------------------- textures


def test_a_fine_pattern_far_away_turns_to_its_mean():
    material = Material("board", texture=checker(512, 255, 0), unlit=True)
    rgb = view(wall(material, distance_m=4.0, half_m=4.0)).rgb.astype(int)
    # Half the light of white, whichever texel a ray happens to meet.
    assert np.abs(rgb - 188).max() <= 2


def test_a_pattern_close_by_stays_sharp():
    material = Material("board", texture=checker(4, 255, 0), unlit=True)
    rgb = view(wall(material)).rgb.astype(int)
    # Eight pixels a texel: near the middle of each, its neighbours hardly count.
    assert rgb[3:5, 3:5].max() < 100
    assert rgb[3:5, 11:13].min() > 240


def test_texture_coordinates_repeat():
    piece = wall(Material("quarters", texture=textured_wall().materials[0].texture, unlit=True))
    assert piece.uvs is not None
    moved = replace(piece, uvs=piece.uvs + np.asarray([3.0, -7.0], np.float32))
    assert np.array_equal(view(piece).rgb, view(moved).rgb)


@pytest.mark.parametrize("shape", [(1, 1), (1, 7), (5, 3), (208, 512)])
def test_textures_of_any_size_are_sampled_inside(shape):
    texture = np.full((*shape, 4), 255, np.uint8)
    texture[..., :3] = 77
    material = Material("odd", texture=texture, unlit=True)
    for distance_m in (0.5, 3.0, 30.0):
        rgb = view(wall(material, distance_m, half_m=2.0 * distance_m)).rgb.astype(int)
        assert np.abs(rgb - 77).max() <= 1


def test_degenerate_triangles_do_no_harm():
    piece = wall(Material("board", texture=checker(8, 255, 0)))
    assert piece.uvs is not None
    flat = Piece(
        "flat",
        piece.material,
        np.zeros((3, 3), np.float32),
        np.asarray([[0, 1, 2]], np.int32),
        np.zeros((1, 3, 2), np.float32),
    )
    assert np.array_equal(view(piece, flat).rgb, view(piece).rgb)


# ---------------------------------------------------------------- cut-outs


def test_rays_pass_where_alpha_says_nothing_is_there():
    texture = np.full((2, 2, 4), 255, np.uint8)
    texture[0, :, 3] = 0
    leaves = Material("leaves", texture=texture, cutout_alpha=0.5, unlit=True)
    behind = Material("behind", (*LEFT, 1.0), unlit=True)
    image = view(wall(leaves), wall(behind, distance_m=2.0, half_m=2.0))
    # Row 0 is the top of the picture, and nearest texels decide well inside each half.
    assert image.rgb[8, 16].tolist() == [255, 0, 0]
    assert image.depth_m[8, 16] == pytest.approx(2.0, abs=1e-3)
    assert image.rgb[24, 16].tolist() == [255, 255, 255]
    assert image.depth_m[24, 16] == pytest.approx(1.0)


def test_alpha_is_ignored_on_opaque_surfaces():
    texture = np.zeros((2, 2, 4), np.uint8)
    texture[..., :3] = 255
    image = view(wall(Material("opaque", texture=texture, unlit=True)))
    assert (image.rgb == 255).all()
    assert (image.depth_m > 0.0).all()


def test_several_panes_let_a_ray_through():
    pane = Material("pane", (1.0, 1.0, 1.0, 0.2), cutout_alpha=0.5)
    behind = Material("behind", unlit=True)
    panes = [wall(pane, distance_m=1.0 + 0.1 * k) for k in range(5)]
    image = view(*panes, wall(behind, distance_m=3.0, half_m=3.0))
    assert np.allclose(image.depth_m, 3.0, atol=2e-3)


# ---------------------------------------------------------------- rays and occlusion


def test_casting_tells_where_what_and_which_way():
    renderer = EmbreeRenderer(Room().scene())
    origins_m = np.asarray([[0.0, 1.0, 0.0]] * 3)
    directions = np.asarray([[0.0, -1.0, 0.0], [-2.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
    hits = renderer.cast(origins_m, directions)
    assert hits.t_hit.tolist() == pytest.approx([1.0, 1.0, 3.0])
    names = [part.name for part in Room().scene().parts]
    parts = Room().scene().part_of_triangle
    assert [names[parts[t]] for t in hits.triangles] == ["floor", "left", "ahead"]
    assert np.allclose(np.abs(hits.normals), np.abs([[0, 1, 0], [1, 0, 0], [0, 0, 1]]))


def test_a_miss_is_marked():
    hits = EmbreeRenderer(textured_wall()).cast(np.zeros((1, 3)), np.asarray([[0.0, 0.0, 1.0]]))
    assert hits.triangles.tolist() == [NO_TRIANGLE]
    assert np.isinf(hits.t_hit).all()


def test_a_segment_is_clear_up_to_the_surface_it_ends_on():
    renderer = EmbreeRenderer(textured_wall(distance_m=1.0))
    eye = np.asarray([[0.0, 1.0, 0.0]] * 5)
    points_m = np.asarray(
        [
            [0.0, 1.0, -0.5],  # in front of the wall
            [0.3, 0.7, -1.0],  # on it
            [0.0, 1.0, -1.5],  # behind it
            [0.0, 1.0, 3.0],  # the other way
            [0.0, 1.0, 0.0],  # the eye itself
        ]
    )
    assert renderer.segment_clear(eye, points_m).tolist() == [True, True, False, True, True]


def test_visibility_agrees_with_the_depth_picture():
    room = Room()
    renderer = EmbreeRenderer(room.scene())
    matrix = world_from_camera(Pose((0.5, 0.0, 0.3), 0.7), height_m=1.25)
    rays = PINHOLE.ray_directions().reshape(-1, 3) @ matrix[:3, :3].T
    depths_m = room_depth_m(room, matrix, PINHOLE).reshape(-1, 1)
    eye = np.broadcast_to(matrix[:3, 3], rays.shape)
    assert renderer.segment_clear(eye, eye + rays * depths_m).all()
    assert not renderer.segment_clear(eye, eye + rays * (depths_m + 0.1)).any()


# ---------------------------------------------------------------- the furnished house


@pytest.fixture(scope="module")
def house(shared):
    return EmbreeRenderer(load_scene(shared / "scenes" / "house" / "aws_small_house_yup.glb"))


BEDROOM = Pose((-6.525, 0.0, 0.575), -math.pi / 2.0)


def rendered(renderer, profile, *offsets_rad):
    return renderer.render(
        [
            world_from_camera(BEDROOM, height_m=profile.camera_height_m, offset_rad=offset_rad)
            for offset_rad in offsets_rad
        ],
        rgb=profile.rgb,
        depth=profile.depth,
        near_m=profile.depth_near_m,
        far_m=profile.depth_far_m,
    )


def test_the_house_has_wood_below_and_sky_above(house):
    rgb = rendered(house, VLNCE, 0.0)[0].rgb.astype(int)
    floor, sky = rgb[200:, 60:160].mean(axis=(0, 1)), rgb[:40].mean(axis=(0, 1))
    assert floor[0] > floor[2] + 30
    assert sky[2] > sky[0]
    assert (rgb.max(axis=2) < 12).mean() < 0.02


def test_the_floor_lies_at_camera_height(house):
    image = rendered(house, VLNCE, 0.0)[0]
    rows = np.arange(200, 256)
    expected_m = VLNCE.camera_height_m * VLNCE.depth.focal_px / (rows + 0.5 - 128.0)
    assert np.allclose(image.depth_m[rows, 128], expected_m, rtol=5e-3)


def test_a_renderer_gives_the_same_bytes_whatever_its_threads(house, shared):
    scene = load_scene(shared / "scenes" / "house" / "aws_small_house_yup.glb")
    single = EmbreeRenderer(scene, threads=1)
    for mine, other in zip(
        rendered(house, VLNCE, 0.0, 0.8), rendered(single, VLNCE, 0.0, 0.8), strict=True
    ):
        assert np.array_equal(mine.rgb, other.rgb)
        assert np.array_equal(mine.depth_m, other.depth_m)


def test_equal_pinholes_share_their_rays(house):
    image = rendered(house, LAVIRA, 0.0)[0]
    assert image.rgb.shape == (480, 640, 3)
    assert image.depth_m.shape == (480, 640)
    returned = image.depth_m[image.depth_m > 0.0]
    assert returned.min() >= LAVIRA.depth_near_m
    assert returned.max() <= LAVIRA.depth_far_m
    apart = house.render(
        [image.world_from_camera],
        rgb=LAVIRA.rgb,
        depth=VLNCE.depth,
        near_m=0.1,
        far_m=5.0,
    )[0]
    assert np.array_equal(apart.rgb, image.rgb)


def test_read_only_scenes_render_alike():
    scene = textured_wall()
    before = EmbreeRenderer(scene).render(
        [EYE], rgb=PINHOLE, depth=PINHOLE, near_m=0.0, far_m=50.0
    )[0]
    for array in (scene.vertices_m, scene.triangles, scene.uvs):
        assert array is not None
        array.flags.writeable = False
    after = EmbreeRenderer(scene).render([EYE], rgb=PINHOLE, depth=PINHOLE, near_m=0.0, far_m=50.0)[
        0
    ]
    assert np.array_equal(before.rgb, after.rgb)
    assert np.array_equal(before.depth_m, after.depth_m)


@pytest.mark.parametrize(
    ("granted", "expected"), [("3", 3), ("0", None), ("", None), ("4,2", None)]
)
def test_a_worker_uses_the_threads_it_was_granted(monkeypatch, granted, expected):
    monkeypatch.setenv("OMP_NUM_THREADS", granted)
    assert granted_threads() == (expected or os.cpu_count())
