"""A map: the way walked by leg, the chosen decisions, start and goal, from above."""

from __future__ import annotations

from collections.abc import Sequence

from app.figures.ground import Ground, draw_goal, draw_start, fitted, window_m
from app.figures.legs import LegWalked, legs_walked
from app.figures.marks import numbered, shape
from app.figures.plan import Plan
from app.figures.sheet import Sheet, Spot, wrapped
from app.figures.style import INK, QUIET, WHITE, Style, leg_dash
from app.session.story import Story

_TALLEST = 0.8
"""Greatest height of a map over its width [C]."""

_SAMPLE_IN = 0.32
_LEAD = 1.25


def draw_map(
    story: Story,
    numbers: Sequence[int],
    *,
    width_in: float,
    plan: Plan | None = None,
    style: Style | None = None,
) -> Sheet:
    """The floor where it is known, the trajectory by leg, numbers at the chosen decisions."""
    style, plan = style or Style(), plan or Plan()
    ground = fitted(window_m([story]), left=0.0, top=0.0, room=(width_in, width_in * _TALLEST))
    key = _key(story, width_in, style)
    lead_in = style.small_pt * _LEAD / 72.0
    height_in = ground.box[3] + sum(len(lines) for _, lines in key) * lead_in + 0.14
    sheet = Sheet(width_in, height_in)
    ground.draw(sheet, plan, story)
    draw_goal(sheet, ground, story, style=style)
    _draw_way(sheet, ground, story, style)
    draw_start(sheet, ground, story, style=style)
    _draw_decisions(sheet, ground, story, (numbers, style))
    ground.bar(sheet, style)
    _draw_key(sheet, key, ground.box[3] + 0.06, style)
    return sheet


def way(ground: Ground, story: Story, leg: LegWalked) -> list[Spot]:
    """A leg's way on the sheet."""
    footsteps = story.track.footsteps[leg.first : leg.last + 1]
    return [ground.at(footstep.pose.position_m) for footstep in footsteps]


def _draw_way(sheet: Sheet, ground: Ground, story: Story, style: Style) -> None:
    for leg in legs_walked(story):
        points = way(ground, story, leg)
        if len(points) > 1:
            sheet.line(points, colour=WHITE, width_pt=style.line_pt + 1.4)
            sheet.line(points, colour=INK, width_pt=style.line_pt, dash=leg_dash(leg.leg))


def _draw_decisions(
    sheet: Sheet, ground: Ground, story: Story, chosen: tuple[Sequence[int], Style]
) -> None:
    numbers, style = chosen
    for decision in story.decisions:
        place = story.track.footsteps[decision.step].pose
        if decision.lane == 0:
            shape(sheet, decision, ground.at(place.position_m))
    taken: list[Spot] = []
    for number in numbers:
        pose = story.track.footsteps[story.decisions[number].step].pose
        at = _free_spot(ground.at(pose.position_m), taken)
        sheet.line([ground.at(pose.position_m), at], colour=INK, width_pt=0.5)
        numbered(sheet, at, str(number), style=style)
        taken.append(at)


def _free_spot(at: Spot, taken: Sequence[Spot]) -> Spot:
    """Beside the place, where no other number lies."""
    for away in (0.19, 0.38, 0.57):
        for along, down in ((1, -1), (-1, -1), (1, 1), (-1, 1)):
            spot = (at[0] + 0.72 * along * away, at[1] + 0.72 * down * away)
            if all(abs(spot[0] - x) > 0.22 or abs(spot[1] - y) > 0.2 for x, y in taken):
                return spot
    return at


def _key(story: Story, width_in: float, style: Style) -> list[tuple[int, list[str]]]:
    """Legs that were walked, with their words in lines."""
    seen = sorted({leg.leg for leg in legs_walked(story)})
    room_in = width_in - _SAMPLE_IN - 0.1
    return [
        (leg, wrapped(f"{leg + 1}  {story.header.legs[leg]}", room_in, style.small_pt, most=3))
        for leg in seen
    ]


def _draw_key(sheet: Sheet, key: Sequence[tuple[int, list[str]]], top: float, style: Style) -> None:
    lead_in = style.small_pt * _LEAD / 72.0
    for leg, lines in key:
        y = top + 0.62 * lead_in
        sample = [(0.02, y), (0.02 + _SAMPLE_IN - 0.04, y)]
        sheet.line(sample, colour=INK, width_pt=style.line_pt, dash=leg_dash(leg))
        for line in lines:
            top += lead_in
            at = (_SAMPLE_IN + 0.06, top - 0.02)
            sheet.text(line, at, size_pt=style.small_pt, colour=QUIET)
