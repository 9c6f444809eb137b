"""The pinhole camera: rays of pixels and pixels of points."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, slots=True)
class Pinhole:
    """An ideal camera: x right, y up, looking along −z; pixel (0, 0) is the top left.

    Attributes:
        width_px: Columns.
        height_px: Rows.
        hfov_rad: Horizontal field of view, in (0, π).
    """

    width_px: int
    height_px: int
    hfov_rad: float

    @property
    def focal_px(self) -> float:
        """Focal length; pixels are square."""
        return self.width_px / (2.0 * math.tan(self.hfov_rad / 2.0))

    def ray_directions(self) -> Float[np.ndarray, "height width 3"]:
        """Directions through pixel centres, in the camera frame, with z = −1.

        The unit component along the optical axis makes a ray's hit parameter the metric depth.
        """
        columns = (np.arange(self.width_px) + 0.5 - self.width_px / 2.0) / self.focal_px
        rows = (self.height_px / 2.0 - np.arange(self.height_px) - 0.5) / self.focal_px
        directions = np.empty((self.height_px, self.width_px, 3))
        directions[..., 0] = columns[None, :]
        directions[..., 1] = rows[:, None]
        directions[..., 2] = -1.0
        return directions

    def project(self, points_m: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
        """(column px, row px, depth m) of points in the camera frame; depth ≤ 0 lies behind."""
        depth_m = -points_m[:, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            column = self.width_px / 2.0 + self.focal_px * points_m[:, 0] / depth_m
            row = self.height_px / 2.0 - self.focal_px * points_m[:, 1] / depth_m
        return np.stack([column, row, depth_m], axis=1)

    def unproject(
        self, pixels_px: Float[np.ndarray, "n 2"], depth_m: Float[np.ndarray, " n"]
    ) -> Float[np.ndarray, "n 3"]:
        """Points in the camera frame at (column, row) pixels and metric depths along the axis."""
        x = (pixels_px[:, 0] - self.width_px / 2.0) / self.focal_px * depth_m
        y = (self.height_px / 2.0 - pixels_px[:, 1]) / self.focal_px * depth_m
        return np.stack([x, y, -depth_m], axis=1)
