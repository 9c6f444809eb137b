"""`c2nav episodes check`: what a source lacks and where it does not fit, in one screen."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from textwrap import fill

from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn

from app.commands.scenes import short_id
from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.profile import Profile
from c2nav_engine.runner.source import BUILTIN, Source
from c2nav_engine.runner.worlds import Worlds, WorldsConfig
from c2nav_engine.world.connectivity import (
    ConnectivityGraph,
    connectivity_file,
    connectivity_of,
)
from c2nav_engine.world.episode_check import Checked, check_episodes
from c2nav_engine.world.graph_check import check_on_graph
from c2nav_engine.world.surface import Surface

MOST_IDS = 24
"""Episode ids of one missing scene that are written out."""


@dataclass(frozen=True, slots=True)
class CheckedSource:
    """What a check found.

    Attributes:
        source: What was checked.
        chosen: The episodes that were checked.
        profile: The body.
        missing: Scene ids that do not resolve, with the episodes that they block.
        rows: The other episodes, in file order, and blocked ones that do not fit their graph.
        on_graph: How many episodes were held against the connectivity graph of their scan.
        surfaces: Which kind of floor measured, by scene id.
        notes: What a user should know though nothing is wrong.
    """

    source: Source
    chosen: tuple[Episode, ...]
    profile: Profile
    missing: Mapping[str, tuple[str, ...]]
    rows: tuple[Checked, ...]
    on_graph: int
    surfaces: Mapping[str, str]
    notes: tuple[str, ...]

    @property
    def ok(self) -> bool:
        """Whether every episode can be run as it is."""
        return not self.missing and not any(row.findings for row in self.rows)


def check_source(
    source: Source,
    chosen: tuple[Episode, ...],
    profile: Profile,
    *,
    connectivity: Path | None = None,
    quiet: bool,
) -> CheckedSource:
    """Check every episode whose scene is there, scene by scene so that each is opened once.

    With a folder of connectivity graphs, episodes are held against these too, scenes or none.
    """
    missing = source.missing_scenes(chosen)
    there = [item for item in chosen if item.scene_id not in missing]
    worlds = Worlds(source, WorldsConfig(profile))
    surfaces: dict[str, str] = {}
    notes = dict.fromkeys(_ground_truth_notes(source, chosen))
    columns = (SpinnerColumn(), TextColumn("{task.description}"))
    with Progress(*columns, console=Console(stderr=True), disable=quiet, transient=True) as shown:
        bar = shown.add_task("")

        def opened(scene_id: str) -> object:
            shown.update(bar, description=f"{scene_id} ({len(surfaces) + 1})")
            return worlds.of(scene_id)

        def surface_of(scene_id: str) -> Surface:
            world = worlds.of(scene_id)
            surfaces[scene_id] = world.surface.source
            if world.note:
                notes[world.note] = None
            return world.surface

        by_scene = sorted(there, key=lambda item: item.scene_id)
        rows = check_episodes(by_scene, opened, surface_of)
    graphs = {} if connectivity is None else _graphs(connectivity, chosen)
    rows = [*_with_graphs(chosen, {row.episode_id: row for row in rows}, graphs)]
    lacking = len({item.scene_id for item in chosen}) - len(graphs)
    if connectivity is not None and lacking:
        notes[f"{connectivity} lacks the connectivity graphs of {lacking} scenes"] = None
    place = {item.episode_id: number for number, item in enumerate(chosen)}
    return CheckedSource(
        source=source,
        chosen=chosen,
        profile=profile,
        missing=missing,
        rows=tuple(sorted(rows, key=lambda row: place[row.episode_id])),
        on_graph=sum(item.scene_id in graphs for item in chosen),
        surfaces=surfaces,
        notes=tuple(notes),
    )


def _graphs(folder: Path, chosen: Sequence[Episode]) -> dict[str, ConnectivityGraph]:
    """By scene id, as far as the folder has them; raises `SceneError` for a broken file."""
    return {
        scene_id: connectivity_of(folder, scene_id)
        for scene_id in {item.scene_id for item in chosen}
        if connectivity_file(folder, scene_id).is_file()
    }


def _with_graphs(
    chosen: Sequence[Episode],
    rows: Mapping[str, Checked],
    graphs: Mapping[str, ConnectivityGraph],
) -> Iterator[Checked]:
    """The rows with what the graphs say; a blocked episode has one where it does not fit."""
    for item in chosen:
        row = rows.get(item.episode_id)
        graph = graphs.get(item.scene_id)
        surface_m = None if row is None else row.geodesic_m
        told = () if graph is None else tuple(check_on_graph(item, graph, surface_m))
        if row is not None:
            yield replace(row, findings=(*row.findings, *told))
        elif told:
            yield Checked(item.episode_id, item.scene_id, told, None)


def checked_json(found: CheckedSource) -> dict[str, object]:
    """The result for machines."""
    return {
        **found.source.facts(),
        "headings": found.source.file.headings,
        "profile": found.profile.name,
        "episodes": len(found.chosen),
        "ok": found.ok,
        "on_graph": found.on_graph,
        "missing_scenes": {scene_id: list(ids) for scene_id, ids in found.missing.items()},
        "surfaces": dict(found.surfaces),
        "notes": list(found.notes),
        "findings": [
            {"episode_id": row.episode_id, "finding": text}
            for row in found.rows
            for text in row.findings
        ],
    }


def print_checked(found: CheckedSource, console: Console) -> None:
    """The result for people."""
    source = found.source
    if source.file.name != BUILTIN:
        own = source.facts().get("source_headings")
        told = f"{source.file.headings}, in place of its own {own}" if own else source.file.headings
        _line(console, f"{source.file.name}: {len(found.chosen)} episodes")
        _line(console, f"headings {told}; ground truth {source.ground_truth_name}")
    for note in found.notes:
        _line(console, f"note: {note}")
    _print_findings(found.rows, console)
    if found.missing:
        _print_missing(found, console)
    held = sum(not row.findings for row in found.rows)
    floors = ", ".join(
        f"{list(found.surfaces.values()).count(kind)} {kind}"
        for kind in sorted(set(found.surfaces.values()))
    )
    if found.on_graph:
        _line(console, f"{found.on_graph} episodes held against their connectivity graphs")
    if found.surfaces:
        _line(console, f"{held} of {len(found.chosen)} episodes hold (floors: {floors})")


def _print_findings(rows: Sequence[Checked], console: Console) -> None:
    """Findings, one that stops a whole scene (an unreadable mesh) told once."""
    told: dict[tuple[str, str], list[str]] = {}
    for row in rows:
        for text in row.findings:
            told.setdefault((row.scene_id, text), []).append(row.episode_id)
    for (_, text), ids in told.items():
        _line(console, f"episode {_ids(ids)}: {text}")


def _print_missing(found: CheckedSource, console: Console) -> None:
    missing, source = found.missing, found.source
    blocked = sum(map(len, missing.values()))
    where = f"below {source.scenes}" if source.scenes else "(no --scenes folder)"
    scenes = "1 scene is" if len(missing) == 1 else f"{len(missing)} scenes are"
    _line(console, f"{scenes} missing {where}; blocked: {blocked} of {len(found.chosen)} episodes")
    for scene_id, ids in sorted(missing.items()):
        _line(console, f"  {short_id(scene_id)}  {len(ids)}: {_ids(ids)}", hanging=6)
    if any(scene_id.startswith("mp3d/") for scene_id in missing):
        _line(
            console,
            "Matterport3D is licensed to each user: sign its terms (niessner.github.io/Matterport),"
            " run `download_mp.py --task habitat -o DIR` and unzip what it fetches.",
        )
    _line(
        console,
        "Then add --scenes DIR; a scan lies at DIR/mp3d/SCAN/SCAN.glb, its SCAN.navmesh beside it. "
        "The source `builtin` needs no scans.",
    )


def _ids(ids: Sequence[str]) -> str:
    shown = ", ".join(ids[:MOST_IDS])
    return shown if len(ids) <= MOST_IDS else f"{shown} and {len(ids) - MOST_IDS} more"


def _line(console: Console, text: str, *, hanging: int = 2) -> None:
    """One paragraph, wrapped by words with the rest indented; never cut inside a path."""
    width = max(console.width, 40)
    wrapped = fill(
        text, width, subsequent_indent=" " * hanging, break_long_words=False, break_on_hyphens=False
    )
    console.print(wrapped, markup=False, soft_wrap=True)


def _ground_truth_notes(source: Source, chosen: Sequence[Episode]) -> list[str]:
    without = sum(item.episode_id not in source.ground_truth for item in chosen)
    if not source.ground_truth or not without:
        return []
    return [
        f"{source.ground_truth_name} lacks {without} of these episodes: nDTW takes their "
        "reference path"
    ]
