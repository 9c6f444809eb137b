"""What the pixels of one JPEG show: spots of a named colour, and how open the floor ahead is.

The only module of this ranker that touches OpenCV. Pictures are read at most 128 px wide, so a
view costs a few milliseconds.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Int32, UInt8

from c2nav_engine.contract.question import Picture
from c2nav_engine.errors import InternalError

_WIDTH_PX = 128
_COLOURLESS_CHROMA = 8.0
"""Lab chroma under which a picture's most colourful pixels count as grey; JPEG alone gives 2–4."""
_SPOT_FLOOR = 0.002
"""Share of the picture under which a spot is noise."""

Bgr = UInt8[np.ndarray, "rows columns 3"]
Hsv = UInt8[np.ndarray, "rows columns 3"]
Mask = Bool[np.ndarray, "rows columns"]


@dataclass(frozen=True, slots=True)
class Spot:
    """The largest connected patch of one colour.

    Attributes:
        share: Of the picture, 0 when there is none worth naming.
        across: Horizontal middle, −1 at the left edge to 1 at the right.
        reach: Row of its lower edge over the height; 1 touches the bottom, 0.5 is the horizon.
    """

    share: float = 0.0
    across: float = 0.0
    reach: float = 0.0


class Pixels:
    """Measurements of one picture, made when asked for."""

    def __init__(self, picture: Picture) -> None:
        self._bgr = _decoded(picture.jpeg)
        self._hsv: Hsv = np.asarray(cv2.cvtColor(self._bgr, cv2.COLOR_BGR2HSV), dtype=np.uint8)

    @functools.cached_property
    def colourless(self) -> bool:
        """Whether the picture is grey all over, so that colour cannot speak."""
        lab = np.asarray(cv2.cvtColor(self._bgr, cv2.COLOR_BGR2LAB), dtype=np.float32) - 128.0
        chroma = np.hypot(lab[..., 1], lab[..., 2])
        return bool(np.percentile(chroma, 99.0) < _COLOURLESS_CHROMA)

    def spot(self, colour: str) -> Spot:
        """The largest patch of a basic colour term."""
        mask = _COLOURS[colour](*np.moveaxis(self._hsv.astype(np.int16), -1, 0))
        opened = cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
        count, _, stats, centres = cv2.connectedComponentsWithStats(opened, connectivity=8)
        if count < 2:
            return Spot()
        largest = 1 + int(np.argmax(stats[1:, cv2.CC_STAT_AREA]))
        rows, columns = opened.shape
        share = float(stats[largest, cv2.CC_STAT_AREA]) / (rows * columns)
        if share < _SPOT_FLOOR:
            return Spot()
        lower = float(stats[largest, cv2.CC_STAT_TOP] + stats[largest, cv2.CC_STAT_HEIGHT])
        return Spot(share, 2.0 * float(centres[largest][0]) / columns - 1.0, lower / rows)

    @functools.cached_property
    def openness(self) -> float:
        """How far up the floor reaches in the middle third, 0 (blocked) to 1 (to the horizon).

        Pixels like the strip at the bottom and connected to it count as floor. A textured floor
        or a shadow can hide some of it: secondary evidence only.
        """
        floor = _floor(self._bgr)
        rows, columns = floor.shape
        below = floor[rows // 2 :, columns // 3 : 2 * columns // 3]
        return float(np.mean(below))


def _decoded(jpeg: bytes) -> Bgr:
    bgr = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
    if bgr is None:
        message = f"expected a JPEG picture, came {len(jpeg)} bytes that do not decode"
        raise InternalError(message)
    scale = min(1.0, _WIDTH_PX / bgr.shape[1])
    if scale < 1.0:
        bgr = cv2.resize(bgr, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    return np.asarray(bgr, dtype=np.uint8)


def _floor(bgr: Bgr) -> Mask:
    smooth = cv2.medianBlur(bgr, 5)
    lab: Float[np.ndarray, "rows columns 3"] = np.asarray(
        cv2.cvtColor(smooth, cv2.COLOR_BGR2LAB), dtype=np.float64
    )
    rows, columns = lab.shape[:2]
    strip = lab[-max(2, rows // 16) :, columns // 4 : 3 * columns // 4].reshape(-1, 3)
    colour = np.median(strip, axis=0)
    # Light falls off along a floor: brightness may drift more than hue.
    apart = np.abs(lab - colour) * np.array([0.5, 1.0, 1.0])
    alike = (np.linalg.norm(apart, axis=-1) < 16.0).astype(np.uint8)
    patches: Int32[np.ndarray, "rows columns"] = np.asarray(
        cv2.connectedComponents(alike, connectivity=4)[1], dtype=np.int32
    )
    under: list[int] = np.unique(patches[-1, columns // 4 : 3 * columns // 4]).tolist()
    return np.isin(patches, [patch for patch in under if patch > 0])


def _hue(low: int, high: int, *, saturation: int, value: int) -> Callable[..., Mask]:
    """Pixels of a hue interval (OpenCV's 0–179, wrapping) above a saturation and a value."""

    def mask(hue: np.ndarray, sat: np.ndarray, val: np.ndarray) -> Mask:
        inside = (hue >= low) & (hue <= high) if low <= high else (hue >= low) | (hue <= high)
        return inside & (sat >= saturation) & (val >= value)

    return mask


def _brown(hue: np.ndarray, sat: np.ndarray, val: np.ndarray) -> Mask:
    return (hue >= 4) & (hue <= 20) & (sat >= 60) & (val >= 40) & (val < 165)


def _orange(hue: np.ndarray, sat: np.ndarray, val: np.ndarray) -> Mask:
    return (hue >= 7) & (hue <= 19) & (sat >= 130) & (val >= 165)


def _pink(hue: np.ndarray, sat: np.ndarray, val: np.ndarray) -> Mask:
    pale_red = ((hue >= 165) | (hue <= 6)) & (sat >= 45) & (sat < 130) & (val >= 150)
    return pale_red | ((hue >= 150) & (hue < 165) & (sat >= 45) & (val >= 130))


def _white(_hue: np.ndarray, sat: np.ndarray, val: np.ndarray) -> Mask:
    return (sat < 30) & (val >= 215)


def _grey(_hue: np.ndarray, sat: np.ndarray, val: np.ndarray) -> Mask:
    return (sat < 35) & (val >= 70) & (val < 200)


def _black(_hue: np.ndarray, _sat: np.ndarray, val: np.ndarray) -> Mask:
    return val < 48


_COLOURS: dict[str, Callable[..., Mask]] = {
    "red": _hue(170, 6, saturation=130, value=60),
    "orange": _orange,
    "yellow": _hue(20, 34, saturation=110, value=130),
    "green": _hue(36, 84, saturation=60, value=40),
    "blue": _hue(95, 128, saturation=90, value=45),
    "purple": _hue(129, 155, saturation=60, value=45),
    "pink": _pink,
    "brown": _brown,
    "white": _white,
    "grey": _grey,
    "black": _black,
}
"""Basic colour terms in HSV, as OpenCV scales it."""
