"""What pictures cost: ours over the bare casts, other renderers over ours, large meshes over small.

    python -m benchmarks.rendering SCENE.glb

Every ratio is measured side by side in one run, so a busy machine slows both sides alike.
`c2nav bench` imports the functions. Renderers that may end the process, or write to standard
output on their own, are measured in a process of their own.
"""

from __future__ import annotations

import argparse
import importlib
import json
import math
import os
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from c2nav_engine.episodes.profile import VLNCE, Profile
from c2nav_engine.errors import MissingExtra
from c2nav_engine.geometry import Pose
from c2nav_engine.sensing.embree import EmbreeRenderer
from c2nav_engine.sensing.renderer import Renderer
from c2nav_engine.sensing.ring import CameraOffset, SensorRing
from c2nav_engine.world.load import load_scene
from c2nav_engine.world.scene import Material, Piece, Scene, scene_of

PLACES = 4
"""Different viewpoints, taken in turn: one alone could be lucky."""


@dataclass(frozen=True, slots=True)
class Ratio:
    """Two costs measured in turn.

    Attributes:
        above_ms: Of the one that stands above the line.
        below_ms: Of the other.
    """

    above_ms: float
    below_ms: float

    @property
    def value(self) -> float:
        """How many times the one below."""
        return self.above_ms / self.below_ms


Points = Float[np.ndarray, "n 3"]

Timed = Callable[[int], object]
"""Work of round k, at viewpoint k modulo `PLACES`."""


def side_by_side(above: Timed, below: Timed, *, rounds: int) -> Ratio:
    """Time both in every round, in alternating order, after a warm-up of each viewpoint.

    The best of each viewpoint counts, averaged over viewpoints: whatever else runs on the
    machine can only add to a time.
    """
    sides = {above: np.full(PLACES, np.inf), below: np.full(PLACES, np.inf)}
    for k in range(rounds + PLACES):
        for work in list(sides) if k % 2 else reversed(sides):
            start_s = time.perf_counter()
            work(k)
            took_ms = 1e3 * (time.perf_counter() - start_s)
            if k >= PLACES:
                sides[work][k % PLACES] = min(sides[work][k % PLACES], took_ms)
    return Ratio(float(sides[above].mean()), float(sides[below].mean()))


def fan_over_casts(scene: Path | Scene, *, rounds: int = 24) -> float:
    """Three RGB-D views over the bare casts of the same rays."""
    return over_casts(_loaded(scene), whole(SensorRing(VLNCE).fan), rounds=rounds).value


def ring_over_casts(scene: Path | Scene, *, rounds: int = 12) -> float:
    """Twelve RGB-D views over the bare casts of the same rays."""
    return over_casts(_loaded(scene), whole(SensorRing(VLNCE).ring), rounds=rounds).value


def whole(cameras: Sequence[CameraOffset]) -> list[CameraOffset]:
    """The same cameras with every pixel of their depth pictures sensed."""
    return [replace(camera, depth_stride=1) for camera in cameras]


def over_casts(scene: Scene, cameras: Sequence[CameraOffset], *, rounds: int) -> Ratio:
    """Views of a scene over the bare casts of the same RGB and depth rays."""
    renderer = EmbreeRenderer(scene)
    ring = SensorRing(VLNCE)
    places = open_places(renderer, scene, VLNCE)
    rays = [
        renderer.rays(
            [
                image.world_from_camera
                for image in ring.capture(renderer, places[k % len(places)], cameras)
            ],
            rgb=VLNCE.rgb,
            depth=VLNCE.depth,
        )
        for k in range(PLACES)
    ]
    return side_by_side(
        lambda k: ring.capture(renderer, places[k % len(places)], cameras),
        lambda k: renderer.caster.cast(rays[k % PLACES]),
        rounds=rounds,
    )


def pyrender_over_fan(scene: Path) -> float:
    """The fan by pyrender (EGL) over ours; raises `MissingExtra` where it does not run."""
    return _apart("pyrender", scene).value


def filament_over_fan(scene: Path) -> float:
    """The fan by Open3D's offscreen renderer over ours; raises `MissingExtra` without Vulkan."""
    return _apart("filament", scene).value


def view_cost_10m_over_100k(*, rounds: int = 24) -> float:
    """One RGB-D view in a building of ten million triangles over one of a hundred thousand."""
    return large_over_small(10_000_000, 100_000, rounds=rounds).value


def large_over_small(large: int, small: int, *, rounds: int) -> Ratio:
    """One view of a finely tessellated building over one of the same building, coarser."""
    ring = SensorRing(VLNCE)
    fine, coarse = EmbreeRenderer(building(large)), EmbreeRenderer(building(small))
    headings = [Pose((0.0, 0.0, 0.0), 0.4 + 0.7 * k) for k in range(PLACES)]
    return side_by_side(
        lambda k: ring.capture(fine, headings[k % PLACES], ring.front),
        lambda k: ring.capture(coarse, headings[k % PLACES], ring.front),
        rounds=rounds,
    )


