"""What every renderer must do, checked against scenes whose pictures are known in closed form.

A new renderer passes `check_renderer(make)`, where `make` builds one for a scene. Nothing is
compared with stored pictures: depths follow the laws of the pinhole, colours stand where they
must. `Tolerance` says how exact a renderer is; one with lights of its own is judged by hue.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, UInt8

from c2nav_engine.errors import InternalError
from c2nav_engine.geometry import Pinhole, Pose, world_from_camera
from c2nav_engine.sensing.conformance_scenes import (
    AHEAD,
    BEHIND,
    CEILING,
    CORNER_COLOURS,
    FLOOR,
    LEFT,
    RIGHT,
    Colour,
    Room,
    textured_wall,
)
from c2nav_engine.sensing.renderer import Image, Renderer
from c2nav_engine.world.scene import Scene

Make = Callable[[Scene], Renderer]

RGB = Pinhole(64, 48, math.radians(120.0))
DEPTH = Pinhole(40, 40, math.radians(90.0))
EYE_M = 1.25
ORIGIN = Pose((0.0, 0.0, 0.0), 0.0)


@dataclass(frozen=True, slots=True)
class Tolerance:
    """How exact a renderer is.

    Attributes:
        depth: Largest error of a depth, as a fraction of it.
        level: Largest error of an unlit colour in 8-bit levels; None judges hue alone.
    """

    depth: float = 1e-5
    level: int | None = 1


EXACT = Tolerance()


def check_renderer(make: Make, tolerance: Tolerance = EXACT) -> None:
    """Run every check; raises `InternalError` naming the first that fails."""
    for check in CHECKS:
        check(make, tolerance)


def check_depth_follows_the_walls(make: Make, tolerance: Tolerance) -> None:
    """Every pixel's depth is the one of the room's planes, from several places and headings."""
    room = Room()
    renderer = make(room.scene())
    for pose in (ORIGIN, Pose((0.7, 0.0, -1.1), math.radians(35.0)), Pose((-1.0, 0.2, 2.0), -2.5)):
        matrix = world_from_camera(pose, height_m=EYE_M)
        image = _view(renderer, matrix)
        expected_m = room_depth_m(room, matrix, DEPTH)
        error = float(np.max(np.abs(image.depth_m - expected_m) / expected_m))
        _require(error <= tolerance.depth, f"depth within {tolerance.depth:g}, off by {error:g}")


def check_left_is_left_and_floor_is_down(make: Make, tolerance: Tolerance) -> None:
    """Each wall stands where it must, seen from the middle under all four headings."""
    renderer = make(Room().scene())
    walls = [AHEAD, LEFT, BEHIND, RIGHT]
    for quarter in range(4):
        matrix = world_from_camera(ORIGIN.turned(quarter * math.pi / 2.0), height_m=EYE_M)
        rgb = _view(renderer, matrix).rgb
        facing, left, right = walls[quarter], walls[(quarter + 1) % 4], walls[(quarter + 3) % 4]
        _require_colour(rgb, (0.5, 0.5), facing, tolerance)
        _require_colour(rgb, (0.5, 0.01), left, tolerance)
        _require_colour(rgb, (0.5, 0.99), right, tolerance)
        _require_colour(rgb, (0.99, 0.5), FLOOR, tolerance)
        _require_colour(rgb, (0.01, 0.5), CEILING, tolerance)


def check_texture_stands_upright(make: Make, tolerance: Tolerance) -> None:
    """The four quarters of a textured wall show their own colours, none mirrored or turned."""
    matrix = world_from_camera(ORIGIN, height_m=1.0)
    rgb = _view(make(textured_wall()), matrix).rgb
    bottom_left, bottom_right, top_right, top_left = CORNER_COLOURS
    _require_colour(rgb, (0.75, 0.25), bottom_left, tolerance)
    _require_colour(rgb, (0.75, 0.75), bottom_right, tolerance)
    _require_colour(rgb, (0.25, 0.75), top_right, tolerance)
    _require_colour(rgb, (0.25, 0.25), top_left, tolerance)


def check_range_leaves_holes(make: Make, tolerance: Tolerance) -> None:
    """Depth is 0 exactly where the surface lies outside [near, far], or where there is none."""
    room = Room()
    matrix = world_from_camera(ORIGIN, height_m=EYE_M)
    expected_m = room_depth_m(room, matrix, DEPTH)
    near_m, far_m = 1.5, 2.5
    image = _view(make(room.scene()), matrix, near_m=near_m, far_m=far_m)
    margin = 2.0 * tolerance.depth
    inside = (expected_m > near_m * (1.0 + margin)) & (expected_m < far_m * (1.0 - margin))
    outside = (expected_m < near_m * (1.0 - margin)) | (expected_m > far_m * (1.0 + margin))
    _require(bool(inside.any() and outside.any()), "a range that cuts through the room")
    _require(bool((image.depth_m[inside] > 0.0).all()), "a depth wherever it is in range")
    _require(bool((image.depth_m[outside] == 0.0).all()), "no depth wherever it is out of range")
    away = world_from_camera(ORIGIN.turned(math.pi), height_m=1.0)
    nothing = _view(make(textured_wall()), away)
    _require(not nothing.depth_m.any(), "no depth where there is no surface")


def check_same_pose_same_bytes(make: Make, tolerance: Tolerance) -> None:
    """Rendering twice, alone or among other views, gives the same bytes."""
    del tolerance
    renderer = make(Room().scene())
    matrices = [world_from_camera(ORIGIN.turned(0.4 * k), height_m=EYE_M) for k in range(3)]
    together = _views(renderer, matrices)
    for matrix, image in zip(matrices, together, strict=True):
        alone = _view(renderer, matrix)
        same = np.array_equal(alone.rgb, image.rgb) and np.array_equal(alone.depth_m, image.depth_m)
        _require(same, "the same bytes for a pose, alone or among other views")
        _require(np.array_equal(image.world_from_camera, matrix), "the pose that was asked for")


def check_a_depth_grid_is_the_pictures(make: Make, tolerance: Tolerance) -> None:
    """Depth at a stride is the whole picture's, row by row and column by column; colour stays."""
    del tolerance
    renderer = make(Room().scene())
    matrix = world_from_camera(ORIGIN.turned(0.4), height_m=EYE_M)
    for rgb, depth in ((RGB, DEPTH), (DEPTH, DEPTH)):
        whole, thinned = (
            renderer.render(
                [matrix], rgb=rgb, depth=depth, near_m=0.0, far_m=100.0, depth_stride=stride
            )[0]
            for stride in (1, 3)
        )
        same = np.array_equal(thinned.depth_m, whole.depth_m[::3, ::3])
        _require(same, "a depth grid with the whole picture's depths")
        _require(np.array_equal(thinned.rgb, whole.rgb), "the same colours beside a depth grid")


