"""How far a body strayed from the annotated path."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from c2nav_engine.geometry import Point


def off_path_m(point_m: Point, path_m: Sequence[Point]) -> float | None:
    """Horizontal distance from a polyline, metres; None without one."""
    found = off_paths_m([point_m], path_m)
    return None if found is None else float(found[0])


def off_paths_m(
    points_m: Sequence[Point], path_m: Sequence[Point]
) -> Float[np.ndarray, " n"] | None:
    """The same for many points."""
    if not path_m:
        return None
    nearest = nearest_on_path(points_m, path_m)
    return np.linalg.norm(_plane(points_m) - nearest[0], axis=1)


def along_path_m(points_m: Sequence[Point], path_m: Sequence[Point]) -> Float[np.ndarray, " n"]:
    """Length of the path up to its point that is nearest to each point, metres."""
    return nearest_on_path(points_m, path_m)[1]


def nearest_on_path(
    points_m: Sequence[Point], path_m: Sequence[Point]
) -> tuple[Float[np.ndarray, "n 2"], Float[np.ndarray, " n"]]:
    """The nearest (x, z) on a polyline of one or more corners, and the length up to there."""
    here, corners = _plane(points_m), _plane(path_m)
    if len(corners) == 1:
        return np.repeat(corners, len(here), axis=0), np.zeros(len(here))
    starts, along = corners[:-1], np.diff(corners, axis=0)
    squared = np.maximum((along * along).sum(axis=1), 1e-12)
    part = (((here[:, None] - starts) * along).sum(axis=2) / squared).clip(0.0, 1.0)
    feet = starts + along * part[:, :, None]
    rows = np.arange(len(here))
    best = np.linalg.norm(feet - here[:, None], axis=2).argmin(axis=1)
    lengths = np.linalg.norm(along, axis=1)
    before = np.concatenate([[0.0], np.cumsum(lengths)[:-1]])
    return feet[rows, best], before[best] + part[rows, best] * lengths[best]


def _plane(points_m: Sequence[Point]) -> Float[np.ndarray, "n 2"]:
    return np.array(points_m, dtype=float).reshape(-1, 3)[:, (0, 2)]
