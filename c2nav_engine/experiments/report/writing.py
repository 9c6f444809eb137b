"""Writes a report: one self-contained page, Markdown, CSV, LaTeX and plots."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jinja2

from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.report.content import Annex, Chapter, Report, report_of
from c2nav_engine.experiments.report.grids import Grid
from c2nav_engine.experiments.report.plots import Plot, write_plots
from c2nav_engine.experiments.report.reading import read_run
from c2nav_engine.experiments.report.writing_csv import write_csv
from c2nav_engine.experiments.report.writing_text import latex, markdown

TEMPLATE = Path(__file__).with_name("page.html.j2")


def write_report(folders: Sequence[Path], out: Path, *, annexes: Sequence[Annex] = ()) -> Report:
    """Read runs and write `report.html`, `report.md`, `csv/`, `latex/` and `plots/` below `out`.

    Args:
        folders: Run folders.
        out: Made where it is missing.
        annexes: Tables to add after those of the runs.

    Raises:
        UsageError: A folder is no run, or is named twice.
    """
    _check_distinct(folders)
    report = report_of([read_run(folder) for folder in folders], annexes)
    places = {name: out / name for name in ("csv", "latex", "plots")}
    for place in places.values():
        place.mkdir(parents=True, exist_ok=True)
    plots = [write_plots(chapter, places["plots"]) for chapter in report.chapters]
    write_csv(report, places["csv"])
    grids = [(chapter.key, grid) for chapter in report.chapters for grid in chapter.grids()]
    grids += [("", grid) for annex in report.annexes for grid in annex.grids]
    for key, grid in grids:
        (places["latex"] / f"{key}{grid.key}.tex").write_text(latex(grid), encoding="utf-8")
    (out / "report.md").write_text(_markdown(report), encoding="utf-8")
    (out / "report.html").write_text(_html(report, plots), encoding="utf-8")
    return report


def _check_distinct(folders: Sequence[Path]) -> None:
    """A run that is read twice would count its episodes twice."""
    seen: dict[Path, Path] = {}
    for folder in folders:
        place = folder.resolve()
        if place in seen:
            message = f"expected each run once, came {seen[place]} and {folder}; name it once"
            raise UsageError(message)
        seen[place] = folder


def _markdown(report: Report) -> str:
    parts = ["# Report\n"]
    parts += [f"- {_run_line(report, place)}\n" for place in range(len(report.runs))]
    for part in (*report.chapters, *report.annexes):
        parts.append(f"\n## {part.title}\n\n")
        parts += [f"{note}\n\n" for note in part.notes]
        parts += [markdown(grid) + "\n" for grid in _grids(part)]
    return "".join(parts)


def _grids(part: Chapter | Annex) -> tuple[Grid, ...]:
    return part.grids if isinstance(part, Annex) else tuple(part.grids())


def _html(report: Report, plots: Sequence[Sequence[Plot]]) -> str:
    environment = jinja2.Environment(
        autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    template = environment.from_string(TEMPLATE.read_text(encoding="utf-8"))
    return template.render(
        runs=[_run_line(report, place) for place in range(len(report.runs))],
        chapters=[
            *(_part(chapter, drawn) for chapter, drawn in zip(report.chapters, plots, strict=True)),
            *(_part(annex, ()) for annex in report.annexes),
        ],
    )


def _part(part: Chapter | Annex, plots: Sequence[Plot]) -> dict[str, Any]:
    return {
        "title": part.title,
        "notes": part.notes,
        "grids": _grids(part),
        "plots": [{"title": plot.title, "svg": _inline(plot.svg)} for plot in plots],
    }


def _inline(svg: Path) -> str:
    """The drawing without its XML prologue; matplotlib wrote it a moment ago."""
    text = svg.read_text(encoding="utf-8")
    return text[text.index("<svg") :]


def _run_line(report: Report, place: int) -> str:
    run = report.runs[place]
    manifest = run.manifest
    variants = ", ".join(run.configs)
    return (
        f"{run.folder.name}: {run.ranker} · {run.protocol.words} · {variants} · "
        f"{len(run.rows)} rows · version {manifest['code_version']} · "
        f"spec {str(manifest['spec_sha256'])[:12]}"
    )
