"""Two runs of one episode: both ways on one map, both curves on one axis, where they part."""

from __future__ import annotations

from collections.abc import Sequence

from app.figures.graph import BOTTOM_IN, LEFT_IN, distance_at, graph_for
from app.figures.ground import draw_goal, draw_start, fitted, window_m
from app.figures.marks import numbered
from app.figures.plan import Plan
from app.figures.sheet import Sheet, Spot, wrapped
from app.figures.style import INK, QUIET, WHITE, Dash, Style
from app.session.branches import ended_words
from app.session.story import Story
from c2nav_engine.errors import UsageError

_DASHES: tuple[Dash, Dash] = ((), (3.0, 1.4))
_NAMES = ("A", "B")
_MAP_SHARE = 0.52
_GAP_IN = 0.12
_LEAD = 1.25
_NAME_IN = 0.2  # right of the curve, for the name at its end
_WIDE_IN = 5.0
"""From this width on, map and curve stand side by side."""


def draw_compare(
    stories: tuple[Story, Story],
    numbers: Sequence[int],
    *,
    width_in: float,
    plan: Plan | None = None,
    style: Style | None = None,
) -> Sheet:
    """A is solid, B dashed; numbers mark decisions of both, the first difference among them."""
    style, plan = style or Style(), plan or Plan()
    if stories[0].header.episode.episode_id != stories[1].header.episode.episode_id:
        ids = " and ".join(story.header.episode.episode_id for story in stories)
        message = f"expected two runs of one episode to compare, came episodes {ids}"
        raise UsageError(message)
    wide = width_in >= _WIDE_IN
    map_in = (width_in - _GAP_IN) * _MAP_SHARE if wide else width_in
    ground = fitted(window_m(stories), left=0.0, top=0.0, room=(map_in, 0.8 * map_in))
    left = map_in + _GAP_IN if wide else 0.0
    plot_in = max(1.0, ground.box[3] - BOTTOM_IN - 0.2) if wide else 1.1
    top = 0.2 if wide else ground.box[3] + 0.25
    box = (left + LEFT_IN, top, width_in - left - LEFT_IN - _NAME_IN, plot_in)
    words = [
        wrapped(run_words(name, s), width_in - 0.4, style.small_pt, most=2)
        for name, s in zip(_NAMES, stories, strict=True)
    ]
    lead_in = style.small_pt * _LEAD / 72.0
    foot = max(ground.box[3], top + plot_in + BOTTOM_IN) + 0.06
    sheet = Sheet(width_in, foot + sum(len(lines) for lines in words) * lead_in + 0.04)
    ground.draw(sheet, plan, stories[0])
    draw_goal(sheet, ground, stories[0], style=style)
    graph = graph_for(stories, box)
    graph.draw_axes(sheet, stories[0].header.episode.goal_radius_m, style)
    at = (box[0], top - 0.07)
    sheet.text("distance to goal, m", at, size_pt=style.small_pt, colour=QUIET)
    for story, dash in reversed(list(zip(stories, _DASHES, strict=True))):
        points = [ground.at(footstep.pose.position_m) for footstep in story.track.footsteps]
        sheet.line(points, colour=WHITE, width_pt=style.line_pt + 1.2)
        sheet.line(points, colour=INK, width_pt=style.line_pt, dash=dash)
        graph.curve(sheet, story, colour=INK, width_pt=style.line_pt, dash=dash)
    draw_start(sheet, ground, stories[0], style=style)
    _draw_ends(sheet, [ground.at(s.track.footsteps[-1].pose.position_m) for s in stories], style)
    ends = [graph.at(s.track.last_step, distance_at(s, s.track.last_step)) for s in stories]
    _draw_ends(sheet, ends, style)
    for number in dict.fromkeys([*numbers, *_parting(stories)]):
        decision = stories[0].decisions[number]
        pose = stories[0].track.footsteps[decision.step].pose
        spots = [ground.at(pose.position_m)]
        spots.append(graph.at(decision.step, distance_at(stories[0], decision.step)))
        for x, y in spots:
            sheet.line([(x, y), (x + 0.12, y - 0.12)], colour=INK, width_pt=0.5)
            numbered(sheet, (x + 0.16, y - 0.16), str(number), style=style)
    ground.bar(sheet, style)
    for lines, dash in zip(words, _DASHES, strict=True):
        y = foot + 0.62 * lead_in
        sheet.line([(0.02, y), (0.3, y)], colour=INK, width_pt=style.line_pt, dash=dash)
        for line in lines:
            foot += lead_in
            sheet.text(line, (0.36, foot - 0.02), size_pt=style.small_pt, colour=QUIET)
    return sheet


def _draw_ends(sheet: Sheet, ends: Sequence[Spot], style: Style) -> None:
    for name, (x, y) in zip(_NAMES, ends, strict=True):
        sheet.text(name, (x + 0.05, y - 0.03), size_pt=style.body_pt, bold=True, halo=True)


def _parting(stories: tuple[Story, Story]) -> list[int]:
    number = first_parting(*stories)
    return [] if number is None else [number]


def first_parting(a: Story, b: Story) -> int | None:
    """The first decision at which two runs differ: what was asked, or what was committed."""
    for one, other in zip(a.decisions, b.decisions, strict=False):
        same = (one.slot, one.step, one.elected) == (other.slot, other.step, other.elected)
        if not same or one.question != other.question:
            return one.number
    return None


def run_words(name: str, story: Story) -> str:
    """A run in one line: name, variant, ranker, seed, how it ended."""
    header = story.header
    parts = [header.variant, header.ranker, f"seed {header.seed}"]
    if header.fork_decision >= 0:
        parts.append(f"other answer at decision {header.fork_decision}")
    if story.footer is not None:
        parts.append(ended_words(story.footer))
    return f"{name}  {' · '.join(parts)}"
