"""`c2nav scene info|query`: what a scene or a navigation mesh is, and what it answers."""

from __future__ import annotations

import json as json_module
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console

from app.commands.options import JsonOpt
from app.commands.output import print_json
from c2nav_engine.errors import UsageError
from c2nav_engine.world.load import load_scene
from c2nav_engine.world.navmesh import query_pairs, read_navmesh

SceneArg = Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="SCENE")]


def info(scene: SceneArg, json: JsonOpt = False) -> int:
    """Size, parts and materials of a mesh, or settings and islands of a `.navmesh`."""
    facts = _navmesh_facts(scene) if scene.suffix == ".navmesh" else _mesh_facts(scene)
    if json:
        print_json(facts)
    else:
        console = Console(highlight=False)
        for name, value in facts.items():
            console.print(f"{name}: {value}", markup=False)
    return 0


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


def _mesh_facts(path: Path) -> dict[str, object]:
    scene = load_scene(path)
    low, high = scene.vertices_m.min(axis=0), scene.vertices_m.max(axis=0)
    return {
        "name": scene.name,
        "triangles": len(scene.triangles),
        "parts": len(scene.parts),
        "materials": len(scene.materials),
        "low_m": [round(float(v), 3) for v in low],
        "high_m": [round(float(v), 3) for v in high],
        "sha256": scene.sha256,
        "licence": scene.licence,
    }


def _navmesh_facts(path: Path) -> dict[str, object]:
    mesh = read_navmesh(path)
    return {
        "triangles": len(mesh.triangles()),
        "islands": len(mesh.islands),
        "settings": str(mesh.settings),
        "notes": list(mesh.notes),
    }


scene = {"info": info, "query": query}
"""Subcommands of `c2nav scene`."""
