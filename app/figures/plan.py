"""A floor seen from above as a few rings: what maps on paper and on pages draw."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float

Ring = tuple[tuple[float, float], ...]
"""A closed outline in (x, z), metres; the last corner joins the first."""

CELL_M = 0.025
"""Grain of the raster in which triangles are joined [C]."""

STOREY_M = 0.9
"""Floor this far above or below the way walked belongs to another storey [C]."""

_MOST_CELLS = 8192
_SUBCELLS = 16.0


@dataclass(frozen=True, slots=True)
class Plan:
    """What surrounds a trajectory; empty where the scene is not to be had.

    Attributes:
        floor: Outlines of the walkable floor; holes run the other way round (non-zero rule).
        walls: Outlines of what stands at the height of the cut, filled by the same rule.
    """

    floor: tuple[Ring, ...] = ()
    walls: tuple[Ring, ...] = ()

    @property
    def empty(self) -> bool:
        """Whether there is nothing to draw."""
        return not self.floor and not self.walls


def floor_rings(
    triangles_m: Float[np.ndarray, "n 3 3"], heights_m: Sequence[float]
) -> tuple[Ring, ...]:
    """The outline of a walkable surface, near the heights that were walked."""
    low, high = min(heights_m) - STOREY_M, max(heights_m) + STOREY_M
    middle = triangles_m[:, :, 1].mean(axis=1)
    near: np.ndarray = triangles_m[(middle >= low) & (middle <= high)][:, :, (0, 2)]
    if not len(near):
        return ()
    points = near.reshape(-1, 2)
    corner: np.ndarray = points.min(axis=0) - 2 * CELL_M
    extent: np.ndarray = points.max(axis=0) + 2 * CELL_M - corner
    columns, rows = (int(cells) + 1 for cells in np.ceil(extent / CELL_M))
    if max(columns, rows) > _MOST_CELLS:
        return ()
    mask = np.zeros((rows, columns), np.uint8)
    cells: np.ndarray = np.round((near - corner) / CELL_M * _SUBCELLS)
    for polygon in list(cells.astype(np.int32)):
        cv2.fillConvexPoly(mask, polygon, (1,), shift=4)
    return rings_of(mask > 0, (float(corner[0]), float(corner[1])), CELL_M)


def rings_of(
    mask: Bool[np.ndarray, "rows columns"], corner_m: tuple[float, float], cell_m: float
) -> tuple[Ring, ...]:
    """Outlines of a raster whose first cell's centre lies at `corner_m`; specks are dropped."""
    found, _ = cv2.findContours(mask.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_SIMPLE)
    rings: list[Ring] = []
    for contour in found:
        smooth = np.asarray(cv2.approxPolyDP(contour, 1.1, closed=True)).reshape(-1, 2)
        if len(smooth) < 3 or cv2.contourArea(contour) < 12.0:
            continue
        points = np.round(smooth * cell_m + np.array(corner_m), 3)
        rings.append(tuple((float(x), float(z)) for x, z in points))
    return tuple(rings)
