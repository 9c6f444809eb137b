"""The ground of a map: floor and walls, goal and start, one scale for both axes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from app.figures.plan import Plan, Ring
from app.figures.sheet import Box, Sheet, Spot, width_of
from app.figures.style import BAND, FLOOR, GREEN, INK, QUIET, WALL, WHITE, Style
from app.session.story import Story
from c2nav_engine.geometry import Point

_MARGIN_M = 1.0
"""Of surroundings around what the map is about."""

_BARS_M = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0)


@dataclass(frozen=True, slots=True)
class Ground:
    """A window on the floor: −Z up, +X right, as seen from above.

    Attributes:
        box: Where it lies on the sheet.
        low_m: (x, z) of its top left corner.
        scale: Inches a metre.
    """

    box: Box
    low_m: tuple[float, float]
    scale: float

    def at(self, point_m: Point) -> Spot:
        """Where a point of the world lies on the sheet."""
        return self.spot(point_m[0], point_m[2])

    def spot(self, x_m: float, z_m: float) -> Spot:
        """The same for a point of the floor plane."""
        return (
            self.box[0] + (x_m - self.low_m[0]) * self.scale,
            self.box[1] + (z_m - self.low_m[1]) * self.scale,
        )

    def draw(self, sheet: Sheet, plan: Plan, story: Story) -> None:
        """Floor, the goal's disc on it, and the walls around."""
        sheet.rings(self._inside(plan.floor), face=FLOOR)
        circle = _goal_circle(story)
        if circle:
            sheet.rings(self._inside([circle]), face=BAND)
        sheet.rings(self._inside(plan.walls), face=WALL)

    def _inside(self, rings: Iterable[Ring]) -> list[list[Spot]]:
        return [cut for ring in rings if len(cut := self._cut(ring)) > 2]

    def visible(self, loop: Sequence[Spot]) -> list[list[Spot]]:
        """The parts of a closed line inside the window."""
        left, top, width, height = self.box
        pieces: list[list[Spot]] = [[]]
        for x, y in [*loop, loop[0]]:
            if left <= x <= left + width and top <= y <= top + height:
                pieces[-1].append((x, y))
            elif pieces[-1]:
                pieces.append([])
        return [piece for piece in pieces if len(piece) > 1]

    def bar(self, sheet: Sheet, style: Style) -> None:
        """A bar of a round length at the lower left."""
        left, top, width, height = self.box
        length_m = max(
            (bar for bar in _BARS_M if bar * self.scale <= 0.3 * width), default=_BARS_M[0]
        )
        y, x = top + height - 0.06, left + 0.06
        sheet.line([(x, y), (x + length_m * self.scale, y)], colour=WHITE, width_pt=4.0)
        sheet.line([(x, y), (x + length_m * self.scale, y)], colour=INK, width_pt=1.6)
        at = (x + length_m * self.scale + 0.05, y + 0.03)
        sheet.text(f"{length_m:g} m", at, size_pt=style.small_pt, halo=True)

    def _cut(self, ring: Ring) -> list[Spot]:
        """A ring clipped to the window (Sutherland and Hodgman)."""
        left, top, width, height = self.box
        spots = [self.spot(x, z) for x, z in ring]
        for axis, limit, sign in (
            (0, left, 1.0),
            (0, left + width, -1.0),
            (1, top, 1.0),
            (1, top + height, -1.0),
        ):
            spots = _clipped(spots, axis, (limit, sign))
        return spots


def _clipped(spots: list[Spot], axis: int, edge: tuple[float, float]) -> list[Spot]:
    limit, sign = edge
    kept: list[Spot] = []
    for before, here in zip([*spots[-1:], *spots[:-1]], spots, strict=True):
        inside = [sign * (spot[axis] - limit) >= 0.0 for spot in (before, here)]
        if inside[0] != inside[1]:
            part = (limit - before[axis]) / (here[axis] - before[axis])
            kept.append(
                (
                    before[0] + part * (here[0] - before[0]),
                    before[1] + part * (here[1] - before[1]),
                )
            )
        if inside[1]:
            kept.append(here)
    return kept


