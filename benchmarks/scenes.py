"""Time and memory of opening, seeing, walking and showing meshes of different sizes.

python -m benchmarks.scenes [--triangles 100000 10000000] [--views 40]

Each size runs in a process of its own, so that its memory is its own.
"""

from __future__ import annotations

import argparse
import importlib
import json
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from rich.console import Console
from rich.table import Table

from app.inspector.scene.glb import pack
from app.inspector.scene.mesh import chunks
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.geometry import Pose, world_from_camera
from c2nav_engine.runner.scene_cache import cached_scene, display_scene
from c2nav_engine.sensing.embree import EmbreeRenderer
from c2nav_engine.world.scene import Material, Piece

T = TypeVar("T")

SIZE_M = 20.0
WAVE_M = 0.02
ROOMS = 16
"""Parts of the mesh, as the regions of a scan."""

ROWS = {
    "load_s": "load the file, first time",
    "open_s": "open from the cache, second time",
    "surface_s": "build the floor",
    "field_s": "distances to one goal, solved",
    "distances_per_s": "distances to that goal a second",
    "renderer_s": "prepare the renderer",
    "view_ms": "one RGB-D view of the profile",
    "light_s": "lighten for the browser, first time",
    "light_triangles": "triangles in the browser",
    "glb_mb": "sent to the browser, MB",
    "peak_gb": "most memory, GB",
}


def timed(task: Callable[[], T]) -> tuple[T, float]:
    """What the task returns, and its seconds."""
    begun = time.perf_counter()
    result = task()
    return result, time.perf_counter() - begun


