"""`c2nav report`: the paper's tables for any runs, with intervals and paired tests."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console

from app.commands.options import JsonOpt
from app.commands.output import check_folder, print_json


def report(
    runs: Annotated[
        tuple[Path, ...],
        tyro.conf.Positional,
        tyro.conf.arg(metavar="RUN…", help="Run folders; several rankers may stand together."),
    ],
    out: Annotated[Path, tyro.conf.arg(metavar="DIR", help="Folder for the report.")],
    json: JsonOpt = False,
) -> int:
    """Write tables beside the paper's reported rows: HTML, Markdown, CSV, LaTeX, plots."""
    from app.reviews.agreement_grids import human_study
    from c2nav_engine.errors import UsageError
    from c2nav_engine.experiments.report.writing import write_report

    if not runs:
        message = "expected one or more run folders, came none; name what `c2nav run` wrote"
        raise UsageError(message)
    check_folder(out)
    study = human_study(runs)
    written = write_report(runs, out, annexes=(study,) if study else ())
    page = out / "report.html"
    if json:
        sections = [
            {
                "title": chapter.title,
                "privileged": chapter.section.privileged,
                "systems": [system.label for system in chapter.section.systems],
                "tables": [table.key for table in chapter.tables],
            }
            for chapter in written.chapters
        ]
        print_json({"report": str(page), "sections": sections})
        return 0
    console = Console(highlight=False)
    for chapter in written.chapters:
        console.print(f"{chapter.title}", markup=False)
        for note in chapter.notes:
            console.print(f"  {note}", markup=False)
    console.print(f"report at {page}", markup=False)
    return 0