def window_m(stories: Sequence[Story]) -> tuple[float, float, float, float]:
    """(least x, least z, greatest x, greatest z) that a map of these runs must show."""
    points = [point for story in stories for point in _points(story)]
    xs, zs = [point[0] for point in points], [point[2] for point in points]
    return (
        min(xs) - _MARGIN_M,
        min(zs) - _MARGIN_M,
        max(xs) + _MARGIN_M,
        max(zs) + _MARGIN_M,
    )


def _points(story: Story) -> Iterable[Point]:
    episode = story.header.episode
    yield from (footstep.pose.position_m for footstep in story.track.footsteps)
    yield from episode.reference_path_m
    if episode.goal_m is not None:
        # The whole disc: whether a run ended inside it is what a map is looked at for.
        (x, y, z), reach = episode.goal_m, episode.goal_radius_m
        yield from ((x - reach, y, z - reach), (x + reach, y, z + reach))


def fitted(
    window: tuple[float, float, float, float], *, left: float, top: float, room: tuple[float, float]
) -> Ground:
    """A ground that shows the window as large as the room (width, greatest height) allows."""
    x0, z0, x1, z1 = window
    width, most = room
    scale = min(width / (x1 - x0), most / (z1 - z0))
    # Use the whole width: what the height limits is filled with surroundings.
    spare_m = (width / scale - (x1 - x0)) / 2.0
    height = (z1 - z0) * scale
    return Ground((left, top, width, height), (x0 - spare_m, z0), scale)


def _goal_circle(story: Story) -> Ring:
    episode = story.header.episode
    if episode.goal_m is None:
        return ()
    x, _, z = episode.goal_m
    turns = [math.tau * k / 72 for k in range(72)]
    reach = episode.goal_radius_m
    return tuple((x + reach * math.cos(t), z + reach * math.sin(t)) for t in turns)


def draw_goal(sheet: Sheet, ground: Ground, story: Story, *, style: Style) -> None:
    """The goal with its radius, and the reference path as dots."""
    episode = story.header.episode
    reference = [ground.at(point) for point in episode.reference_path_m]
    if len(reference) > 1:
        sheet.line(reference, colour=QUIET, width_pt=1.1, dash=(1.0, 2.2))
    if episode.goal_m is None:
        return
    for piece in ground.visible([ground.spot(x, z) for x, z in _goal_circle(story)]):
        sheet.line(piece, colour=GREEN, width_pt=1.2, dash=(5.0, 1.5))
    x, y = ground.at(episode.goal_m)
    for along, down in ((0.05, 0.0), (0.0, 0.05)):
        stroke = [(x - along, y - down), (x + along, y + down)]
        sheet.line(stroke, colour=GREEN, width_pt=1.6)
    words = f"goal, {episode.goal_radius_m:g} m"
    left, _, width, _ = ground.box
    fits = x + 0.07 + width_of(words, style.small_pt) <= left + width
    at = (x + 0.07 if fits else x - 0.07, max(y - 0.05, 0.1))
    sheet.text(words, at, size_pt=style.small_pt, anchor="left" if fits else "right", halo=True)


def draw_start(sheet: Sheet, ground: Ground, story: Story, *, style: Style) -> None:
    """A hollow square where the robot began."""
    footsteps = story.track.footsteps
    x, y = ground.at(footsteps[0].pose.position_m)
    onward = ground.at(footsteps[min(4, len(footsteps) - 1)].pose.position_m)
    sheet.box((x - 0.045, y - 0.045, 0.09, 0.09), face=WHITE, edge=INK, width_pt=1.2)
    at = (x, y - 0.08 if onward[1] > y + 0.02 else y + 0.16)
    sheet.text("start", at, size_pt=style.small_pt, anchor="center", halo=True)
