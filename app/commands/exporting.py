"""`c2nav trace export`: traces in other formats, and traces made from traces."""

from __future__ import annotations

import enum
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console

from app.commands.merging import reviews_for
from app.commands.options import JsonOpt, ScenesOpt
from app.commands.output import check_file, print_json
from app.commands.surroundings import Surroundings, surroundings_of
from app.exports.family import Member, family_of
from app.exports.html import HtmlOptions, Setting, export_html, licensed
from app.session.assessing import Assessor
from app.session.snapshot import Assessment
from c2nav_engine.errors import UsageError
from c2nav_engine.runner.recorded import read_trace
from c2nav_engine.traces.exports import (
    export_merged,
    export_ndjson,
    export_parquet,
    export_redacted,
    export_rrd,
    export_video,
)
from c2nav_engine.traces.reader import TraceFile


class Format(enum.StrEnum):
    """What a trace can become; the value is what `--to` takes."""

    RRD = "rrd"
    HTML = "html"
    NDJSON = "ndjson"
    PARQUET = "parquet"
    VIDEO = "video"
    MERGED = "merged"
    REDACTED = "redacted"


_SUFFIXES = {
    Format.RRD: ".rrd",
    Format.HTML: ".html",
    Format.NDJSON: ".ndjson",
    Format.PARQUET: ".parquet",
    Format.VIDEO: ".mp4",
    Format.MERGED: ".merged.mcap",
    Format.REDACTED: ".redacted.mcap",
}

_TOGETHER = (Format.HTML, Format.PARQUET)
"""Formats that put several traces into one file."""


@dataclass(frozen=True, slots=True)
class Wish:
    """What one export is asked for, apart from the traces.

    Attributes:
        other: The second run of `rrd`; where the reviews of `merged` are.
        scenes: Folder of scenes, for the mesh.
        no_scene: Leave the 3-D view out.
        licensed_pictures: Put licensed pictures in.
        table: Which table of `parquet`.
    """

    other: Path | None
    scenes: Path | None
    no_scene: bool
    licensed_pictures: bool
    table: str


@dataclass(frozen=True, slots=True)
class Made:
    """A file that was written, from which traces, and what a person should know of it."""

    file: Path
    size_bytes: int
    traces: tuple[Path, ...]
    notes: tuple[str, ...]


def export(
    traces: Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="TRACE…")],
    to: Annotated[
        Format,
        tyro.conf.EnumChoicesFromValues,
        tyro.conf.arg(metavar="FORMAT", help="What to make of it."),
    ],
    out: Annotated[
        Path | None,
        tyro.conf.arg(
            metavar="FILE", help="Beside the trace by default; a folder for several traces."
        ),
    ] = None,
    with_: Annotated[
        Path | None,
        tyro.conf.arg(
            name="with",
            metavar="OTHER",
            help="rrd: a second run over the first. merged: a run folder or file with reviews.",
        ),
    ] = None,
    scenes: ScenesOpt = None,
    no_scene: Annotated[
        bool, tyro.conf.arg(help="html, rrd: leave the mesh and the 3-D view out.")
    ] = False,
    with_licensed_images: Annotated[
        bool, tyro.conf.arg(help="html: put pictures of licensed scenes in; mind the licence.")
    ] = False,
    table: Annotated[
        str, tyro.conf.arg(metavar="TABLE", help="parquet: decisions or steps.")
    ] = "decisions",
    json: JsonOpt = False,
) -> int:
    """Export traces: rrd, html, ndjson, parquet, video, or new traces merged and redacted."""
    wish = Wish(with_, scenes, no_scene, with_licensed_images, table)
    _check(traces, to, wish)
    made: list[Made] = []
    targets = _targets(traces, to, out)
    for _, target in targets:
        check_file(target, *traces, *([with_] if with_ else []))
    for group, target in targets:
        target.parent.mkdir(parents=True, exist_ok=True)
        notes = tuple(_MAKERS[to](group, target, wish))
        made.append(Made(target, target.stat().st_size, group, notes))
    _say(made, json=json)
    return 0


def _say(made: Sequence[Made], *, json: bool) -> None:
    if json:
        exports = [
            {
                "file": str(each.file),
                "bytes": each.size_bytes,
                "traces": [str(path) for path in each.traces],
                "notes": list(each.notes),
            }
            for each in made
        ]
        print_json({"exports": exports})
        return
    console = Console(highlight=False)
    for each in made:
        mebibytes = each.size_bytes / 2**20
        console.print(f"{each.file}: {mebibytes:.2f} MiB", markup=False, soft_wrap=True)
        for note in each.notes:
            console.print(f"  {note}", markup=False, soft_wrap=True)


