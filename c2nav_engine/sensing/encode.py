"""Pictures to bytes, once each: the same bytes go to rankers, trace and page."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from jaxtyping import Float32, UInt8

from c2nav_engine.contract.question import Picture
from c2nav_engine.errors import InternalError

# OpenCV's functions are typed for its own array alias; this is the one module that calls them.
_cv: Any = cv2

MILLIMETRES = 1000.0


@dataclass(frozen=True, slots=True)
class Encoding:
    """How pictures are written.

    Attributes:
        quality: JPEG quality, 1 to 100 [C].
        thumbnail_px: Columns of a thumbnail [C].
    """

    quality: int = 92
    thumbnail_px: int = 112


DEFAULT = Encoding()


def encode(rgb: UInt8[np.ndarray, "rows columns 3"], encoding: Encoding = DEFAULT) -> Picture:
    """JPEG of a picture; the same pixels always give the same bytes."""
    rows, columns = rgb.shape[:2]
    done, data = _cv.imencode(
        ".jpg",
        np.ascontiguousarray(rgb[..., ::-1]),
        [_cv.IMWRITE_JPEG_QUALITY, encoding.quality],
    )
    if not done:
        message = f"expected a JPEG of a {columns}×{rows} picture, OpenCV made none"
        raise InternalError(message)
    return Picture.of(data.tobytes(), width_px=columns, height_px=rows)


def decode(picture: Picture) -> UInt8[np.ndarray, "rows columns 3"]:
    """Pixels of an encoded picture, for display and export."""
    bgr = _cv.imdecode(np.frombuffer(picture.jpeg, np.uint8), _cv.IMREAD_COLOR)
    if bgr is None:
        message = f"expected JPEG bytes, came {picture.jpeg[:8]!r}… ({len(picture.jpeg)} bytes)"
        raise InternalError(message)
    return np.ascontiguousarray(bgr[..., ::-1])


def join_sector(
    left: UInt8[np.ndarray, "rows columns 3"], right: UInt8[np.ndarray, "rows columns 3"]
) -> UInt8[np.ndarray, "rows doubled 3"]:
    """Two ring views side by side: the one further left stands left.

    Sector k joins ring views 2k (at 60k°) and 2k + 1 (at 60k + 30°, which is further left).
    """
    return np.hstack([left, right])


def sectors(
    ring: list[UInt8[np.ndarray, "rows columns 3"]],
) -> list[UInt8[np.ndarray, "rows doubled 3"]]:
    """The joined sectors of a full ring in ring order."""
    return [join_sector(ring[k + 1], ring[k]) for k in range(0, len(ring), 2)]


def thumbnail(
    rgb: UInt8[np.ndarray, "rows columns 3"], encoding: Encoding = DEFAULT
) -> UInt8[np.ndarray, "small_rows small_columns 3"]:
    """A small copy for the route sketch; never larger than the picture."""
    rows, columns = rgb.shape[:2]
    small = min(encoding.thumbnail_px, columns)
    size = (small, max(1, round(rows * small / columns)))
    return np.asarray(_cv.resize(rgb, size, interpolation=_cv.INTER_AREA), np.uint8)


def depth_png(depth_m: Float32[np.ndarray, "rows columns"]) -> bytes:
    """Depth as a 16-bit PNG in millimetres, up to 65.535 m; holes (0, nan, inf) are 0."""
    millimetres = np.rint(np.nan_to_num(depth_m, nan=0.0, posinf=0.0, neginf=0.0) * MILLIMETRES)
    done, data = _cv.imencode(".png", np.clip(millimetres, 0, 65535).astype(np.uint16))
    if not done:
        message = f"expected a PNG of a {depth_m.shape} depth picture, OpenCV made none"
        raise InternalError(message)
    return data.tobytes()


def depth_from_png(png: bytes) -> Float32[np.ndarray, "rows columns"]:
    """Metres of a depth PNG, exact to half a millimetre; holes are 0."""
    millimetres = _cv.imdecode(np.frombuffer(png, np.uint8), _cv.IMREAD_UNCHANGED)
    if millimetres is None or millimetres.dtype != np.uint16:
        message = f"expected a 16-bit depth PNG, came {len(png)} bytes {png[:8]!r}…"
        raise InternalError(message)
    return millimetres.astype(np.float32) / np.float32(MILLIMETRES)
