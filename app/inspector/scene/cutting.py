"""Cut a scene open from above: the ceiling goes, and walls show a dark cut face.

A wall is a closed shell. Cut at a height, one looks down into it; drawing the shell's inner side
dark makes the cut read as an architect's section, whatever mesh it is, watertight or not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Int64

CUT_M = 1.6
"""Height of the cut above the floor the body stands on [C]: below door lintels, above tables."""


@dataclass(frozen=True, slots=True, eq=False)
class Soup:
    """Triangles by their corners, with what is interpolated along an edge.

    Attributes:
        corners_m: Corner positions.
        extra: Further corner values (texture coordinates, colours).
        source: Index of the triangle that each came from.
        cut: Whether the cut passed through it.
    """

    corners_m: Float32[np.ndarray, "n 3 3"]
    extra: Float32[np.ndarray, "n 3 k"]
    source: Int64[np.ndarray, " n"]
    cut: Bool[np.ndarray, " n"]


def cut_below(
    corners_m: Float32[np.ndarray, "n 3 3"], extra: Float32[np.ndarray, "n 3 k"], height_m: float
) -> Soup:
    """What lies below a horizontal plane, triangles on it clipped."""
    full = np.concatenate([corners_m, extra], axis=2)
    above = full[:, :, 1] > height_m
    count = above.sum(axis=1)
    index = np.arange(len(full))
    whole = count == 0
    first, second = count == 1, count == 2
    lone = np.concatenate([above[first].argmax(axis=1), (~above[second]).argmax(axis=1)])
    turned = rolled(np.concatenate([full[first], full[second]]), lone)
    quads, tips = turned[: first.sum()], turned[first.sum() :]
    pieces = [full[whole], *_one_above(quads, height_m), _two_above(tips, height_m)]
    sources = [index[whole], index[first], index[first], index[second]]
    joined = np.concatenate(pieces)
    clipped = np.ones(len(joined), dtype=np.bool_)
    clipped[: len(pieces[0])] = False
    return Soup(joined[:, :, :3], joined[:, :, 3:], np.concatenate(sources), clipped)


def rolled(triangles: np.ndarray, first: np.ndarray) -> np.ndarray:
    """Each triangle's corners turned so that `first` comes first; winding is kept."""
    order = (first[:, None] + np.arange(3)) % 3
    return np.take_along_axis(triangles, order[:, :, None], axis=1)


def _crossing(low: np.ndarray, high: np.ndarray, height_m: float) -> np.ndarray:
    """Corner values at the plane between two corners; the height is the second value."""
    rise = high[:, 1] - low[:, 1]
    part = (height_m - low[:, 1]) / np.where(rise == 0.0, 1.0, rise)
    return low + (high - low) * part[:, None]


def _one_above(triangles: np.ndarray, height_m: float) -> tuple[np.ndarray, np.ndarray]:
    """The first corner is cut off: a quad is left, as two triangles."""
    top, right, left = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    on_right, on_left = _crossing(right, top, height_m), _crossing(left, top, height_m)
    return np.stack([on_right, right, left], axis=1), np.stack([on_right, left, on_left], axis=1)


def _two_above(triangles: np.ndarray, height_m: float) -> np.ndarray:
    """Only the first corner is left."""
    low, right, left = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    return np.stack([low, _crossing(low, right, height_m), _crossing(low, left, height_m)], axis=1)
