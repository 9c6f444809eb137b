"""Recorded JPEG bytes as what a model's interface takes."""

from __future__ import annotations

import base64

import cv2
import numpy as np

from c2nav_engine.contract.question import Picture


def data_url(picture: Picture, *, image_px: int = 0) -> str:
    """The picture as a data URL; the recorded bytes unless it is to be scaled down."""
    jpeg = scaled(picture, image_px) if image_px else picture.jpeg
    return f"data:image/jpeg;base64,{base64.b64encode(jpeg).decode('ascii')}"


def scaled(picture: Picture, image_px: int) -> bytes:
    """JPEG with its longest side at most `image_px`, sides rounded to multiples of 32.

    Never enlarges. The same bytes in give the same bytes out; the option stands in the record.
    """
    longest = max(picture.width_px, picture.height_px)
    if longest <= image_px:
        return picture.jpeg
    size = [
        max(32, round(side * image_px / longest / 32) * 32)
        for side in (picture.width_px, picture.height_px)
    ]
    bgr = cv2.imdecode(np.frombuffer(picture.jpeg, np.uint8), cv2.IMREAD_COLOR)
    small = cv2.resize(np.asarray(bgr), size, interpolation=cv2.INTER_AREA)
    return cv2.imencode(".jpg", small, [cv2.IMWRITE_JPEG_QUALITY, 92])[1].tobytes()
