"""Whether an episode can be run on a scene: start, goal, distance and path against the floor."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from c2nav_engine.episodes.episode import Episode
from c2nav_engine.errors import C2NavError
from c2nav_engine.geometry import Point
from c2nav_engine.world.surface import Surface

OFF_SURFACE_M = 0.5
"""A start or goal further from its nearest floor lies off it [C]: annotations are that rough."""
GEODESIC_TOLERANCE = 0.05
"""Largest relative difference between the file's distance and the surface's (method.md)."""
_SMALLEST_M = 0.1
"""Distances this close together are equal, however short the route."""


@dataclass(frozen=True, slots=True)
class Checked:
    """One episode's row.

    Attributes:
        episode_id: Which.
        scene_id: Its scene.
        findings: What is wrong, in plain sentences; empty when the episode holds.
        geodesic_m: The surface's start–goal distance; None without a goal or a scene, `inf` when
            there is no way.
    """

    episode_id: str
    scene_id: str
    findings: tuple[str, ...]
    geodesic_m: float | None


def check_episodes(
    episodes: Iterable[Episode],
    scene_of: Callable[[str], object],
    surface_of: Callable[[str], Surface],
) -> list[Checked]:
    """Check episodes in order; a scene that cannot be opened is a finding, not an error.

    Args:
        episodes: What to check.
        scene_of: Opens a scene id; raises `C2NavError` where it cannot.
        surface_of: The floor of a scene id; asked once per run of episodes in one scene.
    """
    rows: list[Checked] = []
    opened: tuple[str, Surface | str] | None = None
    for episode in episodes:
        if opened is None or opened[0] != episode.scene_id:
            opened = (episode.scene_id, _opened(episode.scene_id, scene_of, surface_of))
        rows.append(_row(episode, opened[1]))
    return rows


def check_episode(episode: Episode, surface: Surface) -> list[str]:
    """What is wrong with one episode on its floor; empty when it holds."""
    return [
        *_point_findings("start", episode.start.position_m, surface),
        *_path_findings(episode),
        *_goal_findings(episode, surface),
    ]


def start_goal_m(episode: Episode, surface: Surface) -> float | None:
    """The surface's start–goal distance; None without a goal or off the floor."""
    if episode.goal_m is None:
        return None
    start, goal = surface.snap(episode.start.position_m), surface.snap(episode.goal_m)
    return None if start is None or goal is None else surface.geodesic_m(start, goal)


def _opened(
    scene_id: str, scene_of: Callable[[str], object], surface_of: Callable[[str], Surface]
) -> Surface | str:
    try:
        scene_of(scene_id)
        return surface_of(scene_id)
    except C2NavError as error:
        return str(error)


def _row(episode: Episode, surface: Surface | str) -> Checked:
    if isinstance(surface, str):
        return Checked(episode.episode_id, episode.scene_id, (surface,), None)
    return Checked(
        episode_id=episode.episode_id,
        scene_id=episode.scene_id,
        findings=tuple(check_episode(episode, surface)),
        geodesic_m=start_goal_m(episode, surface),
    )


def _point_findings(what: str, point_m: Point, surface: Surface) -> list[str]:
    found = surface.snap(point_m)
    shown = _written(point_m)
    if found is None:
        return [f"{what}: expected a place on the walkable surface, came {shown}, no floor near"]
    aside_m = math.dist(found, point_m)
    if aside_m > OFF_SURFACE_M:
        return [
            f"{what}: expected a place on the walkable surface, came {shown}, "
            f"{aside_m:.2f} m from the nearest floor"
        ]
    return []


def _path_findings(episode: Episode) -> list[str]:
    path = episode.reference_path_m
    if not path:
        return []
    aside_m = math.dist(path[0], episode.start.position_m)
    if aside_m > OFF_SURFACE_M:
        return [f"reference_path: expected to begin at the start, came {aside_m:.2f} m from it"]
    return []


def _goal_findings(episode: Episode, surface: Surface) -> list[str]:
    if episode.goal_m is None:
        return []
    findings = _point_findings("goal", episode.goal_m, surface)
    distance_m = start_goal_m(episode, surface)
    if distance_m is None:
        return findings
    if not math.isfinite(distance_m):
        return [*findings, "goal: expected a way from the start, came none on this surface"]
    expected_m = episode.geodesic_m
    if expected_m is None:
        return findings
    off_m = abs(distance_m - expected_m)
    if off_m > max(GEODESIC_TOLERANCE * expected_m, _SMALLEST_M):
        findings.append(
            f"geodesic_distance: expected {distance_m:.2f} m as on this surface (within 5 %), "
            f"came {expected_m:.2f} m"
        )
    return findings


def _written(point_m: Point) -> str:
    return "(" + ", ".join(f"{value:.2f}" for value in point_m) + ")"
