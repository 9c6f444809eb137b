"""Grids as Markdown and as LaTeX (booktabs)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from c2nav_engine.experiments.report.grids import Grid, GridRow

_LATEX = {
    "\\": r"\textbackslash{}",
    "&": r"\&",
    "%": r"\%",
    "$": r"\$",
    "#": r"\#",
    "_": r"\_",
    "{": r"\{",
    "}": r"\}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"$<$",
    ">": r"$>$",
    "↓": r"$\downarrow$",
    "↑": r"$\uparrow$",
    "✓": r"\checkmark",
    "−": r"$-$",
    "–": "--",
    "±": r"$\pm$",
    "→": r"$\to$",
    "Δ": r"$\Delta$",
    "τ": r"$\tau$",
    "α": r"$\alpha$",
    "²": r"$^2$",
    "·": r"$\cdot$",
    "…": r"\dots{}",
    "=": "=",
}
_LATEX_PATTERN = re.compile("|".join(map(re.escape, _LATEX)))


def markdown(grid: Grid) -> str:
    """A pipe table under its heading, notes below; blocks are parted by an empty row."""
    aligned = [":--" if i < grid.text_columns else "--:" for i in range(len(grid.heads))]
    lines = [f"### {grid.title}", "", _piped(grid.heads), _piped(aligned)]
    for row, parted in _parted(grid.rows):
        if parted:
            lines.append(_piped([""] * len(grid.heads)))
        lines.append(_piped(row.cells))
    lines += ["", *(f"{note}\n" for note in grid.notes)]
    return "\n".join(lines) + "\n"


def latex(grid: Grid) -> str:
    """A booktabs `tabular`; the float around it and its caption are the paper's own."""
    columns = "l" * grid.text_columns + "c" * (len(grid.heads) - grid.text_columns)
    lines = [f"% {escaped_comment(note)}" for note in (grid.title, *grid.notes)]
    lines += [
        "% needs \\usepackage{booktabs,amssymb}",
        f"\\begin{{tabular}}{{{columns}}}",
        "\\toprule",
        _row(grid.heads),
        "\\midrule",
    ]
    for row, parted in _parted(grid.rows):
        lines += ["\\midrule"] if parted else []
        lines.append(_row(row.cells))
    return "\n".join([*lines, "\\bottomrule", "\\end{tabular}"]) + "\n"


def escaped(text: str) -> str:
    """Words as LaTeX."""
    return _LATEX_PATTERN.sub(lambda found: _LATEX[found[0]], text)


def escaped_comment(text: str) -> str:
    """Words on one comment line."""
    return " ".join(text.split())


def _row(cells: Iterable[str]) -> str:
    return " & ".join(escaped(cell) for cell in cells) + r" \\"


def _piped(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def _parted(rows: Iterable[GridRow]) -> Iterator[tuple[GridRow, bool]]:
    """Each row with whether a rule stands before it."""
    before: int | None = None
    for row in rows:
        yield row, before is not None and row.block != before
        before = row.block
