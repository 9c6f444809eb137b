"""`c2nav scene prepare`: caches and compiled kernels made beforehand, scene by scene."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from app.commands.scenes import named_scene, scene_source
from c2nav_engine.controller.sensed import Action
from c2nav_engine.episodes.profile import Profile
from c2nav_engine.errors import C2NavError, SceneError
from c2nav_engine.geometry import Pose
from c2nav_engine.navigator.requests import Look, Move, Rig
from c2nav_engine.runner.scene_cache import cache_folder, display_scene
from c2nav_engine.runner.shell import LiveShell
from c2nav_engine.runner.worlds import Worlds, WorldsConfig, built_surface, embree
from c2nav_engine.world.scene import Material, Piece, scene_of
from c2nav_engine.world.surface import Surface

SEMANTICS = ("_semantic", ".semantic")
"""Endings of habitat's files of labels, which are no scenes."""


@dataclass(frozen=True, slots=True)
class Prepared:
    """One scene's row.

    Attributes:
        scene_id: Which.
        triangles: Of the mesh that the robot sees.
        shown_triangles: Of the mesh that a browser shows.
        floor: "navmesh" or "built".
        cache_mb: What the whole cache grew by.
        seconds: How long it took.
        problem: Why it could not be prepared; "" when it was.
    """

    scene_id: str
    triangles: int = 0
    shown_triangles: int = 0
    floor: str = ""
    cache_mb: float = 0.0
    seconds: float = 0.0
    problem: str = ""


def prepare_all(
    name: str, scenes: Path | None, profile: Profile, *, quiet: bool
) -> tuple[Prepared, ...]:
    """Prepare one scene, or every scene below a folder; raises `SceneError` when there is none."""
    single = not Path(name).is_dir()
    scene_id, folder = named_scene(name, scenes) if single else ("", Path(name))
    ids = [scene_id] if single or folder is None else scene_ids(folder)
    worlds = Worlds(scene_source(folder), WorldsConfig(profile))
    rows: list[Prepared] = []
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=Console(stderr=True), disable=quiet, transient=True) as shown:
        bar = shown.add_task("", total=len(ids))
        for scene_id in ids:
            shown.update(bar, description=scene_id)
            rows.append(_row(scene_id, worlds))
            shown.advance(bar)
        shown.update(bar, description="kernels")
        warm_kernels(profile)
    if single and rows[0].problem:
        raise SceneError(rows[0].problem)
    return tuple(rows)


def prepared_json(rows: Sequence[Prepared]) -> dict[str, object]:
    """The result for machines."""
    return {"cache": str(cache_folder()), "scenes": [asdict(row) for row in rows]}


def scene_ids(folder: Path) -> list[str]:
    """The scans below a folder, by their place in it; raises `SceneError` when there is none."""
    found = sorted(
        str(path.relative_to(folder))
        for path in _files(folder)
        if path.suffix.lower() in (".glb", ".gltf") and not path.stem.endswith(SEMANTICS)
    )
    if not found:
        message = f"expected scenes (.glb) below {folder}, found none; name the folder of scans"
        raise SceneError(message)
    return found


def _files(folder: Path) -> Iterator[Path]:
    """Files below a folder, through links, for scans often lie on another disk; no loops."""
    seen: set[str] = set()
    for here, folders, files in os.walk(folder, followlinks=True):
        real = os.path.realpath(here)
        if real in seen:
            folders.clear()
            continue
        seen.add(real)
        yield from (Path(here) / file for file in files)


def _row(scene_id: str, worlds: Worlds) -> Prepared:
    begun, before = time.perf_counter(), _bytes(cache_folder())
    try:
        world = worlds.of(scene_id)
        shown = display_scene(world.scene, cache_folder())
        _ask(world.surface)
    except C2NavError as error:
        return Prepared(scene_id, problem=str(error))
    return Prepared(
        scene_id=scene_id,
        triangles=len(world.scene.triangles),
        shown_triangles=len(shown.triangles),
        floor=world.surface.source,
        cache_mb=round((_bytes(cache_folder()) - before) / 1e6, 2),
        seconds=round(time.perf_counter() - begun, 2),
    )


def warm_kernels(profile: Profile) -> None:
    """Look around and take a step in an empty room: what compiles at first use is then on disk."""
    corners = np.array([[-3, 0, -3], [-3, 0, 3], [3, 0, 3], [3, 0, -3]], np.float32)
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    uvs = corners[triangles][:, :, (0, 2)]
    material = Material("floor", texture=np.full((4, 4, 4), 200, np.uint8))
    scene = scene_of("room", [Piece("floor", material, corners, triangles, uvs)])
    surface = built_surface(scene, profile, cache_folder())
    shell = LiveShell(
        start=Pose((0.0, 0.0, 0.0), 0.0),
        surface=surface,
        renderer=embree(scene),
        profile=profile,
        goal_distance=surface.distance_field((1.0, 0.0, 1.0)).distance_m,
    )
    shell.look(Look(Rig.FAN))
    shell.move(Move((Action.LEFT, Action.FORWARD), "elect"))
    _ask(surface)


def _ask(surface: Surface) -> None:
    """One question of each kind."""
    triangles = surface.triangles()
    if not len(triangles):
        return
    x, y, z = (float(value) for value in triangles[0].mean(axis=0))
    surface.snap((x, y, z))
    surface.slide((x, y, z), (x + 0.25, y, z))
    surface.path((x, y, z), (x + 0.1, y, z))
    surface.distance_field((x, y, z)).distance_m((x, y, z))


def _bytes(folder: Path) -> int:
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
