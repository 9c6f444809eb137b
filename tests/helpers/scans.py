"""Ten made-up scans laid out as Matterport3D's are, with R2R-CE episodes of known length.

Files lie at `mp3d/SCAN/SCAN.glb`, Z up against glTF's rule, in several textured parts; every other
scan has a `.navmesh` beside it. Two scans have stairs; in the others a wall with a doorway stands
between start and goal.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from PIL import Image
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.files import write_episodes
from c2nav_engine.geometry import Point, Pose
from tests.helpers.meshes import Box, merged, room, slab, stairs, wall, way_around_m
from tests.helpers.navmesh_bytes import Corner, MeshSpec, TileSpec, rectangle, write_navmesh

RADIUS_M = 0.1
STEPS = 8
RISE_M, RUN_M = 0.18 * STEPS, 0.28 * STEPS
NAMES = tuple(f"Made{number:02d}Scan{letter * 3}" for number, letter in enumerate("abcdefghij"))


@dataclass(frozen=True)
class Scan:
    """One scan.

    Attributes:
        name: Eleven characters or so, as Matterport's.
        boxes: The geometry, part by part.
        floor: The polygons of its navigation mesh.
        start: Where its episode begins.
        goal_m: Where it ends.
        geodesic_m: The true way between them.
        has_navmesh: Whether the file is written.
    """

    name: str
    boxes: tuple[tuple[Box, ...], ...]
    floor: tuple[tuple[Corner, ...], ...]
    start: Pose
    goal_m: Point
    geodesic_m: float
    has_navmesh: bool

    @property
    def scene_id(self) -> str:
        return f"mp3d/{self.name}/{self.name}.glb"


def scans() -> tuple[Scan, ...]:
    """All ten; the same every time."""
    return tuple(
        _stairs(name, number) if number in (3, 6) else _doorway(name, number)
        for number, name in enumerate(NAMES)
    )


def write_scans(folder: Path) -> Path:
    """Write the scans below a folder and their episodes beside it; returns the episode file."""
    for scan in scans():
        at = folder / "mp3d" / scan.name
        at.mkdir(parents=True)
        (at / f"{scan.name}.glb").write_bytes(_glb(scan))
        # As in the real folder: more files of the scan lie beside it.
        (at / f"{scan.name}_semantic.ply").write_bytes(b"labels, no scene")
        if scan.has_navmesh:
            tile = TileSpec([list(polygon) for polygon in scan.floor])
            data = write_navmesh(MeshSpec([tile], tile_size_m=16.0))
            (at / f"{scan.name}.navmesh").write_bytes(data)
    path = folder / "made_v1-3_ten.json.gz"
    write_episodes(path, [_episode(scan, number) for number, scan in enumerate(scans(), 1)])
    return path


def _episode(scan: Scan, number: int) -> Episode:
    return Episode(
        episode_id=str(number),
        trajectory_id=str(100 + number),
        scene_id=scan.scene_id,
        start=scan.start,
        instruction="Walk to the doorway. Go through it and stop in the far corner.",
        goal_m=scan.goal_m,
        geodesic_m=scan.geodesic_m,
        reference_path_m=(scan.start.position_m, scan.goal_m),
    )


def _doorway(name: str, number: int) -> Scan:
    """Two rooms side by side, open to one another at the far end of the wall between them."""
    width, depth, door = 8.0 + 0.2 * number, 5.0 + 0.1 * number, 3.0
    left, right = width / 2 - 0.05, width / 2 + 0.05
    low, high, turn = RADIUS_M, depth - RADIUS_M, door + RADIUS_M
    shell, inner = room(width, depth), wall(left, 0.0, right, door)
    start, goal = (1.0, 1.0), (width - 1.0, 1.0)
    floor = (
        rectangle((low, low), (left - RADIUS_M, turn)),
        rectangle((low, turn), (left - RADIUS_M, high)),
        rectangle((left - RADIUS_M, turn), (right + RADIUS_M, high)),
        rectangle((right + RADIUS_M, turn), (width - RADIUS_M, high)),
        rectangle((right + RADIUS_M, low), (width - RADIUS_M, turn)),
    )
    return Scan(
        name=name,
        boxes=((shell[0],), tuple(shell[1:]), (inner,)),
        floor=tuple(tuple(polygon) for polygon in floor),
        start=Pose((start[0], 0.0, start[1]), math.radians(-90.0 + 15.0 * number)),
        goal_m=(goal[0], 0.0, goal[1]),
        geodesic_m=way_around_m(start, goal, [(left, door), (right, door)]),
        has_navmesh=number % 2 == 0,
    )


def _stairs(name: str, number: int) -> Scan:
    """A room, a flight of stairs and a landing, all one corridor 2 m wide."""
    foot, width, depth = 4.0, 2.0, 10.0
    top = foot + RUN_M
    sides = (wall(-0.1, -0.1, 0.0, depth), wall(width, -0.1, width + 0.1, depth))
    ends = (wall(-0.1, -0.1, width + 0.1, 0.0), wall(-0.1, depth, width + 0.1, depth + 0.1))
    tall = tuple(Box(box.low_m, (*box.high_m[:1], 4.0, box.high_m[2])) for box in (*sides, *ends))
    low, high = RADIUS_M, width - RADIUS_M
    floor = (
        rectangle((low, low), (high, foot)),
        [(low, 0.0, foot), (low, RISE_M, top), (high, RISE_M, top), (high, 0.0, foot)],
        rectangle((low, top), (high, depth - RADIUS_M), y=RISE_M),
    )
    ground, landing = (
        slab(-0.1, -0.1, width + 0.1, foot),
        slab(-0.1, top, width + 0.1, depth + 0.1, top_m=RISE_M),
    )
    start, goal, has_navmesh = (1.0, 0.0, 1.0), (1.0, RISE_M, 9.0), number % 2 == 0
    along_m = (foot - 1.0) + math.hypot(RISE_M, RUN_M) + (9.0 - top)
    return Scan(
        name=name,
        boxes=((ground,), tall, tuple(stairs(0.0, width, foot, STEPS)), (landing,)),
        floor=tuple(tuple(polygon) for polygon in floor),
        start=Pose(start, math.pi),
        goal_m=goal,
        # Detour pulls its string tight in plan: straight stairs are one straight line to it.
        geodesic_m=math.dist(start, goal) if has_navmesh else along_m,
        has_navmesh=has_navmesh,
    )


def _glb(scan: Scan) -> bytes:
    scene = trimesh.Scene()
    for index, boxes in enumerate(scan.boxes):
        scene.add_geometry(_chunk(list(boxes), index), node_name=f"chunk{index:03d}")
    data: Any = scene.export(file_type="glb")
    return bytes(data)


def _chunk(boxes: list[Box], index: int) -> Any:
    vertices, triangles = merged(boxes)
    corners = vertices[triangles].reshape(-1, 3)
    x, y, z = corners.T
    noise = np.random.default_rng(index).integers(60, 200, (32, 32, 3), dtype=np.uint8)
    visual = TextureVisuals(
        uv=np.stack([x + y, z + y], axis=1) / 4.0,
        material=PBRMaterial(name=f"photo{index}", baseColorTexture=Image.fromarray(noise)),
    )
    faces = np.arange(len(corners)).reshape(-1, 3)
    # Matterport's axes: what is up in the world is z in the file.
    return trimesh.Trimesh(np.stack([x, -z, y], axis=1), faces, visual=visual, process=False)