def _check(traces: Sequence[Path], to: Format, wish: Wish) -> None:
    if not traces:
        message = "expected traces to export, came none"
        raise UsageError(message)
    if wish.other is not None and to not in (Format.RRD, Format.MERGED):
        message = f"expected --with for rrd or merged alone, came {to.value}"
        raise UsageError(message)
    if wish.other is not None and len(traces) > 1:
        message = f"expected one trace beside --with, came {len(traces)}"
        raise UsageError(message)


def _targets(
    traces: Sequence[Path], to: Format, out: Path | None
) -> list[tuple[tuple[Path, ...], Path]]:
    """Which traces go into which file."""
    if to in _TOGETHER or len(traces) == 1:
        return [(tuple(traces), out or _beside(traces[0], to))]
    if out is not None and out.suffix and not out.is_dir():
        message = f"expected a folder as --out for {len(traces)} traces as {to.value}, came {out}"
        raise UsageError(message)
    folder = out
    return [
        ((path,), _beside(path, to) if folder is None else folder / _beside(path, to).name)
        for path in traces
    ]


def _beside(trace: Path, to: Format) -> Path:
    return trace.with_name(trace.name.removesuffix(".mcap") + _SUFFIXES[to])


Maker = Callable[[tuple[Path, ...], Path, Wish], Sequence[str]]
"""Traces, file and wish → notes for the person."""


def _html(traces: tuple[Path, ...], out: Path, wish: Wish) -> Sequence[str]:
    read = [read_trace(path) for path in traces]
    options = HtmlOptions(licensed_pictures=wish.licensed_pictures, no_scene=wish.no_scene)
    setting = Setting()
    if not licensed(read, options):
        setting = _setting(family_of(read), wish)
    page = export_html(read, out, options=options, setting=setting)
    return (f"{page.pictures} pictures", *page.left_out)


def _setting(members: Sequence[Member], wish: Wish) -> Setting:
    """The scene's floor plan, 3-D view and suspects, where it is to be had."""
    found = surroundings_of(members[0].story, wish.scenes)
    world = ""
    if found.scene is not None and not wish.no_scene:
        # viser takes a second to load, and most exports do without.
        from app.inspector.still.page import still_page

        world = still_page([(m.branch, m.story) for m in members], found.scene)
    return Setting(found.plan, world, found.why_not, _assessed(members, found))


def _assessed(members: Sequence[Member], found: Surroundings) -> dict[str, dict[int, Assessment]]:
    surface = found.surface
    if surface is None or members[0].story.header.episode.goal_m is None:
        return {}
    assessor = Assessor(members[0].story.header, lambda: surface)
    return {m.branch.trace_sha256: assessor.assess(m.story, ()) for m in members}


def _rrd(traces: tuple[Path, ...], out: Path, wish: Wish) -> Sequence[str]:
    found = Surroundings()
    if not wish.no_scene:
        found = surroundings_of(family_of([read_trace(traces[0])])[0].story, wish.scenes)
    with ExitStack() as files:
        first = files.enter_context(TraceFile(traces[0]))
        other = None if wish.other is None else files.enter_context(TraceFile(wish.other))
        export_rrd(first, out, other=other, scene=found.scene)
    return (f"without the mesh: {found.why_not}",) if found.why_not else ()


def _ndjson(traces: tuple[Path, ...], out: Path, _: Wish) -> Sequence[str]:
    with TraceFile(traces[0]) as trace:
        return (f"{export_ndjson(trace, out)} lines",)


def _parquet(traces: tuple[Path, ...], out: Path, wish: Wish) -> Sequence[str]:
    with ExitStack() as files:
        opened = [files.enter_context(TraceFile(path)) for path in traces]
        return (f"{export_parquet(opened, out, table=wish.table)} rows of {wish.table}",)


def _video(traces: tuple[Path, ...], out: Path, _: Wish) -> Sequence[str]:
    with TraceFile(traces[0]) as trace:
        return (f"{export_video(trace, out)} frames",)


def _merged(traces: tuple[Path, ...], out: Path, wish: Wish) -> Sequence[str]:
    with TraceFile(traces[0]) as trace:
        reviews = reviews_for(trace, wish.other)
        sha256 = export_merged(trace, out, reviews=reviews)
    return (f"{len(reviews)} reviews, sha256 {sha256}",)


def _redacted(traces: tuple[Path, ...], out: Path, _: Wish) -> Sequence[str]:
    with TraceFile(traces[0]) as trace:
        return (f"sha256 {export_redacted(trace, out)}",)


_MAKERS: dict[Format, Maker] = {
    Format.RRD: _rrd,
    Format.HTML: _html,
    Format.NDJSON: _ndjson,
    Format.PARQUET: _parquet,
    Format.VIDEO: _video,
    Format.MERGED: _merged,
    Format.REDACTED: _redacted,
}
