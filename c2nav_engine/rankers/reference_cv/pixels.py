"""What the pixels of one JPEG show: spots of a named colour, and how much there is far off.

The only module of this ranker that touches OpenCV. Pictures are read at most 128 px wide, so a
view costs a few milliseconds.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float32, Int32, UInt8

from c2nav_engine.contract.question import Picture
from c2nav_engine.errors import InternalError

_WIDTH_PX = 128
_COLOURLESS_CHROMA = 2.5
"""Lab chroma under which a picture's most colourful pixels count as grey: a greyscale picture has
1 at most after JPEG and rounding, while a plain grey wall in a colour picture has more."""
_SPOT_FLOOR = 0.002
"""Share of the picture under which a spot is noise."""

_COLOUR_STEPS = (16, 24, 32)
"""[C] Colours are counted in steps of these sizes; several, so that counts are seldom equal."""

Bgr = UInt8[np.ndarray, "rows columns 3"]
Hsv = UInt8[np.ndarray, "rows columns 3"]
Mask = Bool[np.ndarray, "rows columns"]


@dataclass(frozen=True, slots=True)
class Spot:
    """A connected patch of one colour.

    Attributes:
        share: Of the picture, 0 when there is none worth naming.
        across: Horizontal middle, −1 at the left edge to 1 at the right.
        top: Row of its upper edge over the height; 0.5 is the horizon of a level camera.
        reach: Row of its lower edge over the height; 1 touches the bottom.
        fill: Share of its bounding box that it fills; leaves and stripes fill little.
    """

    share: float = 0.0
    across: float = 0.0
    top: float = 0.0
    reach: float = 0.0
    fill: float = 0.0


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

    def spots(self, colour: str) -> tuple[Spot, ...]:
        """The patches of a colour, largest first."""
        mask = _COLOURS[colour].mask(self._hsv).astype(np.uint8)
        opened = cv2.morphologyEx(mask, cv2.MORPH_OPEN, np.ones((2, 2), np.uint8))
        _, _, stats, centres = cv2.connectedComponentsWithStats(opened, connectivity=8)
        rows, columns = opened.shape
        # The first component is everything that is not of the colour.
        found = [
            _spot(values, float(centre[0]), rows=rows, columns=columns)
            for values, centre in zip(stats[1:], centres[1:], strict=True)
            if values[cv2.CC_STAT_AREA] >= _SPOT_FLOOR * rows * columns
        ]
        return tuple(sorted(found, key=lambda spot: -spot.share))

    @functools.cached_property
    def variety(self) -> float:
        """How much there is to see far off: log of the number of coarse colours under the horizon.

        A wall or a cupboard close by fills that band with few colours, and so does the wall below
        a window, while a doorway, a hallway or a far room brings in a floor and what stands on
        it. Unitless, some 2 (a bare wall) to 5.
        """
        rows, columns = self._bgr.shape[:2]
        band = self._bgr[rows * 50 // 100 : rows * 62 // 100, columns // 4 : -columns // 4]
        pixels = band.reshape(-1, 3)
        counts = [len(np.unique(pixels // step, axis=0)) for step in _COLOUR_STEPS]
        return float(np.log(counts).mean())

    @functools.cached_property
    def surroundings(self) -> Float32[np.ndarray, " bins"]:
        """Colour histogram above the horizon, where walls are: another room, another histogram."""
        rows = self._bgr.shape[0]
        lab = cv2.cvtColor(self._bgr[rows // 5 : rows * 11 // 20], cv2.COLOR_BGR2LAB)
        counts = cv2.calcHist([lab], [0, 1, 2], None, [4, 12, 12], [0, 256, 104, 152, 104, 152])
        bins: Float32[np.ndarray, " bins"] = np.asarray(counts, dtype=np.float32).ravel()
        return bins / max(1.0, float(bins.sum()))


def likeness(first: Pixels, second: Pixels) -> float:
    """How alike the surroundings of two pictures are: the overlap of their histograms, 0 to 1."""
    return float(np.minimum(first.surroundings, second.surroundings).sum())


def _spot(
    stats: Int32[np.ndarray, " numbers"], middle_px: float, *, rows: int, columns: int
) -> Spot:
    _, top, width, height, area = (float(value) for value in stats)
    return Spot(
        share=area / (rows * columns),
        across=2.0 * middle_px / columns - 1.0,
        top=top / rows,
        reach=(top + height) / rows,
        fill=area / (width * height),
    )


def _decoded(jpeg: bytes) -> Bgr:
    bgr = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
    if bgr is None:
        message = f"expected a JPEG picture, came {len(jpeg)} bytes that do not decode"
        raise InternalError(message)
    scale = min(1.0, _WIDTH_PX / bgr.shape[1])
    if scale < 1.0:
        bgr = cv2.resize(bgr, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    return np.asarray(bgr, dtype=np.uint8)


@dataclass(frozen=True, slots=True)
class _Range:
    """A box of HSV as OpenCV scales it: hue 0–179 (wrapping), saturation and value 0–255."""

    hue: tuple[int, int] = (0, 179)
    saturation: tuple[int, int] = (0, 255)
    value: tuple[int, int] = (0, 255)

    def mask(self, hsv: Hsv) -> Mask:
        """Pixels inside the box."""
        hue, saturation, value = np.moveaxis(hsv, -1, 0)
        low, high = self.hue
        inside = (hue >= low) & (hue <= high) if low <= high else (hue >= low) | (hue <= high)
        for channel, (least, most) in ((saturation, self.saturation), (value, self.value)):
            inside = inside & (channel >= least) & (channel <= most)
        return inside


_COLOURS: dict[str, _Range] = {
    "red": _Range((175, 6), (130, 255), (105, 255)),
    "crimson": _Range((165, 178), (140, 255), (60, 220)),
    "coral": _Range((2, 10), (110, 190), (170, 255)),
    "mint": _Range((60, 85), (30, 110), (150, 255)),
    "plum": _Range((145, 165), (70, 255), (40, 170)),
    "maroon": _Range((168, 8), (90, 255), (40, 125)),
    "orange": _Range((7, 18), (140, 255), (150, 255)),
    "brown": _Range((4, 20), (60, 255), (40, 165)),
    "yellow": _Range((22, 34), (120, 255), (150, 255)),
    "mustard": _Range((20, 29), (130, 255), (110, 230)),
    "olive": _Range((24, 40), (80, 255), (50, 160)),
    "green": _Range((42, 85), (70, 255), (40, 255)),
    "teal": _Range((82, 97), (100, 255), (50, 180)),
    "turquoise": _Range((82, 97), (90, 255), (140, 255)),
    "blue": _Range((98, 125), (100, 255), (60, 255)),
    "navy": _Range((105, 128), (80, 255), (25, 120)),
    "lavender": _Range((120, 145), (30, 110), (140, 255)),
    "purple": _Range((128, 155), (70, 255), (40, 220)),
    "magenta": _Range((145, 170), (110, 255), (80, 255)),
    "pink": _Range((150, 178), (35, 130), (140, 255)),
    "wood": _Range((6, 21), (85, 210), (50, 225)),
    "white": _Range(saturation=(0, 30), value=(215, 255)),
    "grey": _Range(saturation=(0, 35), value=(70, 200)),
    "black": _Range(value=(0, 48)),
}
"""What the colour words mean; neighbours overlap, as they do in speech."""