def check_sizes_and_empty_calls(make: Make, tolerance: Tolerance) -> None:
    """Pictures have their pinholes' sizes, equal pinholes included; no camera, no picture."""
    del tolerance
    renderer = make(Room().scene())
    matrix = world_from_camera(ORIGIN, height_m=EYE_M)
    _require(_views(renderer, []) == [], "no picture for no camera")
    for rgb, depth in ((RGB, DEPTH), (DEPTH, DEPTH)):
        image = renderer.render([matrix], rgb=rgb, depth=depth, near_m=0.0, far_m=100.0)[0]
        sizes = (image.rgb.shape, image.depth_m.shape)
        wanted = ((rgb.height_px, rgb.width_px, 3), (depth.height_px, depth.width_px))
        _require(sizes == wanted, f"pictures of {wanted}, came {sizes}")


CHECKS: tuple[Callable[[Make, Tolerance], None], ...] = (
    check_depth_follows_the_walls,
    check_left_is_left_and_floor_is_down,
    check_texture_stands_upright,
    check_range_leaves_holes,
    check_same_pose_same_bytes,
    check_a_depth_grid_is_the_pictures,
    check_sizes_and_empty_calls,
)


def room_depth_m(
    room: Room, matrix: Float[np.ndarray, "4 4"], pinhole: Pinhole
) -> Float[np.ndarray, "rows columns"]:
    """Depth of the room's nearest plane along each pixel's ray, in closed form."""
    directions = pinhole.ray_directions() @ matrix[:3, :3].T
    high = np.asarray([room.half_width_m, room.height_m, room.ahead_m])
    low = np.asarray([-room.half_width_m, 0.0, -room.ahead_m])
    with np.errstate(divide="ignore"):
        reached = np.where(directions > 0.0, high - matrix[:3, 3], low - matrix[:3, 3]) / directions
    return np.min(np.where(directions == 0.0, np.inf, reached), axis=-1)


def _views(
    renderer: Renderer,
    matrices: Sequence[Float[np.ndarray, "4 4"]],
    *,
    near_m: float = 0.0,
    far_m: float = 100.0,
) -> list[Image]:
    return renderer.render(matrices, rgb=RGB, depth=DEPTH, near_m=near_m, far_m=far_m)


def _view(
    renderer: Renderer,
    matrix: Float[np.ndarray, "4 4"],
    *,
    near_m: float = 0.0,
    far_m: float = 100.0,
) -> Image:
    return _views(renderer, [matrix], near_m=near_m, far_m=far_m)[0]


def _require(holds: bool, expectation: str) -> None:
    if not holds:
        message = f"renderer conformance: expected {expectation}"
        raise InternalError(message)


def _require_colour(
    rgb: UInt8[np.ndarray, "rows columns 3"],
    place: tuple[float, float],
    colour: Colour,
    tolerance: Tolerance,
) -> None:
    """Compare the pixel at (down, right) fractions of the picture with a pure colour."""
    rows, columns = rgb.shape[:2]
    pixel = rgb[int(place[0] * rows), int(place[1] * columns)].astype(np.int64)
    wanted = np.asarray(colour)
    if tolerance.level is not None:
        holds = bool((np.abs(pixel - 255 * wanted) <= tolerance.level).all())
    else:
        # Under unknown lights: channels that must be there outshine those that must not.
        holds = bool(pixel[wanted > 0.5].min() > pixel[wanted < 0.5].max(initial=0) + 20)
    _require(holds, f"colour {colour} at {place} of the picture, came {pixel.tolist()}")
