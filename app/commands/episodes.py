"""`c2nav episodes list|show|check`: what a source holds, and whether it can be run."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console
from rich.table import Table

from app.commands.options import EpisodesOpt, JsonOpt, ScenesOpt, SourceArg, ids
from app.commands.output import print_json
from c2nav_engine.contract.route import parse_english
from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.profile import profile_named
from c2nav_engine.errors import C2NavError, SceneError
from c2nav_engine.runner.source import Source, open_source
from c2nav_engine.runner.worlds import Worlds, WorldsConfig


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


def check_episodes(
    source: SourceArg,
    scenes: ScenesOpt = None,
    episodes: EpisodesOpt = "",
    profile: str = "vlnce",
    headings: Path | None = None,
    json: JsonOpt = False,
) -> int:
    """Check schema, scenes, starts, goals and distances of a source."""
    from c2nav_engine.world.episode_check import check_episode

    opened = open_source(source, scenes=scenes, headings=headings)
    chosen = opened.chosen(ids(episodes))
    missing = missing_scenes(opened, chosen)
    worlds = Worlds(opened, WorldsConfig(profile_named(profile)))
    findings: list[tuple[str, str]] = []
    for item in chosen:
        if item.scene_id in missing:
            continue
        try:
            found = check_episode(item, worlds.of(item.scene_id).surface)
        except C2NavError as error:
            found = [str(error)]
        findings += [(item.episode_id, text) for text in found]
    return _report(chosen, missing, findings, json=json)


def missing_scenes(source: Source, chosen: tuple[Episode, ...]) -> dict[str, list[str]]:
    """Scene ids that do not resolve, with the episodes they block."""
    missing: dict[str, list[str]] = {}
    for item in chosen:
        try:
            source.scene_file(item.scene_id)
        except SceneError:
            missing.setdefault(item.scene_id, []).append(item.episode_id)
    return missing


def _report(
    chosen: tuple[Episode, ...],
    missing: dict[str, list[str]],
    findings: list[tuple[str, str]],
    *,
    json: bool,
) -> int:
    ok = not missing and not findings
    if json:
        print_json(
            {
                "episodes": len(chosen),
                "ok": ok,
                "missing_scenes": missing,
                "findings": [{"episode_id": e, "finding": text} for e, text in findings],
            }
        )
        return 0 if ok else 1
    console = Console(highlight=False)
    if missing:
        blocked = sum(map(len, missing.values()))
        console.print(f"{len(missing)} scenes are missing and block {blocked} episodes:")
        for scene_id, episodes in sorted(missing.items()):
            console.print(f"  {scene_id}  ({len(episodes)} episodes)", markup=False)
        console.print("Put them below the folder that --scenes names, as mp3d/SCAN/SCAN.glb")
    for episode_id, text in findings:
        console.print(f"episode {episode_id}: {text}", markup=False)
    if ok:
        console.print(f"{len(chosen)} episodes hold")
    return 0 if ok else 1


def _brief(item: Episode) -> dict[str, object]:
    return {
        "episode_id": item.episode_id,
        "scene_id": item.scene_id,
        "geodesic_m": item.geodesic_m,
        "legs": len(parse_english(item.instruction).legs),
        "instruction": item.instruction,
    }


episodes = {"list": list_episodes, "show": show_episode, "check": check_episodes}
"""Subcommands of `c2nav episodes`."""