# ---------------------------------------------------------------- scenes and places

ROOMS = 5
"""Rooms along each side of the building: meshes of millions of triangles are buildings."""

ROOM_M = (6.0, 3.0, 6.0)
DOOR_HALF_M, DOOR_HEIGHT_M = 0.5, 2.1


def building(triangles: int) -> Scene:
    """Rooms with doorways on all sides, made of that many small textured triangles in all."""
    doors = 2.0 * (2.0 * DOOR_HALF_M * DOOR_HEIGHT_M) / (3.0 * ROOM_M[0] * ROOM_M[1])
    side = max(2, math.ceil(math.sqrt(triangles / (1.0 - doors) / (12 * ROOMS**2))))
    texture = np.random.default_rng(0).integers(60, 255, (512, 512, 4), dtype=np.uint8)
    plaster = Material("plaster", texture=texture)
    middle = (ROOMS - 1) / 2.0
    return scene_of(
        "building",
        [
            _piece(_side(axis, sign, side, (column - middle, row - middle)), side, plaster)
            for column in range(ROOMS)
            for row in range(ROOMS)
            for axis in range(3)
            for sign in (-1.0, 1.0)
        ],
    )


Mesh = tuple[np.ndarray, np.ndarray]
"""Vertices in metres, and triangles."""


def _side(axis: int, sign: float, side: int, place: tuple[float, float]) -> Mesh:
    """One side of a room as a slightly bumpy grid; walls have a doorway in the middle."""
    steps = np.linspace(-1.0, 1.0, side + 1, dtype=np.float32)
    u, v = np.meshgrid(steps, steps, indexing="ij")
    bump = 1.0 + 0.002 * np.sin(40.0 * u) * np.sin(40.0 * v)
    box = np.roll(np.stack([u, v, sign * bump], axis=-1).reshape(-1, 3), axis + 1, axis=1)
    centre_m = np.asarray([place[0] * ROOM_M[0], ROOM_M[1] / 2.0, place[1] * ROOM_M[2]])
    vertices_m = (box * np.asarray(ROOM_M) / 2.0 + centre_m).astype(np.float32)
    first = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).reshape(-1)
    below = first + side + 1
    triangles = np.concatenate(
        [np.stack([first, below, first + 1], 1), np.stack([first + 1, below, below + 1], 1)]
    ).astype(np.int32)
    if axis == 1:
        return vertices_m, triangles
    middles_m = vertices_m[triangles].mean(axis=1)
    beside = np.abs(middles_m[:, 2 - axis] - centre_m[2 - axis]) > DOOR_HALF_M
    return vertices_m, triangles[beside | (middles_m[:, 1] > DOOR_HEIGHT_M)]


