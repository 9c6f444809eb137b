"""Episodes held against the connectivity graph of their scan: distances known without the scan."""

from __future__ import annotations

import math

from c2nav_engine.episodes.episode import Episode
from c2nav_engine.geometry import Point
from c2nav_engine.world.connectivity import ConnectivityGraph

OFF_VIEWPOINT_M = 1.0
"""R2R-CE's starts and goals lie within 0.92 m of a viewpoint's foot point [C]."""

LONGEST_RATIO = 1.5
"""R2R-CE's distances are 0.54 to 1.39 times those along the graph [C]: a floor that needs more
lacks a way that people walked with a tripod."""


def check_on_graph(
    episode: Episode, graph: ConnectivityGraph, surface_m: float | None = None
) -> list[str]:
    """What does not fit between an episode and its scan's graph; empty when it holds.

    Args:
        episode: Start, goal and the file's distance.
        graph: Of the episode's scan.
        surface_m: Start–goal distance on the walkable surface, where there is one.
    """
    findings = _off_graph("start", episode.start.position_m, graph)
    goal_m = episode.goal_m
    if goal_m is None:
        return findings
    findings += _off_graph("goal", goal_m, graph)
    if findings:
        return findings
    start, goal = graph.nearest(episode.start.position_m), graph.nearest(goal_m)
    along_m = graph.distance_m(start.image_id, goal.image_id)
    # Both ends may lie beside their viewpoints.
    most_m = LONGEST_RATIO * along_m + 2 * OFF_VIEWPOINT_M
    told = {"geodesic_distance": episode.geodesic_m, "walkable surface": surface_m}
    return [
        f"{what}: expected a way of at most {most_m:.1f} m, because the connectivity graph has one "
        f"of {along_m:.1f} m, came {'none' if math.isinf(length_m) else f'{length_m:.2f} m'}"
        for what, length_m in told.items()
        if length_m is not None and length_m > most_m
    ]


def _off_graph(what: str, point_m: Point, graph: ConnectivityGraph) -> list[str]:
    aside_m = math.dist(graph.nearest(point_m).foot_m, point_m)
    if aside_m <= OFF_VIEWPOINT_M:
        return []
    return [
        f"{what}: expected a place within {OFF_VIEWPOINT_M:.0f} m of a viewpoint of "
        f"{graph.scan}, came {aside_m:.2f} m from the nearest"
    ]
