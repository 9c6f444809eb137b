"""`c2nav figure`: a figure for a paper, with a recipe that reproduces it."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console

from app.commands.options import JsonOpt, ScenesOpt, whole_numbers
from app.commands.output import check_file, print_json
from app.commands.surroundings import surroundings_of
from app.figures.figure import FigureSpec, Kind, inches
from app.figures.plan import Plan
from app.figures.recipe import (
    Run,
    Written,
    check_runs,
    read_recipe,
    traces_of,
    write_figure,
)
from app.session.story import story_of
from c2nav_engine.errors import UsageError
from c2nav_engine.runner.recorded import read_trace

FULL_WIDTH = "7.16in"
"""Two columns of an IEEE page; one column is 3.5in."""


def figure(
    traces: Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="TRACE…")] = (),
    out: Annotated[
        Path | None, tyro.conf.arg(metavar="FIG", help="FIG.pdf, FIG.svg or FIG.png.")
    ] = None,
    kind: Annotated[
        Kind,
        tyro.conf.EnumChoicesFromValues,
        tyro.conf.arg(metavar="KIND", help="strip, map, curve or compare."),
    ] = Kind.STRIP,
    decisions: Annotated[
        str, tyro.conf.arg(metavar="K,K", help="Decision numbers, as in 3,9,14.")
    ] = "",
    width: Annotated[
        str, tyro.conf.arg(metavar="WIDTH", help="Printed width: in, mm, cm or pt.")
    ] = FULL_WIDTH,
    scenes: ScenesOpt = None,
    recipe: Annotated[
        Path | None, tyro.conf.arg(metavar="FIG.json", help="Draw this figure again.")
    ] = None,
    json: JsonOpt = False,
) -> int:
    """Draw decisions, the map or the curve of a run, or compare two; --recipe draws one again."""
    if recipe is not None:
        return _again(recipe, out, json=json)
    if out is None or not traces:
        message = "expected TRACE and --out FIG.pdf, or --recipe FIG.json"
        raise UsageError(message)
    check_file(out, *traces)
    spec = FigureSpec(kind, whole_numbers(decisions, "decisions"), inches(width))
    runs = _runs(traces)
    plan = Plan()
    if kind in (Kind.MAP, Kind.COMPARE):
        found = surroundings_of(runs[0].story, scenes)
        plan = found.plan
        if found.why_not:
            sys.stderr.write(f"no floor on this map: {found.why_not}\n")
    _say(write_figure(spec, runs, out, plan=plan), json=json)
    return 0


def _again(path: Path, out: Path | None, *, json: bool) -> int:
    """Draw from a recipe; 1 when the bytes are not those of the first time."""
    made = read_recipe(path)
    runs = _runs(traces_of(made, path))
    check_runs(made, runs)
    target = out or path.parent / made.figure
    check_file(target, path)
    written = write_figure(made.spec, runs, target, plan=made.plan)
    comparable = target.suffix == Path(made.figure).suffix
    same = written.sha256 == made.figure_sha256 if comparable else None
    _say(written, json=json, same=same)
    if same is False:
        versions = ", ".join(f"{name} {number}" for name, number in made.made_with.items())
        sys.stderr.write(f"the figure differs from the recorded one, made with {versions}\n")
    return 1 if same is False else 0


def _runs(paths: Sequence[Path]) -> list[Run]:
    traces = [read_trace(path) for path in paths]
    return [
        Run(
            trace.path,
            trace.sha256,
            story_of(trace.header, trace.exchanges, pending=None, footer=trace.footer),
        )
        for trace in traces
    ]


def _say(written: Written, *, json: bool, same: bool | None = None) -> None:
    if json:
        facts: dict[str, object] = {
            "figure": str(written.figure),
            "recipe": str(written.recipe),
            "caption": str(written.caption),
            "sha256": written.sha256,
        }
        print_json(facts if same is None else {**facts, "identical": same})
        return
    again = {None: "", True: ", as recorded", False: ""}[same]
    Console(highlight=False).print(
        f"{written.figure}{again}; recipe {written.recipe}, caption {written.caption}",
        markup=False,
        soft_wrap=True,
    )
