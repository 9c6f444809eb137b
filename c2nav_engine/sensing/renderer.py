"""The renderer protocol: textured colour and metric depth for level cameras."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Float32, UInt8

from c2nav_engine.geometry import Pinhole


@dataclass(frozen=True, slots=True)
class Image:
    """One rendered view.

    Attributes:
        rgb: 8-bit colour at the RGB pinhole's size.
        depth_m: Metric depth along the optical axis at every n-th row and column of the depth
            pinhole, as asked; 0 where nothing was hit or the hit lies outside the sensor's range.
        world_from_camera: Where it was taken.
    """

    rgb: UInt8[np.ndarray, "rows columns 3"]
    depth_m: Float32[np.ndarray, "depth_rows depth_columns"]
    world_from_camera: Float[np.ndarray, "4 4"]


@runtime_checkable
class Renderer(Protocol):
    """Anything that turns poses into pictures; the same pose always gives the same bytes."""

    @property
    def name(self) -> str:
        """What run records call it."""
        ...

    def render(
        self,
        world_from_cameras: Sequence[Float[np.ndarray, "4 4"]],
        *,
        rgb: Pinhole,
        depth: Pinhole,
        near_m: float,
        far_m: float,
        depth_stride: int = 1,
    ) -> list[Image]:
        """RGB and depth for several cameras in one call.

        Depths at a stride are those of the whole picture there: only every `depth_stride`-th row
        and column of it, from the first on, are asked for.
        """
        ...
