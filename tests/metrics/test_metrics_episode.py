from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from c2nav_engine.geometry import Point
from c2nav_engine.metrics.episode import EpisodeMetrics, score
from c2nav_engine.metrics.ground_truth import follower_positions, geodesic_note
from c2nav_engine.metrics.path_length import path_length_m
from c2nav_engine.metrics.trajectory import Trajectory

GOAL: Point = (0.0, 0.0, 0.0)
coordinate = st.floats(-6.0, 6.0)
points = st.lists(st.tuples(coordinate, st.just(0.0), coordinate), min_size=1, max_size=12)


def walk(positions: list[Point], *, stopped: bool = True) -> Trajectory:
    distances = tuple(math.dist(point, GOAL) for point in positions)
    return Trajectory(
        positions_m=tuple(positions),
        goal_distances_m=distances,
        stopped=stopped,
        shortest_m=distances[0],
        steps=len(positions),
        collisions=0,
        ground_truth_m=(positions[0], GOAL),
    )


@given(points, st.booleans())
def test_spl_is_at_most_sr_is_at_most_osr(positions: list[Point], stopped: bool) -> None:
    metrics = score(walk(positions, stopped=stopped))
    assert metrics.spl is not None and metrics.success is not None and metrics.os is not None
    assert 0.0 <= metrics.spl <= metrics.success <= metrics.os <= 1
    assert metrics.sdtw is not None and metrics.sdtw <= metrics.success
    assert metrics.success <= (metrics.success_zero_shot or 0)


@given(points, st.data())
def test_repeated_positions_change_nothing(positions: list[Point], data: st.DataObject) -> None:
    repeated = [point for point in positions for _ in range(data.draw(st.integers(1, 3)))]
    before, after = score(walk(positions)), score(walk(repeated))
    assert replace(after, steps=before.steps) == before


def at(distance_m: float, *, stopped: bool) -> EpisodeMetrics:
    return score(walk([(5.0, 0.0, 0.0), (distance_m, 0.0, 0.0)], stopped=stopped))


def test_the_two_scorings_differ_at_the_radius_and_without_a_stop() -> None:
    assert (at(3.0, stopped=True).success, at(3.0, stopped=True).success_zero_shot) == (0, 1)
    assert (at(1.0, stopped=False).success, at(1.0, stopped=False).success_zero_shot) == (0, 1)
    assert (at(3.1, stopped=True).success, at(3.1, stopped=True).success_zero_shot) == (0, 0)


def test_the_start_counts_for_oracle_success() -> None:
    assert score(walk([(2.0, 0.0, 0.0), (9.0, 0.0, 0.0)])).os == 1


def test_a_detour_costs_spl() -> None:
    metrics = score(walk([(4.0, 0.0, 0.0), (4.0, 0.0, 2.0), (4.0, 0.0, 0.0), GOAL]))
    assert (metrics.path_length_m, metrics.spl) == (8.0, 0.5)


def test_a_start_at_the_goal_is_a_full_success() -> None:
    assert score(walk([GOAL])).spl == 1.0


def test_an_unreachable_goal_is_infinitely_far_and_no_success() -> None:
    lost = replace(walk([(1.0, 0.0, 0.0)]), goal_distances_m=(math.inf,), shortest_m=math.inf)
    metrics = score(lost)
    assert (metrics.ne_m, metrics.os, metrics.success, metrics.spl) == (math.inf, 0, 0, 0.0)


def test_a_split_without_goals_keeps_what_needs_none() -> None:
    metrics = score(replace(walk([GOAL, (1.0, 0.0, 0.0)]), goal_distances_m=(), shortest_m=None))
    assert (metrics.ne_m, metrics.success, metrics.spl, metrics.sdtw) == (None, None, None, None)
    assert metrics.path_length_m == 1.0


def test_distances_must_match_positions() -> None:
    with pytest.raises(ValueError, match="came 2 positions and 1 distances"):
        replace(walk([GOAL, GOAL]), goal_distances_m=(0.0,))
    with pytest.raises(ValueError, match="came None"):
        replace(walk([GOAL]), shortest_m=None)


@given(st.lists(st.tuples(coordinate, coordinate, coordinate), min_size=2, max_size=6))
def test_a_follower_stands_each_quarter_metre(corners: list[Point]) -> None:
    positions = follower_positions(corners)
    length_m = path_length_m(tuple(corners))
    assert positions[0] == corners[0]
    assert math.dist(positions[-1], corners[-1]) < 1e-6
    assert abs(len(positions) - 1 - length_m / 0.25) <= 1.0 + 1e-6
    assert path_length_m(positions) <= length_m + 1e-6


def test_a_follower_on_a_straight_line_and_around_a_corner() -> None:
    assert follower_positions([GOAL, (0.6, 0.0, 0.0)]) == (
        GOAL,
        (0.25, 0.0, 0.0),
        (0.5, 0.0, 0.0),
        (0.6, 0.0, 0.0),
    )
    bent = follower_positions([GOAL, (0.125, 0.0, 0.0), (0.125, 0.0, 0.5)])
    assert bent == (GOAL, (0.125, 0.0, 0.125), (0.125, 0.0, 0.375), (0.125, 0.0, 0.5))
    assert follower_positions([]) == ()


def test_a_distance_far_from_the_files_is_reported() -> None:
    assert geodesic_note(10.4, 10.0) == ""
    assert geodesic_note(10.0, None) == ""
    assert "10.60 m, but the episode file says 10.00 m" in geodesic_note(10.6, 10.0)
    assert geodesic_note(math.inf, 10.0)