def rough_house(triangles: int) -> list[Piece]:
    """Rooms in a row of rows, floors and walls rough as a scan's, vertex-coloured."""
    side = round((triangles / ROOMS / 10) ** 0.5)
    width = SIZE_M / 4
    return [_room(side, width, (width * (room // 4), width * (room % 4))) for room in range(ROOMS)]


def _room(side: int, width: float, at: tuple[float, float]) -> Piece:
    """Floor and four walls, each a grid of side × side squares."""
    unit = np.linspace(0.0, 1.0, side + 1, dtype=np.float32)
    u, v = (axis.reshape(-1) for axis in np.meshgrid(unit, unit, indexing="ij"))
    rough = WAVE_M * np.sin(60.0 * u) * np.sin(47.0 * v)
    # The walls stand off the corners, so that rooms are joined by gaps.
    inner = 0.8 + (width - 1.6) * u
    tall = 2.6 * v
    sheets = [
        (width * u, rough, width * v),
        (inner, tall, rough + 0.05),
        (inner, tall, width - 0.05 + rough),
        (rough + 0.05, tall, inner),
        (width - 0.05 + rough, tall, inner),
    ]
    first = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).reshape(-1)
    faces = np.concatenate(
        [
            np.stack([first, first + 1, first + side + 1], 1),
            np.stack([first + side + 1, first + 1, first + side + 2], 1),
        ]
    )
    count = (side + 1) ** 2
    vertices = np.concatenate([np.stack(sheet, axis=1) for sheet in sheets])
    vertices += np.array([at[0], 0.0, at[1]], np.float32)
    triangles = np.concatenate([faces + sheet * count for sheet in range(len(sheets))])
    shade = (120 + 100 * np.sin(90.0 * vertices[:, :1] + 70.0 * vertices[:, 2:])).astype(np.uint8)
    colours = np.hstack([shade, shade, shade, np.full_like(shade, 255)])
    return Piece(
        "room", Material("scan"), vertices.astype(np.float32), triangles.astype(np.int32),
        colours=colours,
    )  # fmt: skip


def write_glb(path: Path, pieces: list[Piece]) -> None:
    """Write pieces as the nodes of one binary glTF."""
    trimesh: Any = importlib.import_module("trimesh")
    scene = trimesh.Scene()
    for number, piece in enumerate(pieces):
        mesh = trimesh.Trimesh(
            piece.vertices_m, piece.triangles, vertex_colors=piece.colours, process=False
        )
        scene.add_geometry(mesh, node_name=f"room{number:02d}")
    path.write_bytes(scene.export(file_type="glb"))


def measure(folder: Path, views: int) -> dict[str, float]:
    """All figures of one size; the file lies in the folder."""
    from c2nav_engine.world.walkable import build_surface

    path = folder / "scan.glb"
    scene, load_s = timed(lambda: cached_scene(path, folder, smallest_bytes=0))
    scene, open_s = timed(lambda: cached_scene(path, folder, smallest_bytes=0))
    surface, surface_s = timed(
        lambda: build_surface(
            scene.vertices_m, scene.triangles, height_m=VLNCE.height_m, radius_m=VLNCE.radius_m,
            climb_m=VLNCE.climb_m, slope_rad=VLNCE.slope_rad,
        )
    )  # fmt: skip
    places = np.random.default_rng(0).uniform(1.0, SIZE_M - 1.0, (200, 2))
    points = [surface.snap((float(x), 0.0, float(z))) for x, z in places]
    found = [point for point in points if point is not None]
    field, field_s = timed(lambda: surface.distance_field(found[0]))
    field.distance_m(found[1])
    _, asked_s = timed(lambda: [field.distance_m(point) for point in found])
    renderer, renderer_s = timed(lambda: EmbreeRenderer(scene))
    light, light_s = timed(lambda: display_scene(scene, folder))
    sent = sum(len(pack(surfaces)) for surfaces in chunks(light, 1.6))
    return {
        "triangles": len(scene.triangles),
        "load_s": load_s,
        "open_s": open_s,
        "surface_s": surface_s,
        "field_s": field_s,
        "distances_per_s": len(found) / asked_s,
        "renderer_s": renderer_s,
        "view_ms": 1e3 * view_s(renderer, views),
        "light_s": light_s,
        "light_triangles": len(light.triangles),
        "glb_mb": sent / 1e6,
        "peak_gb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9,
    }


def view_s(renderer: EmbreeRenderer, views: int) -> float:
    """Best of the views, each of another place; one before them compiles."""
    times: list[float] = []
    for number in range(views + 1):
        pose = Pose((2.5 + 5.0 * (number % 4), 0.0, 2.5), 0.7 * number)
        camera = world_from_camera(pose, height_m=VLNCE.camera_height_m, offset_rad=0.0)
        _, seconds = timed(
            lambda camera=camera: renderer.render(
                [camera], rgb=VLNCE.rgb, depth=VLNCE.depth, near_m=0.0, far_m=10.0
            )
        )
        times.append(seconds)
    return min(times[1:])


def in_a_process(triangles: int, views: int) -> dict[str, float]:
    """Write the mesh, then measure it where nothing else was ever loaded."""
    with tempfile.TemporaryDirectory() as folder:
        write_glb(Path(folder) / "scan.glb", rough_house(triangles))
        words = [sys.executable, __file__, "--measure", folder, "--views", str(views)]
        done = subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--triangles", type=int, nargs="+", default=[100_000, 10_000_000])
    parser.add_argument("--views", type=int, default=40, help="views of each mesh (default 40)")
    parser.add_argument("--measure", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.measure:
        sys.stdout.write(json.dumps(measure(options.measure, options.views)))
        return
    figures = [in_a_process(count, options.views) for count in options.triangles]
    table = Table(title="meshes on this machine")
    table.add_column("")
    for row in figures:
        table.add_column(f"{row['triangles']:,.0f} triangles", justify="right")
    for key, words in ROWS.items():
        table.add_row(words, *(f"{row[key]:,.2f}" for row in figures))
    first, last = figures[0], figures[-1]
    table.add_row("one view, last over first", *([""] * (len(figures) - 1)),
                  f"{last['view_ms'] / first['view_ms']:.2f}")  # fmt: skip
    Console().print(table)


if __name__ == "__main__":
    main()
