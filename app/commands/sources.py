"""What `inspect` opens: live episodes of a source, or recorded traces; forks from either."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from app.reviews.audit import AuditBook, store_beside
from app.reviews.store import FILE as STORE
from app.session.opened import Choice, Entry, ForkAt, Opened, Opening, Run
from app.session.reasked import NOTHING, ByDecision, by_trace
from c2nav_engine.contract.question import Picture
from c2nav_engine.episodes.profile import Profile, profile_named
from c2nav_engine.errors import SceneError, UsageError
from c2nav_engine.experiments.rankers import RANKERS, seats_for
from c2nav_engine.experiments.spec import Setting
from c2nav_engine.experiments.working import source_of
from c2nav_engine.navigator.config import LoopConfig
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.navigator.variants import PRESETS
from c2nav_engine.rankers.capabilities import PRESETS as MODELS
from c2nav_engine.runner.opening import OpenSpec, Workbench
from c2nav_engine.runner.recorded import open_trace, read_trace
from c2nav_engine.runner.recording import TraceWriter
from c2nav_engine.runner.reshell import source_of_record
from c2nav_engine.runner.scene_cache import cache_folder, display_scene
from c2nav_engine.runner.source import Source
from c2nav_engine.runner.worlds import World, Worlds, WorldsConfig
from c2nav_engine.world.connectivity import ConnectivityGraph, connectivity_of
from c2nav_engine.world.scene import Scene
from c2nav_engine.world.surface import Surface

_THUMBNAIL_WITHIN = 8
"""Decisions of a trace among which a picture for lists is looked for [C]."""

INSPECTED = Path("logs") / "inspected"
"""Where live episodes and forks of the inspector are recorded, below the working folder."""


def opened_source(setting: Setting, *, connectivity: Path | None = None) -> Opened:
    """Live episodes of `builtin` or an episode file.

    Args:
        setting: What is asked, by whom, and where.
        connectivity: Folder of the scans' connectivity graphs, for the map.
    """
    source = source_of(setting)
    profile = profile_named(setting.profile)
    worlds = Worlds(source, WorldsConfig(profile))
    entries = tuple(
        Entry(item.episode_id, f"episode {item.episode_id} · {item.instruction}")
        for item in source.file.episodes
    )
    live = Live(source, worlds, profile, setting, connectivity=connectivity)
    return Opened(
        title=source.file.name,
        entries=entries,
        first=Choice(entries[0].entry_id, "full", setting.ranker),
        open=live.open,
        fork=live.fork,
        variants=tuple(PRESETS),
        rankers=tuple(RANKERS),
        sends_to=host_of(setting.ranker, setting.ranker_options),
        host_of=host_of,
        book=_book_of_new,
    )


class Live:
    """Opens and forks live episodes of one source."""

    def __init__(
        self,
        source: Source,
        worlds: Worlds,
        profile: Profile,
        setting: Setting,
        *,
        connectivity: Path | None = None,
    ) -> None:
        self._connectivity = connectivity
        self._source = source
        self._worlds = worlds
        self._profile = profile
        self._setting = setting

    def open(self, choice: Choice) -> Opening:
        """Start an episode under the chosen variant and ranker."""
        variant = choice.variant or "full"
        spec = OpenSpec(
            choice.entry_id,
            variant,
            run="inspected",
            trace=_fresh(f"{choice.entry_id}.{variant}"),
        )
        run = self._bench(choice.ranker or self._setting.ranker).open(spec)
        scene = run.scene
        shown = None if scene is None else partial(display_scene, scene, cache_folder())
        worlds = partial(Worlds, self._source, WorldsConfig(self._profile))
        return Opening(
            header=run.header,
            run=run,
            scene=shown,
            world=lambda: worlds().of(run.header.episode.scene_id),
            viewpoints=_viewpoints(self._connectivity, run.header.episode.scene_id),
        )

    def fork(self, wanted: ForkAt) -> Run:
        """Another answer at a decision, then the chosen ranker."""
        header = wanted.header
        spec = OpenSpec(
            header.episode.episode_id,
            header.variant,
            header.seed,
            run="inspected",
            trace=_fresh(f"{header.episode.episode_id}.{header.variant}.at{wanted.decision}"),
            config=LoopConfig.from_json(header.config),
            fork_decision=wanted.decision,
        )
        bench = self._bench(wanted.ranker or self._setting.ranker, wanted.options)
        return bench.fork(spec, wanted.exchanges, wanted.override)

    def _bench(self, ranker: str, options: Mapping[str, str] | None = None) -> Workbench:
        if options is None:
            own = ranker == self._setting.ranker
            options = self._setting.ranker_options if own else dict[str, str]()
        return Workbench(
            source=self._source,
            worlds=self._worlds,
            profile=self._profile,
            seat_for=seats_for(ranker, options),
            recorder_for=TraceWriter,
        )


def opened_traces(
    paths: Sequence[Path],
    setting: Setting,
    *,
    beside: Sequence[Path] = (),
    connectivity: Path | None = None,
) -> Opened:
    """Recorded episodes; forks where the scene is to be had.

    Args:
        paths: The traces.
        setting: Where scenes lie, and who answers in forks.
        beside: Re-evaluations whose answers stand beside the recorded ones.
        connectivity: Folder of the scans' connectivity graphs, for the map.

    Raises:
        C2NavError: A trace or re-evaluation cannot be read, or a re-evaluation is of other traces.
    """
    reasked = _reasked(paths, beside)
    entries = tuple(_entry(path) for path in paths)
    by_id = {entry.entry_id: path for entry, path in zip(entries, paths, strict=True)}
    scenes = Path(setting.scenes) if setting.scenes else None
    title = paths[0].name if len(paths) == 1 else str(paths[0].parent.parent.name)
    return Opened(
        title=title,
        entries=entries,
        first=Choice(entries[0].entry_id, ranker=setting.ranker),
        open=lambda choice: replace(
            opened := _recorded(by_id[choice.entry_id], scenes, reasked),
            viewpoints=_viewpoints(connectivity, opened.header.episode.scene_id),
        ),
        fork=partial(_fork_recorded, setting),
        rankers=tuple(RANKERS),
        book=lambda entry, sha256: (
            AuditBook(store_beside(by_id[entry]), sha256) if sha256 else _book_of_new()
        ),
        sends_to=host_of(setting.ranker, setting.ranker_options),
        host_of=host_of,
    )


def _book_of_new(entry: str = "", sha256: str = "") -> AuditBook:
    """Reviews of an episode that is being made: they go beside its trace once that is finished."""
    del entry, sha256
    return AuditBook(INSPECTED / STORE)


def _reasked(paths: Sequence[Path], files: Sequence[Path]) -> Mapping[str, ByDecision]:
    """Digest of a trace → what re-evaluations say of it; each must speak of one that is open."""
    if not files:
        return {}
    from c2nav_engine.experiments.reeval_table import read_table

    digests: set[str] = set()
    for path in paths:
        with open_trace(path) as trace:
            digests.add(trace.sha256)
    rows: list[Mapping[str, Any]] = []
    for file in files:
        own = read_table(file)
        if digests.isdisjoint(row["trace_sha256"] for row in own):
            asked = ", ".join(sorted({str(row["trace"]) for row in own})) or "nothing"
            message = (
                f"expected a re-evaluation of what is opened, came {file}, which is of {asked}; "
                "open that trace, or its run folder"
            )
            raise UsageError(message)
        rows += own
    return by_trace(rows)


def _entry(path: Path) -> Entry:
    with open_trace(path) as trace:
        header, footer = trace.header, trace.footer
    success = footer.metrics.get("success")
    return Entry(
        str(path),
        f"episode {header.episode.episode_id} · {header.variant} · {header.ranker}",
        outcome=footer.outcome.value,
        variant=header.variant,
        success=None if success is None else bool(success),
        thumbnail=partial(_first_picture, path),
    )


def _first_picture(path: Path) -> Picture | None:
    """The front view of a trace's first decision with pictures; None where the first have none."""
    with open_trace(path) as trace:
        for number in range(min(trace.decision_count, _THUMBNAIL_WITHIN)):
            request = trace.decision(number).request
            facts = request.facts if isinstance(request, Ask) else None
            pictures = [c.picture for c in facts.candidates if c.picture] if facts else []
            shown = [picture for picture in pictures if picture.jpeg]
            if shown:
                return shown[len(shown) // 2]
    return None


def _recorded(path: Path, scenes: Path | None, reasked: Mapping[str, ByDecision]) -> Opening:
    trace = read_trace(path)
    source = source_of_record(trace.header, scenes)
    scene_id = trace.header.episode.scene_id
    why = ""
    try:
        source.scene_file(scene_id)
    except SceneError as error:
        why = str(error)

    def load() -> Scene:
        return display_scene(source.scene(scene_id), cache_folder())

    def world() -> World:
        return Worlds(source, WorldsConfig(trace.header.profile)).of(scene_id)

    def floor() -> Surface:
        return world().surface

    return Opening(
        header=trace.header,
        exchanges=trace.exchanges,
        footer=trace.footer,
        trace_sha256=trace.sha256,
        source=path.name,
        trace=str(path),
        scene=None if why else load,
        surface=None if why else floor,
        no_scene=why,
        reasked=reasked.get(trace.sha256, NOTHING),
        world=None if why else world,
    )


def _viewpoints(folder: Path | None, scene_id: str) -> Callable[[], ConnectivityGraph] | None:
    return None if folder is None else partial(connectivity_of, folder, scene_id)


def _fork_recorded(setting: Setting, wanted: ForkAt) -> Run:
    header = wanted.header
    source = source_of_record(header, Path(setting.scenes) if setting.scenes else None)
    live = Live(
        source,
        Worlds(source, WorldsConfig(header.profile)),
        header.profile,
        replace(setting, source="trace"),
    )
    return live.fork(wanted)


def host_of(ranker: str, options: Mapping[str, str]) -> str:
    """Host outside this machine that pictures would go to; "" when they stay here."""
    from urllib.parse import urlsplit

    from app.gateway.doors import is_loopback

    if ranker not in RANKERS or not RANKERS[ranker].remote:
        return ""
    usual = MODELS[ranker].base_url if ranker in MODELS else ""
    host = urlsplit(options.get("base_url", usual)).hostname or ""
    return "" if is_loopback(host) else host


def _fresh(stem: str) -> Path:
    """A path for a new trace that no earlier one holds."""
    number = 0
    while True:
        path = INSPECTED / f"{stem}.{number}.mcap"
        part = path.with_name(f"{path.name}.part")
        if not path.exists() and not part.exists():
            path.parent.mkdir(parents=True, exist_ok=True)
            return path
        number += 1