def _piece(mesh: Mesh, side: int, material: Material) -> Piece:
    vertices_m, triangles = mesh
    corners = np.stack([triangles // (side + 1), triangles % (side + 1)], axis=-1)
    uvs = (corners / side).astype(np.float32)
    return Piece("side", material, vertices_m, triangles, uvs)


def open_places(renderer: EmbreeRenderer, scene: Scene, profile: Profile) -> list[Pose]:
    """The points of a coarse grid with a floor below and the most room around, facing it."""
    (x0, y0, z0), (x1, _, z1) = scene.bounds_m.astype(np.float64).tolist()
    eye_y = y0 + profile.camera_height_m
    shares = [k / 24.0 for k in range(1, 24)]
    eyes_m: Points = np.asarray(
        [(x0 + a * (x1 - x0), eye_y, z0 + b * (z1 - z0)) for a in shares for b in shares]
    )
    floor = renderer.cast(eyes_m, np.tile([0.0, -1.0, 0.0], (len(eyes_m), 1))).t_hit
    yaws_rad = np.linspace(0.0, math.tau, 16, endpoint=False)
    around = np.stack([-np.sin(yaws_rad), np.zeros(16), -np.cos(yaws_rad)], axis=1)
    reach_m = renderer.cast(
        np.repeat(eyes_m, 16, axis=0), np.tile(around, (len(eyes_m), 1))
    ).t_hit.reshape(-1, 16)
    room_m = np.where(np.isfinite(reach_m).all(axis=1) & (floor < 2.0), reach_m.min(axis=1), -1.0)
    best = np.argsort(-room_m, kind="stable")[:PLACES]
    return [
        Pose(
            (float(eyes_m[i, 0]), float(eyes_m[i, 1] - floor[i]), float(eyes_m[i, 2])),
            float(yaws_rad[reach_m[i].argmax()]),
        )
        for i in best
    ]


def _loaded(scene: Path | Scene) -> Scene:
    return scene if isinstance(scene, Scene) else load_scene(scene)


# ---------------------------------------------------------------- other renderers


def _apart(name: str, scene: Path) -> Ratio:
    """Measure one of the other renderers against ours in a process of its own."""
    command = [sys.executable, "-m", "benchmarks.rendering", str(scene), "--only", name]
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
        env={**os.environ, "PYOPENGL_PLATFORM": "egl"},
        cwd=Path(__file__).resolve().parents[1],
    )
    lines = done.stdout.strip().splitlines()
    if done.returncode != 0 or not lines:
        said = done.stderr.strip().splitlines()
        message = (
            f"{name} does not run here ({said[-1] if said else done.returncode}); pyrender comes "
            "with the extra `bench` and wants EGL, filament wants Vulkan"
        )
        raise MissingExtra(message)
    return Ratio(**json.loads(lines[-1]))


def _against_ours(make: Callable[[Path], Renderer], scene: Path) -> Ratio:
    loaded = load_scene(scene)
    ours, ring = EmbreeRenderer(loaded), SensorRing(VLNCE)
    place = open_places(ours, loaded, VLNCE)[0]
    theirs = make(scene)
    return side_by_side(
        lambda _: ring.capture(theirs, place, whole(ring.fan)),
        lambda _: ring.capture(ours, place, whole(ring.fan)),
        rounds=2 * PLACES,
    )


def _filament(scene: Path) -> Renderer:
    from c2nav_engine.sensing.filament import FilamentRenderer

    return FilamentRenderer(load_scene(scene))


class _Pyrender:
    """Pyrender under our protocol: a context of its own for each picture size."""

    name = "pyrender"

    def __init__(self, scene: Path) -> None:
        self._file = scene
        self._stages: dict[tuple[int, int], tuple[Any, Any]] = {}
        self._pyrender: Any = importlib.import_module("pyrender")

    def render(
        self,
        world_from_cameras: Sequence[Any],
        *,
        rgb: Any,
        depth: Any,
        near_m: float,
        far_m: float,
        depth_stride: int = 1,
    ) -> list[Any]:
        """RGB at one size and whole depth at the other, as ours."""
        del near_m, far_m, depth_stride
        depth_only = self._pyrender.RenderFlags.DEPTH_ONLY
        return [
            (self._view(matrix, rgb, 0), self._view(matrix, depth, depth_only))
            for matrix in world_from_cameras
        ]

    def _view(self, matrix: Any, pinhole: Any, flags: int) -> Any:
        size = (pinhole.width_px, pinhole.height_px)
        if size not in self._stages:
            self._stages[size] = self._stage(size)
        renderer, scene = self._stages[size]
        focal_px = pinhole.focal_px
        camera = self._pyrender.IntrinsicsCamera(focal_px, focal_px, size[0] / 2, size[1] / 2)
        node = scene.add(camera, pose=matrix)
        pictures = renderer.render(scene, flags)
        scene.remove_node(node)
        return pictures

    def _stage(self, size: tuple[int, int]) -> tuple[Any, Any]:
        trimesh: Any = importlib.import_module("trimesh")
        loaded = trimesh.load_scene(str(self._file), process=False)
        scene = self._pyrender.Scene.from_trimesh_scene(loaded, ambient_light=[1.0] * 3)
        return self._pyrender.OffscreenRenderer(*size), scene


OTHERS: dict[str, Callable[[Path], Renderer]] = {"pyrender": _Pyrender, "filament": _filament}


# ---------------------------------------------------------------- the table


def main() -> None:
    """Print the table of one scene."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("scene", type=Path)
    parser.add_argument("--only", choices=[*OTHERS], help="measure one renderer, print JSON")
    parser.add_argument("--large", type=int, default=10_000_000, help="triangles of the large room")
    options = parser.parse_args()
    if options.only:
        ratio = _against_ours(OTHERS[options.only], options.scene)
        print(json.dumps({"above_ms": ratio.above_ms, "below_ms": ratio.below_ms}))
        return
    scene = load_scene(options.scene)
    ring = SensorRing(VLNCE)
    rows: list[tuple[str, Callable[[], Ratio]]] = [
        ("fan over its casts", lambda: over_casts(scene, ring.fan, rounds=24)),
        ("ring over its casts", lambda: over_casts(scene, ring.ring, rounds=12)),
        ("pyrender over our fan", lambda: _apart("pyrender", options.scene)),
        ("filament over our fan", lambda: _apart("filament", options.scene)),
        (
            f"a view of {options.large:,} over 100,000 triangles",
            lambda: large_over_small(options.large, 100_000, rounds=12),
        ),
    ]
    print(f"{scene.name}: {len(scene.triangles):,} triangles, {VLNCE.name} profile")
    for name, measure in rows:
        try:
            ratio = measure()
        except MissingExtra as error:
            print(f"{name:48} –  {error}")
            continue
        print(f"{name:48} {ratio.above_ms:9.1f} ms {ratio.below_ms:9.1f} ms {ratio.value:7.2f} ×")


if __name__ == "__main__":
    main()
