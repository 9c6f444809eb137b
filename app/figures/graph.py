"""Axes of a curve over low-level steps, drawn by hand so that every label lies where it should."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from app.figures.sheet import Box, Sheet, Spot
from app.figures.style import BAND, FAR, GREEN, LINE, QUIET, Dash, Style
from app.session.story import Story

_STEPS = (1, 2, 5, 10, 20, 25, 50, 100, 200, 250, 500)
_TICKS = 6

LEFT_IN, BOTTOM_IN = 0.36, 0.34
"""Room for the numbers and names of the axes."""


@dataclass(frozen=True, slots=True)
class Graph:
    """A window on (step, metres).

    Attributes:
        box: The plotted part, without its labels.
        steps: Greatest step.
        most_m: Greatest distance.
    """

    box: Box
    steps: int
    most_m: float

    def at(self, step: float, distance_m: float) -> Spot:
        """Where a value lies on the sheet."""
        left, top, width, height = self.box
        return (
            left + width * step / self.steps,
            top + height * (1.0 - distance_m / self.most_m),
        )

    def draw_axes(self, sheet: Sheet, band_m: float, style: Style) -> None:
        """The band of success, grid lines, numbers, names with units."""
        left, top, width, height = self.box
        band_top = self.at(0, band_m)[1]
        sheet.box((left, band_top, width, top + height - band_top), face=BAND)
        rim = [(left, band_top), (left + width, band_top)]
        sheet.line(rim, colour=GREEN, width_pt=0.8, dash=(5.0, 1.5))
        down = 0.36 * style.small_pt / 72.0
        for value in _ticks(self.most_m):
            y = self.at(0, value)[1]
            sheet.line([(left, y), (left + width, y)], colour=LINE, width_pt=0.5)
            if abs(value - band_m) < 0.06 * self.most_m and value != band_m:
                continue
            at = (left - 0.05, y + down)
            sheet.text(f"{value:g}", at, size_pt=style.small_pt, anchor="right")
        sheet.text(
            f"{band_m:g}", (left - 0.05, band_top + down), size_pt=style.small_pt, anchor="right"
        )
        foot = top + height
        for value in _ticks(float(self.steps)):
            x = self.at(value, 0.0)[0]
            sheet.line([(x, foot), (x, foot + 0.03)], colour=FAR, width_pt=0.6)
            sheet.text(f"{value:g}", (x, foot + 0.14), size_pt=style.small_pt, anchor="center")
        sheet.line([(left, foot), (left + width, foot)], colour=FAR, width_pt=0.6)
        name = (left + width / 2.0, foot + 0.28)
        sheet.text("low-level step", name, size_pt=style.small_pt, colour=QUIET, anchor="center")

    def curve(
        self, sheet: Sheet, story: Story, *, colour: str, width_pt: float, dash: Dash = ()
    ) -> None:
        """Distance to the goal, broken where it is unknown."""
        piece: list[Spot] = []
        for footstep in story.track.footsteps:
            if math.isfinite(footstep.distance_m):
                piece.append(self.at(footstep.step, footstep.distance_m))
            else:
                _stroke(sheet, piece, (colour, width_pt, dash))
                piece = []
        _stroke(sheet, piece, (colour, width_pt, dash))


def _stroke(sheet: Sheet, piece: Sequence[Spot], pen: tuple[str, float, Dash]) -> None:
    colour, width_pt, dash = pen
    if len(piece) > 1:
        sheet.line(piece, colour=colour, width_pt=width_pt, dash=dash)


def _ticks(most: float) -> list[float]:
    stride = next((step for step in _STEPS if most / step <= _TICKS), _STEPS[-1])
    return [float(value) for value in range(0, int(most) + 1, stride)]


def graph_for(stories: Sequence[Story], box: Box) -> Graph:
    """Axes that hold the curves of these runs."""
    steps = max(max(story.track.last_step for story in stories), 1)
    known = [
        footstep.distance_m
        for story in stories
        for footstep in story.track.footsteps
        if math.isfinite(footstep.distance_m)
    ]
    band_m = stories[0].header.episode.goal_radius_m
    return Graph(box, steps, max([band_m * 1.4, *(value * 1.05 for value in known)]))


def distance_at(story: Story, step: int) -> float:
    """Distance to the goal after a step; 0 where it is unknown, so that a mark has a place."""
    distance_m = story.track.footsteps[min(step, story.track.last_step)].distance_m
    return distance_m if math.isfinite(distance_m) else 0.0
