"""All metrics of one episode: the measuring columns of `episodes.csv`."""

from __future__ import annotations

from dataclasses import dataclass

from c2nav_engine.metrics.navigation_error import navigation_error_m
from c2nav_engine.metrics.ndtw import ndtw
from c2nav_engine.metrics.oracle_success import oracle_success
from c2nav_engine.metrics.path_length import path_length_m
from c2nav_engine.metrics.sdtw import sdtw
from c2nav_engine.metrics.spl import spl
from c2nav_engine.metrics.success import success, success_zero_shot
from c2nav_engine.metrics.trajectory import Trajectory


@dataclass(frozen=True, slots=True)
class EpisodeMetrics:
    """One row's measures; None where the data holds no goal or no reference path.

    Attributes:
        ne_m: Navigation error, metres; `inf` when the goal was out of reach at the end.
        os: Oracle success, 0 or 1.
        success: Official success, 0 or 1.
        success_zero_shot: Success by the zero-shot scoring, 0 or 1.
        spl: Success weighted by path length, in [0, 1].
        ndtw: Normalised dynamic time warping, in [0, 1].
        sdtw: Success times nDTW.
        path_length_m: Metres travelled.
        steps: Low-level actions, STOP included.
        collisions: Forward moves that fell short.
    """

    ne_m: float | None
    os: int | None
    success: int | None
    success_zero_shot: int | None
    spl: float | None
    ndtw: float | None
    sdtw: float | None
    path_length_m: float
    steps: int
    collisions: int


def score(trajectory: Trajectory) -> EpisodeMetrics:
    """Every metric of method.md's list that follows from positions alone."""
    travelled_m = path_length_m(trajectory.positions_m)
    reference_m = trajectory.ground_truth_m
    closeness = ndtw(trajectory.positions_m, reference_m) if reference_m else None
    distances_m, shortest_m = trajectory.goal_distances_m, trajectory.shortest_m
    if not distances_m or shortest_m is None:
        return EpisodeMetrics(
            ne_m=None,
            os=None,
            success=None,
            success_zero_shot=None,
            spl=None,
            ndtw=closeness,
            sdtw=None,
            path_length_m=travelled_m,
            steps=trajectory.steps,
            collisions=trajectory.collisions,
        )
    succeeded = success(distances_m, stopped=trajectory.stopped)
    return EpisodeMetrics(
        ne_m=navigation_error_m(distances_m),
        os=int(oracle_success(distances_m)),
        success=int(succeeded),
        success_zero_shot=int(success_zero_shot(distances_m)),
        spl=spl(succeeded=succeeded, shortest_m=shortest_m, travelled_m=travelled_m),
        ndtw=closeness,
        sdtw=None if closeness is None else sdtw(succeeded=succeeded, ndtw=closeness),
        path_length_m=travelled_m,
        steps=trajectory.steps,
        collisions=trajectory.collisions,
    )
