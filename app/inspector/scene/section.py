"""The cut face of walls, as a dark picture that lies in the cutting plane.

The outlines where the plane meets the mesh are drawn into a grid and filled by the even-odd rule;
what is thicker than a wall can be (a whole room of a scan that only has inner surfaces) stays
open. A picture of a few hundred pixels serves where exact polygons would fail on real meshes.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float32

from app.inspector.scene.cutting import rolled

CELL_M = 0.025
THICKEST_M = 0.9
"""What is filled wider than this is no wall or cupboard [C]."""

DARK = (38, 46, 62)


@dataclass(frozen=True, slots=True, eq=False)
class Section:
    """A picture in the plane y = height.

    Attributes:
        rgba: Dark where the plane cuts matter.
        centre_m: (x, z) of its middle.
        size_m: Extent along x and z.
    """

    rgba: np.ndarray
    centre_m: tuple[float, float]
    size_m: tuple[float, float]


def outlines(corners_m: Float32[np.ndarray, "n 3 3"], height_m: float) -> np.ndarray:
    """(n, 2, 2) segments in (x, z) where triangles cross the plane."""
    above = corners_m[:, :, 1] > height_m
    count = above.sum(axis=1)
    turned = np.concatenate(
        [
            # The corner that stands alone on its side of the plane owns both crossing edges.
            rolled(corners_m[count == 1], above[count == 1].argmax(axis=1)),
            rolled(corners_m[count == 2], (~above[count == 2]).argmax(axis=1)),
        ]
    )
    ends = [_meet(turned[:, 0], turned[:, other], height_m) for other in (1, 2)]
    return np.stack(ends, axis=1)


def _meet(a: np.ndarray, b: np.ndarray, height_m: float) -> np.ndarray:
    rise = b[:, 1] - a[:, 1]
    part = (height_m - a[:, 1]) / np.where(rise == 0.0, 1.0, rise)
    point = a + (b - a) * part[:, None]
    return point[:, (0, 2)]


def section_of(groups: list[np.ndarray], height_m: float) -> Section | None:
    """The cut face of groups of triangles (parts), each filled on its own."""
    lines = [line for corners_m in groups if len(line := outlines(corners_m, height_m))]
    if not lines:
        return None
    points = np.concatenate(lines).reshape(-1, 2)
    low, high = points.min(axis=0) - 4 * CELL_M, points.max(axis=0) + 4 * CELL_M
    cells = np.ceil((high - low) / CELL_M).astype(int)
    if cells.max() > 8192:
        return None
    mask = np.zeros((cells[1], cells[0]), np.uint8)
    for group in lines:
        mask |= _filled((group - low) / CELL_M, mask.shape)
    rgba = np.zeros((*mask.shape, 4), np.uint8)
    rgba[mask > 0] = (*DARK, 255)
    extent = cells * CELL_M
    centre = low + extent / 2.0
    return Section(rgba, (float(centre[0]), float(centre[1])), (float(extent[0]), float(extent[1])))


def _filled(segments: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Lines of one group, and what they enclose unless it is too thick for a wall."""
    edges = np.zeros(shape, np.uint8)
    pixels = np.round(segments * 8.0).astype(np.int32)
    cv2.polylines(edges, list(pixels), isClosed=False, color=255, thickness=1, shift=3)
    inside = _enclosed(edges)
    size = round(THICKEST_M / CELL_M) | 1
    thick = cv2.morphologyEx(inside, cv2.MORPH_OPEN, np.ones((size, size), np.uint8))
    thick = np.asarray(cv2.dilate(thick, np.ones((3, 3), np.uint8)))
    drawn = np.asarray(cv2.dilate(edges, np.ones((2, 2), np.uint8)))
    return np.where(thick > 0, 0, inside) | drawn


def _enclosed(edges: np.ndarray) -> np.ndarray:
    """Everything that some outline encloses."""
    outside = cv2.copyMakeBorder(edges, 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=(0,))
    mask = np.zeros((outside.shape[0] + 2, outside.shape[1] + 2), np.uint8)
    cv2.floodFill(outside, mask, (0, 0), (128,))
    return np.where(outside[1:-1, 1:-1] == 0, 255, 0).astype(np.uint8)
