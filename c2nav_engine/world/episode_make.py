"""Episodes on any mesh: random routes over its floor, told by its own part names.

The texts are plain: turns as the path takes them, things passed with their side, the thing at the
end. A scene without usable names is told by turns alone. They serve to try a scene out; routes
with hand-made variety are what the built-in hundred is for.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from c2nav_engine.episodes.episode import Episode
from c2nav_engine.errors import SceneError
from c2nav_engine.geometry import Point, Pose, wrap_rad
from c2nav_engine.world.part_words import NamedThing, named_things
from c2nav_engine.world.scene import Scene
from c2nav_engine.world.surface import Surface

_SPACING_M = 1.0
_TURN_RAD = math.radians(40.0)
_NEAR_M = 1.6
_HEADING_RAD = math.radians(15.0)
_TRIES_PER_EPISODE = 60
_STOREY_M = 3.0


@dataclass(frozen=True, slots=True)
class MakeConfig:
    """Which routes are wanted.

    Attributes:
        shortest_m: Least start–goal distance [C]; R2R-CE's own routes begin at about 4 m.
        longest_m: Largest [C].
        apart_m: Starts, and goals, of two episodes lie at least this far apart where possible [C].
        goal_radius_m: Success radius, 3.0 m in R2R-CE.
    """

    shortest_m: float = 4.0
    longest_m: float = 17.0
    apart_m: float = 0.75
    goal_radius_m: float = 3.0


def make_episodes(
    surface: Surface,
    scene: Scene,
    *,
    count: int,
    seed: int,
    scene_id: str = "",
    config: MakeConfig | None = None,
) -> tuple[Episode, ...]:
    """Sample episodes; the same scene, surface and seed give the same ones.

    Args:
        surface: The floor of the scene, for the body that shall walk it.
        scene: Its mesh, for the names of its parts.
        count: How many.
        seed: Of the generator.
        scene_id: What the episodes call the scene; its name by default.
        config: Which routes.

    Raises:
        SceneError: The floor holds too few routes of the wanted length.
    """
    config = config or MakeConfig()
    random = np.random.default_rng(seed)
    things = named_things(scene)
    found: list[Episode] = []
    for path in _paths(surface, random, (count, config)):
        number = str(len(found) + 1)
        found.append(_episode(path, things, (number, scene_id or scene.name, config), random))
        if len(found) == count:
            return tuple(found)
    message = (
        f"scene {scene.name!r}: expected {count} routes of {config.shortest_m:g} to "
        f"{config.longest_m:g} m, came {len(found)}; ask for fewer"
    )
    raise SceneError(message)


def _paths(
    surface: Surface, random: np.random.Generator, wanted: tuple[int, MakeConfig]
) -> Iterator[list[Point]]:
    """Shortest paths between places spread over the floor."""
    count, config = wanted
    triangles = surface.triangles()
    areas = _areas(triangles)
    ends: list[tuple[Point, Point]] = []
    for attempt in range(count * _TRIES_PER_EPISODE):
        start, goal = (_place(triangles, areas, random) for _ in range(2))
        if not config.shortest_m / 2 < math.dist(start, goal) < config.longest_m:
            continue
        if _on_a_roof(surface, start):
            continue
        corners = surface.path(start, goal)
        if corners is None:
            continue
        length_m = sum(math.dist(a, b) for a, b in pairwise(corners))
        # Late tries take what there is rather than fail on a small floor.
        crowded = attempt < count * _TRIES_PER_EPISODE // 2 and any(
            math.dist(start, a) < config.apart_m or math.dist(goal, b) < config.apart_m
            for a, b in ends
        )
        if config.shortest_m <= length_m <= config.longest_m and not crowded:
            ends.append((start, goal))
            yield corners


def _areas(triangles: np.ndarray) -> np.ndarray:
    cross = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    areas = np.linalg.norm(cross, axis=1)
    return areas / areas.sum()


def _place(triangles: np.ndarray, areas: np.ndarray, random: np.random.Generator) -> Point:
    a, b, c = triangles[int(random.choice(len(triangles), p=areas))]
    u, v = sorted(random.random(2))
    x, y, z = (float(value) for value in u * a + (v - u) * b + (1.0 - v) * c)
    return (x, y, z)


def _on_a_roof(surface: Surface, point: Point) -> bool:
    """Whether another floor lies below that has no way up here: nobody walks there."""
    below = surface.snap((point[0], point[1] - _STOREY_M, point[2]))
    if below is None or below[1] > point[1] - _STOREY_M / 2:
        return False
    return not math.isfinite(surface.geodesic_m(point, below))


def _episode(
    path: Sequence[Point],
    things: Sequence[NamedThing],
    named: tuple[str, str, MakeConfig],
    random: np.random.Generator,
) -> Episode:
    episode_id, scene_id, config = named
    points = _dense(path)
    along_rad = _bearing_rad(points[0], points[min(1, len(points) - 1)])
    off_rad = float(random.choice((0.0, 0.0, 0.0, math.pi / 2, -math.pi / 2, math.pi)))
    yaw_rad = wrap_rad(round((along_rad + off_rad) / _HEADING_RAD) * _HEADING_RAD)
    length_m = sum(math.dist(a, b) for a, b in pairwise(path))
    return Episode(
        episode_id=episode_id,
        trajectory_id=episode_id,
        scene_id=scene_id,
        start=Pose(points[0], yaw_rad),
        instruction=told(points, yaw_rad, things),
        goal_m=points[-1],
        goal_radius_m=config.goal_radius_m,
        geodesic_m=round(length_m, 4),
        reference_path_m=tuple(points),
    )


def _dense(path: Sequence[Point]) -> list[Point]:
    """The path with a point at least every metre."""
    points = [path[0]]
    for a, b in pairwise(path):
        count = max(1, math.ceil(math.dist(a, b) / _SPACING_M))
        for step in range(1, count + 1):
            x, y, z = (p + (q - p) * step / count for p, q in zip(a, b, strict=True))
            points.append((x, y, z))
    return points


def told(points: Sequence[Point], yaw_rad: float, things: Sequence[NamedThing]) -> str:
    """Plain words for a path: its turns, what stands beside it, what it ends at."""
    target = _nearest(points[-1], things)
    used = {target.words} if target else set[str]()
    sentences: list[str] = []
    heading = yaw_rad
    for run in _runs(points):
        bearing = _bearing_rad(run[0], run[-1])
        sentence = _sentence(wrap_rad(bearing - heading), run, (things, used))
        sentences.append(sentence)
        heading = bearing
    end = f"next to the {target.words}" if target else "there"
    return ". ".join([*sentences, f"Stop {end}."])


def _runs(points: Sequence[Point]) -> list[list[Point]]:
    """Pieces of the path between clear turns, at least a metre and a half long but for the last."""
    runs = [[points[0]]]
    for a, b in pairwise(points):
        run = runs[-1]
        long_enough = math.dist(run[0], run[-1]) > 1.5
        bend = wrap_rad(_bearing_rad(a, b) - _bearing_rad(run[0], run[-1])) if long_enough else 0.0
        if abs(bend) > _TURN_RAD:
            runs.append([a, b])
        else:
            run.append(b)
    return runs


def _sentence(
    turn_rad: float, run: Sequence[Point], named: tuple[Sequence[NamedThing], set[str]]
) -> str:
    things, used = named
    passed = [(thing, _side(run, thing)) for thing in things if thing.words not in used]
    passed = [(thing, side) for thing, side in passed if side][:1]
    used |= {thing.words for thing, _ in passed}
    beside = "".join(f" past the {thing.words} on your {side}" for thing, side in passed)
    rise_m = run[-1][1] - run[0][1]
    way = f"go {'up' if rise_m > 0 else 'down'} the stairs" if abs(rise_m) > 1.0 else "walk"
    onward = f"{way}{beside or ('' if 'stairs' in way else ' straight on')}"
    if abs(turn_rad) > math.radians(140.0):
        return f"Turn around and {onward}"
    if abs(turn_rad) > _TURN_RAD:
        return f"Turn {'left' if turn_rad > 0 else 'right'} and {onward}"
    return onward[0].upper() + onward[1:]


def _side(run: Sequence[Point], thing: NamedThing) -> str:
    """On which side a run of the path passes a thing; "" where it does not."""
    gaps = [thing.gap_m(point) for point in run[1:-1]]
    if not gaps or min(gaps) > _NEAR_M:
        return ""
    at = run[1 + gaps.index(min(gaps))]
    heading = Pose(at, _bearing_rad(run[0], run[-1]))
    aside_rad = heading.bearing_rad(thing.centre_m)
    if not math.radians(35.0) < abs(aside_rad) < math.radians(145.0):
        return ""
    return "left" if aside_rad > 0 else "right"


def _nearest(point: Point, things: Sequence[NamedThing]) -> NamedThing | None:
    near = [thing for thing in things if thing.gap_m(point) < _NEAR_M]
    return min(near, key=lambda thing: thing.gap_m(point), default=None)


def _bearing_rad(start: Point, end: Point) -> float:
    return math.atan2(-(end[0] - start[0]), -(end[2] - start[2]))
