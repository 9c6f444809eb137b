"""Cut a scene open from above: the ceiling goes, and walls show a dark cut face.

A wall is a closed shell. Cut at a height, one looks down into it; drawing the shell's inner side
dark makes the cut read as an architect's section, whatever mesh it is, watertight or not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32, Int64

CUT_M = 1.9
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
    above = corners_m[:, :, 1] > height_m
    count = above.sum(axis=1)
    index = np.arange(len(corners_m))
    whole = count == 0
    pieces = [Soup(corners_m[whole], extra[whole], index[whole], np.zeros(whole.sum(), bool))]
    one = count == 1  # one corner above: a quad is left, two triangles
    pieces.append(_one_above(corners_m[one], extra[one], above[one], index[one], height_m))
    two = count == 2  # two corners above: a triangle is left
    pieces.append(_two_above(corners_m[two], extra[two], above[two], index[two], height_m))
    return Soup(
        np.concatenate([piece.corners_m for piece in pieces]),
        np.concatenate([piece.extra for piece in pieces]),
        np.concatenate([piece.source for piece in pieces]),
        np.concatenate([piece.cut for piece in pieces]),
    )


def _rolled(array: np.ndarray, first: np.ndarray) -> np.ndarray:
    """Each triangle's corners turned so that `first` comes first; winding is kept."""
    order = (first[:, None] + np.arange(3)) % 3
    return np.take_along_axis(array, order[:, :, None], axis=1)


def _crossing(values: np.ndarray, low: np.ndarray, high: np.ndarray, height_m: float) -> np.ndarray:
    """Values at the plane between two corners, given as [position | extra]."""
    rise = high[:, 1] - low[:, 1]
    part = (height_m - low[:, 1]) / np.where(rise == 0.0, 1.0, rise)
    return low + (high - low) * part[:, None] if len(values) else low


def _one_above(
    corners_m: np.ndarray,
    extra: np.ndarray,
    above: np.ndarray,
    index: np.ndarray,
    height_m: float,
) -> Soup:
    full = np.concatenate([corners_m, extra], axis=2)
    full = _rolled(full, above.argmax(axis=1))
    top, right, left = full[:, 0], full[:, 1], full[:, 2]
    on_right = _crossing(full, right, top, height_m)
    on_left = _crossing(full, left, top, height_m)
    first = np.stack([on_right, right, left], axis=1)
    second = np.stack([on_right, left, on_left], axis=1)
    both = np.concatenate([first, second])
    return Soup(
        both[:, :, :3], both[:, :, 3:], np.concatenate([index, index]), np.ones(len(both), bool)
    )


def _two_above(
    corners_m: np.ndarray,
    extra: np.ndarray,
    above: np.ndarray,
    index: np.ndarray,
    height_m: float,
) -> Soup:
    full = np.concatenate([corners_m, extra], axis=2)
    full = _rolled(full, (~above).argmax(axis=1))
    low, right, left = full[:, 0], full[:, 1], full[:, 2]
    on_right = _crossing(full, low, right, height_m)
    on_left = _crossing(full, low, left, height_m)
    left_over = np.stack([low, on_right, on_left], axis=1)
    return Soup(left_over[:, :, :3], left_over[:, :, 3:], index, np.ones(len(left_over), bool))
