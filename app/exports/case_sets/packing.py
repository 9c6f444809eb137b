"""Writing a set: traces, table, page, figures, appendix, and a manifest over all of them."""

from __future__ import annotations

import csv
import itertools
import re
import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from app.exports.case_sets.latex import Plate, appendix
from app.exports.case_sets.manifest import Manifest, Member, digests
from app.exports.licence import licence_words
from app.figures.figure import FigureSpec, Kind, draw
from app.figures.plan import Plan
from app.figures.recipe import Run, write_figure
from app.pages.index import curation
from app.pages.index.columns import COLUMNS
from app.pages.index.finding import Case
from app.pages.library import Library
from app.pages.page import render
from app.session.story import Story, story_of
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.tags.rules import TAGS
from c2nav_engine.runner.opening import code_version
from c2nav_engine.runner.recorded import Trace, read_trace

WIDTH_IN = 5.0
"""Printed width of a case's map [C]: a column of text on A4."""

PlanOf = Callable[[Story], Plan]


@dataclass(frozen=True, slots=True)
class Packed:
    """A set on disk.

    Attributes:
        folder: Where.
        cases: How many cases are in it.
        missing: Digests of members whose traces are gone.
    """

    folder: Path
    cases: int
    missing: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Entry:
    """A case on its way into the folder.

    Attributes:
        case: As the index knows it.
        stem: Name of its files.
        said: What the set says of it.
        licence: Of the scene's pictures.
    """

    case: Case
    stem: str
    said: str
    licence: str = ""

    @property
    def caption(self) -> str:
        """What the set says, then what the index knows."""
        return _caption(self.case, self.said)


def pack_set(library: Library, name: str, folder: Path, *, plan_of: PlanOf) -> Packed:
    """Write a set into a new folder.

    Args:
        library: The runs that it was gathered from.
        name: The set.
        folder: Where; must not exist yet.
        plan_of: Floor and walls for the maps.

    Raises:
        InputError: There is no such set.
        UsageError: The folder exists already, or no trace of the set is there any more.
    """
    members = curation.members(library.store, name)
    there = [(case, caption) for case, _, caption in members if case is not None]
    if not there:
        message = f"expected a set with traces that are still there, came {name!r} without any"
        raise UsageError(message)
    if folder.exists():
        message = f"expected a new folder for the set, came {folder}; name another, or remove it"
        raise UsageError(message)
    part = folder.with_name(f"{folder.name}.part")
    shutil.rmtree(part, ignore_errors=True)
    for inner in ("traces", "figures"):
        (part / inner).mkdir(parents=True)
    entries = [
        _packed(library.trace(case), Entry(case, _stem(place, case), said), part, plan_of)
        for place, (case, said) in enumerate(there, start=1)
    ]
    _write_words(library, name, entries, part)
    part.rename(folder)
    return Packed(folder, len(entries), tuple(sha for case, sha, _ in members if case is None))


def fresh_folder(wanted: Path) -> Path:
    """That folder, or the same with the first number whose folder is not there yet."""
    numbered = (wanted.with_name(f"{wanted.name}-{number}") for number in itertools.count(2))
    return next(folder for folder in itertools.chain([wanted], numbered) if not folder.exists())


def _packed(trace: Path, entry: Entry, folder: Path, plan_of: PlanOf) -> Entry:
    """Copy and draw one case; returns it with what its trace says of pictures."""
    path = folder / "traces" / f"{entry.stem}.mcap"
    shutil.copyfile(trace, path)
    read = read_trace(path)
    _draw(read, folder / "figures" / entry.stem, plan_of)
    return replace(entry, licence=licence_words(read.header))


def _stem(place: int, case: Case) -> str:
    return f"{place:02d}-{re.sub(r'[^A-Za-z0-9.-]', '-', Path(case.path).stem)}"


def _draw(trace: Trace, stem: Path, plan_of: PlanOf) -> None:
    """The map as PDF with its recipe, and as SVG for the page."""
    story = story_of(trace.header, trace.exchanges, pending=None, footer=trace.footer)
    spec = FigureSpec(Kind.MAP, (), WIDTH_IN)
    plan = plan_of(story)
    run = Run(trace.path, trace.sha256, story)
    write_figure(spec, [run], stem.with_name(f"{stem.name}.pdf"), plan=plan)
    draw(spec, [story], plan).save(stem.with_name(f"{stem.name}.svg"))


def _caption(case: Case, said: str) -> str:
    values = case.values
    tags = [TAGS[tag].words for tag in case.tags] + list(case.marks)
    error = values["ne_m"]
    facts = [
        f"Episode {values['episode_id']} ({values['scene_id']}), {values['variant']}, "
        f"{values['ranker']}: {values['ending']}",
        f"{error:.1f} m from the goal after {values['steps']} steps"
        if isinstance(error, float)
        else "",
        ", ".join(tags),
    ]
    words = "; ".join(fact for fact in facts if fact)
    return f"{said.strip()} {words}. Instruction: “{case.instruction}”".strip()


def _write_words(library: Library, name: str, entries: Sequence[Entry], folder: Path) -> None:
    note = curation.set_named(library.store, name).note
    plates = [
        Plate(f"figures/{entry.stem}.pdf", entry.caption, f"case-{place}")
        for place, entry in enumerate(entries, start=1)
    ]
    (folder / "appendix.tex").write_text(appendix(name, note, plates), encoding="utf-8")
    _write_table(entries, folder / "cases.csv")
    page = render("case_set.html.j2", name=name, note=note, entries=entries)
    (folder / "index.html").write_text(page, encoding="utf-8")
    manifest = Manifest(
        name=name,
        note=note,
        made_with=code_version(),
        cases=tuple(_member(entry) for entry in entries),
        files=digests(folder),
    )
    manifest.write(folder)


def _write_table(entries: Sequence[Entry], path: Path) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("trace", *COLUMNS, "marks", "caption", "instruction"))
        for entry in entries:
            case = entry.case
            cells = [case.values[name] for name in COLUMNS]
            words = (" ".join(case.marks), entry.said, case.instruction)
            writer.writerow(
                [f"traces/{entry.stem}.mcap", *cells, *(" ".join(text.split()) for text in words)]
            )


def _member(entry: Entry) -> Member:
    return Member(
        file=f"traces/{entry.stem}.mcap",
        trace_sha256=entry.case.sha256,
        run=str(entry.case.values["run"]),
        caption=entry.said,
        marks=entry.case.marks,
        tags=entry.case.tags,
        licence=entry.licence,
    )
