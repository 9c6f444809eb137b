"""`c2nav episodes list|show|check|make`: what a source holds, whether it runs, and new ones."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console
from rich.table import Table

from app.commands.checking import check_source, checked_json, print_checked
from app.commands.options import (
    ConnectivityOpt,
    EpisodesOpt,
    GroundTruthOpt,
    HeadingsOpt,
    JsonOpt,
    ScenesOpt,
    SourceArg,
    connectivity_folder,
    ids,
)
from app.commands.output import check_file, print_json
from app.commands.scenes import opened_scene
from c2nav_engine.contract.route import parse_english
from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.files import write_episodes
from c2nav_engine.episodes.profile import profile_named
from c2nav_engine.errors import UsageError
from c2nav_engine.runner.source import open_source

ProfileOpt = Annotated[str, tyro.conf.arg(metavar="NAME", help="Embodiment profile.")]


def list_episodes(
    source: SourceArg, scenes: ScenesOpt = None, episodes: EpisodesOpt = "", json: JsonOpt = False
) -> int:
    """List the episodes of a source."""
    opened = open_source(source, scenes=scenes)
    chosen = opened.chosen(ids(episodes))
    if json:
        print_json({"source": opened.file.name, "episodes": [_brief(item) for item in chosen]})
        return 0
    table = Table(box=None, header_style="bold")
    for name in ("episode", "scene", "geodesic m", "legs", "instruction"):
        table.add_column(name, justify="right" if name in {"geodesic m", "legs"} else "left")
    for item in chosen:
        brief = _brief(item)
        length = "–" if item.geodesic_m is None else f"{item.geodesic_m:.1f}"
        table.add_row(item.episode_id, item.scene_id, length, str(brief["legs"]), item.instruction)
    Console().print(table)
    return 0


def show_episode(
    source: SourceArg,
    episode: Annotated[str, tyro.conf.Positional],
    scenes: ScenesOpt = None,
    json: JsonOpt = False,
) -> int:
    """Show one episode whole, with its legs."""
    item = open_source(source, scenes=scenes).episode(episode)
    legs = list(parse_english(item.instruction).legs)
    if json:
        print_json({**asdict(item), "legs": legs})
        return 0
    console = Console()
    console.print(f"[bold]episode {item.episode_id}[/] · {item.scene_id}")
    for number, leg in enumerate(legs, start=1):
        console.print(f"  {number}  {leg}", markup=False)
    for name in ("start", "goal_m", "geodesic_m", "reference_path_m"):
        console.print(f"{name}: {getattr(item, name)}", markup=False)
    return 0


def check(
    source: SourceArg,
    scenes: ScenesOpt = None,
    episodes: EpisodesOpt = "",
    profile: ProfileOpt = "vlnce",
    headings: HeadingsOpt = None,
    ground_truth: GroundTruthOpt = None,
    connectivity: ConnectivityOpt = None,
    json: JsonOpt = False,
) -> int:
    """Check schema, scenes, starts, goals and distances; exit code 1 where anything is amiss."""
    opened = open_source(source, scenes=scenes, headings=headings, ground_truth=ground_truth)
    found = check_source(
        opened,
        opened.chosen(ids(episodes)),
        profile_named(profile),
        connectivity=connectivity_folder(connectivity, scenes),
        quiet=json,
    )
    if json:
        print_json(checked_json(found))
    else:
        print_checked(found, Console(highlight=False, soft_wrap=False))
    return 0 if found.ok else 1


def make(
    scene: Annotated[
        str,
        tyro.conf.Positional,
        tyro.conf.arg(metavar="SCENE", help="A mesh, a scene id below --scenes, or builtin/NAME."),
    ],
    out: Annotated[Path, tyro.conf.arg(metavar="FILE", help=".json or .json.gz to write.")],
    count: Annotated[int, tyro.conf.arg(metavar="N", help="How many episodes.")] = 10,
    seed: Annotated[int, tyro.conf.arg(metavar="S", help="The same seed, the same episodes.")] = 0,
    scenes: ScenesOpt = None,
    profile: ProfileOpt = "vlnce",
    json: JsonOpt = False,
) -> int:
    """Sample episodes on any mesh and write them in the R2R-CE schema."""
    from c2nav_engine.world.episode_make import make_episodes

    if count < 1:
        message = f"expected at least one episode, came --count {count}"
        raise UsageError(message)
    if not out.name.endswith((".json", ".json.gz")):
        message = f"expected a file that ends in .json or .json.gz, came --out {out}"
        raise UsageError(message)
    check_file(out)
    opened = opened_scene(scene, scenes, profile_named(profile))
    world = opened.world
    made = make_episodes(
        world.surface, world.scene, count=count, seed=seed, scene_id=opened.scene_id
    )
    write_episodes(out, made)
    facts = {
        "out": str(out),
        "episodes": len(made),
        "scene_id": opened.scene_id,
        "surface": world.surface.source,
        "scenes": "" if opened.scenes is None else str(opened.scenes),
    }
    if json:
        print_json(facts)
        return 0
    console = Console(highlight=False)
    console.print(f"{len(made)} episodes in {opened.scene_id} on a {world.surface.source} floor")
    below = "" if opened.scenes is None else f" --scenes {opened.scenes}"
    console.print(f"c2nav inspect {out}{below}", markup=False, soft_wrap=True)
    return 0


def _brief(item: Episode) -> dict[str, object]:
    return {
        "episode_id": item.episode_id,
        "scene_id": item.scene_id,
        "geodesic_m": item.geodesic_m,
        "legs": len(parse_english(item.instruction).legs),
        "instruction": item.instruction,
    }


episodes = {"list": list_episodes, "show": show_episode, "check": check, "make": make}
"""Subcommands of `c2nav episodes`."""
