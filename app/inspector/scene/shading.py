"""Light painted into the mesh: no lamp has to be reckoned with at every pixel of every frame.

Where a browser draws without a GPU, lamps cost more than all the rest of a frame.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float32

LEVEL, ALONG_X, ALONG_Z = 1.0, 0.42, 0.58
"""Light on faces whose normal is vertical, along x, along z [C]: walls that meet at a corner
differ; floors, on which the way is drawn, are brightest."""


def shades_of(corners_m: Float32[np.ndarray, "n 3 3"]) -> Float32[np.ndarray, " n"]:
    """Share of light on each triangle, whichever way it is wound; linear, at most 1.

    The squares of a unit normal sum to 1, so a leaning face lies between the walls and the floor.
    """
    sides_m = corners_m[:, 1:] - corners_m[:, :1]
    squares = np.square(np.cross(sides_m[:, 0], sides_m[:, 1]))
    total = squares.sum(axis=1)
    light = squares @ np.array([ALONG_X, LEVEL, ALONG_Z], np.float32)
    return np.divide(light, total, out=np.full_like(total, LEVEL), where=total > 0.0)
