"""Following the annotated v1-2 paths of the 100 episodes on a geodesic oracle."""

from __future__ import annotations

import gzip
import json
import math
from itertools import pairwise
from pathlib import Path
from statistics import fmean
from typing import Any

import pytest

from c2nav_engine.geometry import Point
from c2nav_engine.metrics.episode import EpisodeMetrics, score
from c2nav_engine.metrics.trajectory import Trajectory


def read(path: Path) -> Any:
    with gzip.open(path, "rt", encoding="utf-8") as file:
        return json.load(file)


def remaining_m(locations: list[Point], goal: Point) -> tuple[float, ...]:
    """Along the path to its end, and straight on to the goal from there."""
    distances = [math.dist(locations[-1], goal)]
    for before, after in reversed(list(pairwise(locations))):
        distances.append(distances[-1] + math.dist(before, after))
    return tuple(reversed(distances))


@pytest.fixture(scope="module")
def followed(shared: Path) -> list[EpisodeMetrics]:
    episodes = read(shared / "data" / "OpenNav_R2R-CE_100_bertidx.json.gz")["episodes"]
    truths = read(shared / "data" / "R2R_VLNCE_v1-2_val_unseen_gt.json.gz")
    rows: list[EpisodeMetrics] = []
    for episode in episodes:
        truth = truths[str(episode["episode_id"])]
        locations: list[Point] = [(x, y, z) for x, y, z in truth["locations"]]
        x, y, z = episode["goals"][0]["position"]
        trajectory = Trajectory(
            positions_m=tuple(locations),
            goal_distances_m=remaining_m(locations, (x, y, z)),
            stopped=True,
            shortest_m=episode["info"]["geodesic_distance"],
            steps=len(truth["actions"]),
            collisions=0,
            ground_truth_m=tuple(locations),
        )
        rows.append(score(trajectory))
    return rows


def test_the_ground_truth_succeeds_every_time_with_little_detour(
    followed: list[EpisodeMetrics],
) -> None:
    assert len(followed) == 100
    assert fmean(row.success or 0 for row in followed) == 1.0
    assert fmean(row.os or 0 for row in followed) == 1.0
    assert fmean(row.spl or 0.0 for row in followed) == pytest.approx(0.97, abs=0.005)


def test_the_ground_truth_follows_itself(followed: list[EpisodeMetrics]) -> None:
    assert all(row.ndtw == row.sdtw == 1.0 for row in followed)


def test_the_ground_truth_ends_near_the_goal(followed: list[EpisodeMetrics]) -> None:
    assert max(row.ne_m or 0.0 for row in followed) < 0.5
