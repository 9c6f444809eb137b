"""A curve: distance to the goal over steps, decisions by slot, legs, the chosen ones numbered."""

from __future__ import annotations

from collections.abc import Sequence

from app.figures.graph import BOTTOM_IN, Graph, distance_at, graph_for
from app.figures.legs import legs_walked
from app.figures.marks import numbered, shape
from app.figures.sheet import Sheet
from app.figures.style import FAR, INK, QUIET, Style
from app.session.decisions import LANES
from app.session.story import Story
from app.session.wording import SIGNS

_LANE_IN = 0.15
_TOP_IN = 0.3
_PLOT_IN = 1.25
_NAMES_IN = 0.72


def draw_curve(
    story: Story, numbers: Sequence[int], *, width_in: float, style: Style | None = None
) -> Sheet:
    """Distance with the success band above, one lane a slot below."""
    style = style or Style()
    lanes_in = len(LANES) * _LANE_IN + 0.08
    left = _NAMES_IN
    sheet = Sheet(width_in, _TOP_IN + _PLOT_IN + BOTTOM_IN + lanes_in + 0.02)
    graph = graph_for([story], (left, _TOP_IN, width_in - left - 0.12, _PLOT_IN))
    graph.draw_axes(sheet, story.header.episode.goal_radius_m, style)
    sheet.text("distance", (0.02, _TOP_IN + 0.1), size_pt=style.small_pt, colour=QUIET)
    sheet.text("to goal, m", (0.02, _TOP_IN + 0.22), size_pt=style.small_pt, colour=QUIET)
    _draw_legs(sheet, graph, story, style)
    graph.curve(sheet, story, colour=INK, width_pt=style.line_pt)
    _draw_lanes(sheet, graph, story, style)
    for number in numbers:
        step = story.decisions[number].step
        x, y = graph.at(step, distance_at(story, step))
        sheet.line([(x, y), (x, y - 0.14)], colour=INK, width_pt=0.5)
        numbered(sheet, (x, max(y - 0.2, 0.12)), str(number), style=style)
    return sheet


def _draw_legs(sheet: Sheet, graph: Graph, story: Story, style: Style) -> None:
    legs = legs_walked(story)
    if len(legs) < 2:
        return
    _, top, _, height = graph.box
    for leg in legs:
        x = graph.at(leg.first, 0.0)[0]
        sheet.line([(x, top), (x, top + height)], colour=FAR, width_pt=0.6, dash=(2.0, 2.0))
        at = (x + 0.03, top + height - 0.05)
        sheet.text(f"leg {leg.leg + 1}", at, size_pt=style.small_pt, colour=QUIET, halo=True)


def _draw_lanes(sheet: Sheet, graph: Graph, story: Story, style: Style) -> None:
    top = _TOP_IN + _PLOT_IN + BOTTOM_IN + 0.06
    for lane, name in enumerate(LANES):
        y = top + lane * _LANE_IN
        words = f"{SIGNS[lane]} {name}"
        sheet.text(words, (0.02, y + 0.035), size_pt=style.small_pt, colour=QUIET)
    for decision in story.decisions:
        x = graph.at(decision.step, 0.0)[0]
        shape(sheet, decision, (x, top + decision.lane * _LANE_IN), size=1.25)
