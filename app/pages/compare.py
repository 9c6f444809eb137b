"""The compare page: an outcome matrix over two configurations, and two episodes in step."""

from __future__ import annotations

from collections.abc import Sequence

from app.pages.library import Library
from app.pages.matrix import CELLS, Arm, Matrix, arm_named, arms, matrix_of
from app.pages.page import framed
from app.pages.pair import MAP_PX, pair_of


def pair_page(library: Library, a: str, b: str, *, menu: Sequence[str]) -> str:
    """Two episodes; raises `InputError` for a digest that is not indexed, `TraceError`."""
    return framed(
        "pair.html.j2",
        here="compare",
        menu=menu,
        view=pair_of(library, a, b),
        width=MAP_PX[0],
        height=MAP_PX[1],
    )


def compare_page(
    library: Library, a: str = "", b: str = "", *, cell: str = "", menu: Sequence[str]
) -> str:
    """Two configurations, the first two where none are named; raises `InputError`."""
    known = arms(library)
    first = arm_named(library, a) if a else _or_none(known, 0)
    second = arm_named(library, b) if b else _or_none(known, 1)
    matrix = matrix_of(library, first, second) if first and second else None
    return framed(
        "compare.html.j2",
        here="compare",
        menu=menu,
        arms=known,
        a=first,
        b=second,
        matrix=matrix,
        cell=cell if cell in CELLS else _telling(matrix),
        unread=library.progress,
    )


def _or_none(known: list[Arm], place: int) -> Arm | None:
    return known[place] if place < len(known) else None


def _telling(matrix: Matrix | None) -> str:
    """The cell to open first: episodes that only one solves, else the fullest."""
    if matrix is None:
        return "both"
    order = ("only_a", "only_b", "neither", "both")
    return next((name for name in order if matrix.cells[name]), "both")
