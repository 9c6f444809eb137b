"""Pictures for frusta: decoded once each, greyed where they were vetoed."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import cv2
import numpy as np
from jaxtyping import UInt8

from c2nav_engine.contract.question import Picture
from c2nav_engine.errors import InternalError
from c2nav_engine.sensing.encode import decode

_UNKNOWN = np.full((8, 8, 3), 128, np.uint8)
"""Stands in for a picture that the trace holds as a digest only."""


# OpenCV's functions are typed for its own array alias.
_cv: Any = cv2


def lettered(
    rgb: UInt8[np.ndarray, "rows columns 3"], letter: str
) -> UInt8[np.ndarray, "rows columns 3"]:
    """A letter in the upper left corner, drawn in place."""
    return _cv.putText(
        rgb, letter, (4, 20), _cv.FONT_HERSHEY_SIMPLEX, 0.7, (26, 32, 44), 2, _cv.LINE_AA
    )


@lru_cache(maxsize=64)
def pixels(picture: Picture, *, vetoed: bool = False) -> UInt8[np.ndarray, "rows columns 3"]:
    """Decoded pixels; pale grey for a vetoed view."""
    try:
        rgb = decode(picture)
    except InternalError:
        return _UNKNOWN
    if not vetoed:
        return rgb
    grey = (160 + rgb.mean(axis=2) / 3.0).clip(0, 255).astype(np.uint8)
    return np.repeat(grey[:, :, None], 3, axis=2)
