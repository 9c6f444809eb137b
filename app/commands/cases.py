"""`c2nav cases`: sets of cases out of a folder of runs, and into another one."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console

from app.commands.options import JsonOpt, ScenesOpt
from app.commands.output import check_folder, print_json
from app.commands.surroundings import surroundings_of
from app.exports.case_sets.packing import pack_set
from app.exports.case_sets.unpacking import unpack_set
from app.pages.index.finding import Case, everything
from app.pages.index.query import Query
from app.pages.library import Library

Runs = Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="RUNS")]


def find(
    runs: Runs,
    query: Annotated[
        str, tyro.conf.arg(help='One line, as in `ending:"step limit" -tag:oscillation`.')
    ] = "",
    sort: Annotated[str, tyro.conf.arg(help="A column; `-COLUMN` greatest first.")] = "run",
    scenes: ScenesOpt = None,
    json: JsonOpt = False,
) -> int:
    """List the episodes under a folder that a line leaves, with their automatic tags."""
    library = Library(runs, scenes)
    try:
        _tell_unreadable(library)
        found = everything(library.store, Query(query, sort))
    finally:
        library.close()
    if json:
        print_json({"cases": [_plain(case) for case in found]})
        return 0
    console = Console(highlight=False)
    for case in found:
        words = [str(case.values["ending"]), *case.tags, *case.marks]
        console.print(f"{case.path}  {', '.join(words)}", markup=False, soft_wrap=True)
    return 0


def export(
    runs: Runs,
    name: Annotated[str, tyro.conf.arg(help="The set, as gathered on the cases page.")],
    out: Annotated[Path, tyro.conf.arg(help="A new folder.")],
    scenes: ScenesOpt = None,
    json: JsonOpt = False,
) -> int:
    """Write a set as a folder: traces, table, page, figures, appendix, manifest of hashes."""
    check_folder(out)
    library = Library(runs, scenes)
    try:
        _tell_unreadable(library)
        packed = pack_set(
            library, name, out, plan_of=lambda story: surroundings_of(story, scenes).plan
        )
    finally:
        library.close()
    for sha256 in packed.missing:
        sys.stderr.write(f"left out: no trace {sha256[:12]}… under {runs} any more\n")
    _say(f"{packed.folder}: {packed.cases} cases", {"folder": str(packed.folder)}, json=json)
    return 0


def import_set(
    packed: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="SET")],
    into: Annotated[Path, tyro.conf.arg(help="A folder of runs; made when absent.")],
    scenes: ScenesOpt = None,
    json: JsonOpt = False,
) -> int:
    """Check an exported set by its hashes and add it to a folder of runs."""
    check_folder(into)
    taken = unpack_set(packed, into, scenes=scenes)
    words = f"{taken.folder}: {taken.cases} cases; open them with `c2nav inspect {into}`"
    _say(words, {"folder": str(taken.folder), "cases": taken.cases}, json=json)
    return 0


def _plain(case: Case) -> dict[str, object]:
    """A case as JSON, which knows no infinity: a goal out of reach has no distance."""
    values = {name: None if value == math.inf else value for name, value in case.values.items()}
    return {"path": case.path, **values, "tags": case.tags, "marks": case.marks}


def _tell_unreadable(library: Library) -> None:
    for name, why in library.refresh().unreadable:
        sys.stderr.write(f"not read: {name}: {why}\n")


def _say(words: str, facts: dict[str, object], *, json: bool) -> None:
    if json:
        print_json(facts)
    else:
        Console(highlight=False).print(words, markup=False, soft_wrap=True)


cases = {"find": find, "export": export, "import": import_set}
