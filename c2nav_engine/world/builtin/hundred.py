"""Making the built-in hundred: routes drawn, told and stored, always the same from the same code.

Run as a module to write the stored file anew after a change to houses or wording.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.files import write_episodes
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.errors import InternalError
from c2nav_engine.geometry import Point, Pose, wrap_rad
from c2nav_engine.world.builtin.house import House, house_of, scene_of_house
from c2nav_engine.world.builtin.houses import PLANS
from c2nav_engine.world.builtin.plan import Plan
from c2nav_engine.world.builtin.routes import Route, RouteSampler
from c2nav_engine.world.builtin.source import EPISODES_FILE
from c2nav_engine.world.builtin.wording import Told, tell
from c2nav_engine.world.surface import Surface
from c2nav_engine.world.walkable import build_surface

COUNT = 100
_SPACING_M = 1.0
"""Reference paths have a point at least this often."""
_HEADING_RAD = math.radians(15.0)
"""Start headings are multiples of this."""


def make_hundred() -> list[Episode]:
    """All built-in episodes, in their order."""
    shares = [COUNT // len(PLANS) + (k < COUNT % len(PLANS)) for k in range(len(PLANS))]
    episodes: list[Episode] = []
    for plan, share in zip(PLANS.values(), shares, strict=True):
        episodes += episodes_in(plan, share, first_id=len(episodes) + 1)
    return episodes


def episodes_in(plan: Plan, count: int, *, first_id: int) -> list[Episode]:
    """So many episodes in one house; raises `InternalError` when it has too few routes."""
    house = house_of(plan)
    surface = surface_of(house)
    random = np.random.default_rng((plan.seed, 2))
    found: list[Episode] = []
    for route, told, start in _told_routes(house, surface, random):
        episode_id = str(first_id + len(found))
        found.append(_episode(f"builtin/{plan.name}", episode_id, (route, told, start)))
        if len(found) == count:
            return _richest_first(found, first_id)
    message = f"house {plan.name}: expected {count} routes with words, came {len(found)}"
    raise InternalError(message)


def _richest_first(episodes: list[Episode], first_id: int) -> list[Episode]:
    """Renumbered so that a house opens with what shows most of it."""
    ordered = sorted(
        episodes,
        key=lambda each: (
            -min(len(each.leg_ends), 4),
            -each.instruction.count(" on your "),
            -(each.geodesic_m or 0.0),
        ),
    )
    return [
        replace(each, episode_id=str(first_id + k), trajectory_id=str(first_id + k))
        for k, each in enumerate(ordered)
    ]


def surface_of(house: House) -> Surface:
    """Where the default body can go in a house."""
    scene = scene_of_house(house)
    return build_surface(
        scene.vertices_m.astype(np.float64),
        scene.triangles,
        height_m=VLNCE.height_m,
        radius_m=VLNCE.radius_m,
        climb_m=VLNCE.climb_m,
        slope_rad=VLNCE.slope_rad,
    )


def _told_routes(
    house: House, surface: Surface, random: np.random.Generator
) -> Iterator[tuple[Route, Told, Pose]]:
    """Routes with words, spread over goals, starts and lengths."""
    goals: set[tuple[str, str]] = set()
    pairs: Counter[tuple[str, str]] = Counter()
    for route in RouteSampler(house, surface, random).draw():
        goal = (route.target.room, route.target.phrase)
        pair = (route.visits[0].room.letter, route.target.room)
        if goal in goals or pairs[pair] >= 2 or random.random() > _wanted(route):
            continue
        start = _start(route, random)
        told = tell(house, route, start.yaw_rad, random)
        if told is not None:
            goals.add(goal)
            pairs[pair] += 1
            yield route, told, start


def _wanted(route: Route) -> float:
    """Probability of keeping a route: short ones through two rooms are plentiful and dull."""
    by_rooms = {2: 0.2, 3: 0.5}.get(len(route.visits), 1.0)
    return by_rooms * min(1.0, (route.geodesic_m - 3.0) / 8.0)


def _start(route: Route, random: np.random.Generator) -> Pose:
    """The start with a heading: mostly along the way, sometimes aside or away from it."""
    along_rad = route.trail.bearing_rad(0.0, 1.0)
    draw = float(random.random())
    if draw < 0.55:
        off_rad = float(random.uniform(-20.0, 20.0))
    elif draw < 0.8:
        off_rad = float(random.choice((-90.0, 90.0)))
    else:
        off_rad = 180.0
    yaw_rad = round((along_rad + math.radians(off_rad)) / _HEADING_RAD) * _HEADING_RAD
    return Pose(_rounded(route.trail.at(0.0)), wrap_rad(yaw_rad))


def _episode(scene_id: str, episode_id: str, made: tuple[Route, Told, Pose]) -> Episode:
    route, told, start = made
    points, leg_ends = _reference(route, told.ends_m)
    return Episode(
        episode_id=episode_id,
        trajectory_id=episode_id,
        scene_id=scene_id,
        start=start,
        instruction=told.text,
        goal_m=points[-1],
        goal_radius_m=3.0,
        geodesic_m=round(route.geodesic_m, 4),
        reference_path_m=points,
        leg_ends=leg_ends,
    )


def _reference(
    route: Route, ends_m: tuple[float, ...]
) -> tuple[tuple[Point, ...], tuple[int, ...]]:
    """The path's corners, its leg ends and enough points between, with the ends' indices."""
    corners = np.array(route.corners)
    steps = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    at_corners = np.concatenate([[0.0], np.cumsum(steps)])
    length_m = float(at_corners[-1])
    ends = [min(end_m, length_m) for end_m in ends_m[:-1]] + [length_m]
    kept = sorted({0.0, length_m, *at_corners[1:-1].tolist(), *ends})
    kept = [a for a in kept if a in ends or a == 0.0 or min(abs(a - e) for e in ends) > 0.05]
    along = [0.0]
    for stop in kept[1:]:
        count = math.ceil((stop - along[-1]) / _SPACING_M)
        along += np.linspace(along[-1], stop, count + 1)[1:].tolist()
    indices = tuple(int(np.abs(np.array(along) - end).argmin()) for end in ends)
    return tuple(_rounded(route.trail.at(a)) for a in along), indices


def _rounded(point: Point) -> Point:
    x, y, z = (round(value, 4) + 0.0 for value in point)
    return (x, y, z)


def write_stored(path: Path = EPISODES_FILE) -> None:
    """Write the stored file anew."""
    write_episodes(path, make_hundred())


if __name__ == "__main__":
    write_stored()
