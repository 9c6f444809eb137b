"""The signs on paper: a colour has one meaning, and a dash or shape says it in grey."""

from __future__ import annotations

from dataclasses import dataclass

BLUE = "#0072b2"
"""What a figure speaks of: the chosen decisions, the elected view."""
GREEN = "#009e73"
"""Success: the goal and its radius."""
VERMILION = "#d55e00"
"""Fault: vetoed, always with ✕."""
INK = "#1a202c"
QUIET = "#566176"
FAR = "#8a94a6"
LINE = "#d5dae3"
FLOOR = "#eceff4"
WALL = "#5a6478"
BAND = "#d3eee5"
WELL = "#e7eaf0"
WHITE = "#ffffff"

Dash = tuple[float, ...]
"""Lengths of strokes and gaps in line widths; () is a solid line."""

LEG_DASHES: tuple[Dash, ...] = ((), (4.0, 1.6), (1.0, 1.3), (6.0, 1.5, 1.0, 1.5), (2.5, 1.2))
"""Legs are told apart by number, dash and label, never by colour alone."""

LEAST_PT = 7.0
"""No label is smaller at the printed width."""


@dataclass(frozen=True, slots=True)
class Style:
    """Sizes of a figure [C]: chosen for a two-column page.

    Attributes:
        body_pt: Text.
        small_pt: Labels; at least `LEAST_PT`.
        card_in: Narrowest card of a strip.
        gap_in: Between cards.
        block_gap_in: Between decisions.
        line_pt: Trajectories and curves.
    """

    body_pt: float = 8.0
    small_pt: float = 7.0
    card_in: float = 0.7
    gap_in: float = 0.05
    block_gap_in: float = 0.16
    line_pt: float = 1.6


def leg_dash(leg: int) -> Dash:
    """The dash of a leg, from 0."""
    return LEG_DASHES[leg % len(LEG_DASHES)]
