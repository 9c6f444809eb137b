"""Marks that say the same in colour and in grey: numbers in discs, shapes by slot."""

from __future__ import annotations

from app.figures.sheet import Sheet, Spot, width_of
from app.figures.style import BLUE, FAR, INK, WHITE, Style
from app.session.decisions import Decision

_HALF_IN = 0.028


def numbered(sheet: Sheet, at: Spot, words: str, *, style: Style, strong: bool = True) -> None:
    """A number in a white disc; strong ones are what the figure speaks of."""
    size_pt = style.small_pt
    radius_in = max(0.085, width_of(words, size_pt, bold=True) / 2.0 + 0.03)
    sheet.disc(
        at, radius_in, face=WHITE, edge=BLUE if strong else INK, width_pt=1.4 if strong else 0.7
    )
    down = at[1] + size_pt * 0.36 / 72.0
    sheet.text(words, (at[0], down), size_pt=size_pt, bold=True, anchor="center")


def shape(sheet: Sheet, decision: Decision, at: Spot, *, size: float = 1.0) -> None:
    """The slot's shape: disc, triangle, square."""
    x, y = at
    half = _HALF_IN * size
    if decision.lane == 0:
        sheet.disc(at, half, face=INK, edge=WHITE, width_pt=0.4)
        return
    corners = {
        1: [(x, y - 1.15 * half), (x + half, y + 0.8 * half), (x - half, y + 0.8 * half)],
        2: [(x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half)],
    }[decision.lane]
    sheet.rings([corners], face=INK if decision.outcome else FAR, edge=WHITE, width_pt=0.4)
