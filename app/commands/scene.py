"""`c2nav scene info|prepare|query`: what a scene or a navigation mesh is, and what it answers."""

from __future__ import annotations

import json as json_module
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, cast

import tyro
from rich.console import Console
from rich.table import Table

from app.commands.options import JsonOpt, ScenesOpt
from app.commands.output import print_json
from app.commands.preparing import prepare_all, prepared_json
from app.commands.scenes import named_scene, scene_source, short_id
from c2nav_engine.episodes.profile import Profile, profile_named
from c2nav_engine.errors import UsageError
from c2nav_engine.world.navmesh import profile_note, query_pairs, read_navmesh
from c2nav_engine.world.scene import Scene

SceneArg = Annotated[
    str,
    tyro.conf.Positional,
    tyro.conf.arg(metavar="SCENE", help="A file, a scene id below --scenes, or builtin/NAME."),
]
ProfileOpt = Annotated[str, tyro.conf.arg(metavar="NAME", help="Embodiment profile.")]

MOST_NAMES = 12
"""Part names that people are shown."""


def info(
    scene: SceneArg, scenes: ScenesOpt = None, profile: ProfileOpt = "vlnce", json: JsonOpt = False
) -> int:
    """Size, parts, pictures and floor of a mesh, or body and islands of a `.navmesh`."""
    if scene.endswith(".navmesh"):
        facts = _navmesh_facts(Path(scene), profile_named(profile))
    else:
        facts = _mesh_facts(scene, scenes)
    if json:
        print_json(facts)
        return 0
    console = Console(highlight=False)
    for name, value in facts.items():
        console.print(f"{name}: {_told(value)}", markup=False, soft_wrap=True)
    return 0


def prepare(
    scene: Annotated[
        str,
        tyro.conf.Positional,
        tyro.conf.arg(metavar="SCENE|DIR", help="A scene as in `info`, or a folder of scans."),
    ],
    scenes: ScenesOpt = None,
    profile: ProfileOpt = "vlnce",
    json: JsonOpt = False,
) -> int:
    """Load scenes, build floors and browser meshes, and compile kernels, so that runs start fast.

    Exit code 1 when a scene of a folder cannot be prepared; the others are.
    """
    rows = prepare_all(scene, scenes, profile_named(profile), quiet=json)
    if json:
        print_json(prepared_json(rows))
        return int(any(row.problem for row in rows))
    table = Table(box=None, header_style="bold")
    for name in ("scene", "triangles", "shown", "floor", "cache MB", "s"):
        table.add_column(name, justify="left" if name in {"scene", "floor"} else "right")
    for row in rows:
        numbers = (f"{row.triangles:,}", f"{row.shown_triangles:,}", row.floor)
        table.add_row(short_id(row.scene_id), *numbers, f"{row.cache_mb:.0f}", f"{row.seconds:.1f}")
    console = Console(highlight=False)
    console.print(table)
    for row in rows:
        if row.problem:
            console.print(f"{row.scene_id}: {row.problem}", markup=False, soft_wrap=True)
    return int(any(row.problem for row in rows))


def query(
    navmesh: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="NAVMESH")],
    pairs: Annotated[Path, tyro.conf.arg(metavar="FILE", help="JSON with `paths` and `steps`.")],
    json: JsonOpt = False,
) -> int:
    """Geodesic distances of point pairs and slid forward moves, as Detour answers them."""
    try:
        asked = json_module.loads(pairs.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        message = f"expected a JSON file of `paths` and `steps`, came {pairs}: {error}"
        raise UsageError(message) from error
    answered = query_pairs(read_navmesh(navmesh), asked)
    if json:
        print_json(answered)
    else:
        Console().print_json(data=answered)
    return 0


def _mesh_facts(name: str, scenes: Path | None) -> dict[str, object]:
    scene_id, folder = named_scene(name, scenes)
    source = scene_source(folder)
    path = source.scene_file(scene_id)
    mesh = source.scene(scene_id)
    low, high = mesh.bounds_m
    beside = None if path is None else path.with_suffix(".navmesh")
    return {
        "name": mesh.name,
        "file": "" if path is None else str(path),
        "file_bytes": 0 if path is None else path.stat().st_size,
        "triangles": len(mesh.triangles),
        "vertices": len(mesh.vertices_m),
        "parts": len(mesh.parts),
        "part_names": list(dict.fromkeys(part.name for part in mesh.parts)),
        "materials": len(mesh.materials),
        "texture_megapixels": round(_texture_pixels(mesh) / 1e6, 2),
        "low_m": [round(float(value), 3) for value in low],
        "high_m": [round(float(value), 3) for value in high],
        "navmesh": str(beside) if beside is not None and beside.is_file() else "",
        "sha256": mesh.sha256,
        "licence": mesh.licence,
    }


def _texture_pixels(mesh: Scene) -> int:
    textures = {id(m.texture): m.texture for m in mesh.materials if m.texture is not None}
    return sum(texture.shape[0] * texture.shape[1] for texture in textures.values())


def _navmesh_facts(path: Path, profile: Profile) -> dict[str, object]:
    mesh = read_navmesh(path)
    low, high = mesh.bounds_m
    return {
        "file": str(path),
        "tiles": len(mesh.arrays.tiles),
        "polygons": len(mesh.arrays.polygons),
        "triangles": len(mesh.triangles()),
        "area_m2": round(sum(island.area_m2 for island in mesh.islands), 2),
        "islands": [asdict(island) for island in mesh.islands],
        "low_m": [round(value, 3) for value in low],
        "high_m": [round(value, 3) for value in high],
        "body": {
            "height_m": round(mesh.settings.agent_height_m, 4),
            "radius_m": round(mesh.settings.agent_radius_m, 4),
            "climb_m": round(mesh.settings.agent_climb_m, 4),
        },
        "settings": {name: round(value, 5) for name, value in mesh.settings.recorded.items()},
        "profile": profile.name,
        "profile_note": profile_note(mesh, profile),
        "notes": list(mesh.notes),
    }


def _told(value: object) -> str:
    """A fact in words; long lists by their beginning."""
    if isinstance(value, list):
        items = [_told(item) for item in cast("list[object]", value)]
        more = f" and {len(items) - MOST_NAMES} more" if len(items) > MOST_NAMES else ""
        listed = ("; " if "," in "".join(items) else ", ").join(items[:MOST_NAMES]) + more
        return listed or "none"
    if isinstance(value, dict):
        pairs = cast("dict[str, object]", value).items()
        return ", ".join(f"{name} {_told(item)}" for name, item in pairs) or "none"
    return f"{value:.2f}" if isinstance(value, float) else str(value) or "none"


scene = {"info": info, "prepare": prepare, "query": query}
"""Subcommands of `c2nav scene`."""
