"""Encoders: the same pixels give the same bytes, and depth survives its round trip."""

from __future__ import annotations

import hashlib

import cv2
import numpy as np
import pytest

from c2nav_engine.errors import InternalError
from c2nav_engine.sensing.encode import (
    Encoding,
    decode,
    depth_from_png,
    depth_png,
    encode,
    join_sector,
    thumbnail,
)


def gradient(rows: int = 60, columns: int = 80) -> np.ndarray:
    y, x = np.mgrid[0:rows, 0:columns]
    return np.dstack([x * 3, y * 4, (x + y) * 1]).clip(0, 255).astype(np.uint8)


def test_encoding_is_deterministic_and_hashed():
    first, second = encode(gradient()), encode(gradient().copy())
    assert first == second
    assert first.sha256 == hashlib.sha256(first.jpeg).hexdigest()
    assert (first.width_px, first.height_px) == (80, 60)
    assert first.jpeg[:2] == b"\xff\xd8"


def test_colours_keep_their_channels():
    pure = np.zeros((16, 16, 3), np.uint8)
    pure[..., 0] = 255
    red, green, blue = decode(encode(pure))[8, 8].astype(int)
    assert red > 240
    assert max(green, blue) < 15


def test_decoding_is_close_to_what_was_encoded():
    error = np.abs(decode(encode(gradient())).astype(int) - gradient())
    assert error.mean() < 2.0


def test_quality_is_the_configured_one():
    assert len(encode(gradient(), Encoding(quality=30)).jpeg) < len(encode(gradient()).jpeg)


def test_joining_puts_the_left_picture_left():
    left, right = np.full((4, 3, 3), 1, np.uint8), np.full((4, 3, 3), 2, np.uint8)
    joined = join_sector(left, right)
    assert joined.shape == (4, 6, 3)
    assert np.array_equal(joined[:, :3], left)
    assert np.array_equal(joined[:, 3:], right)


@pytest.mark.parametrize(
    ("rows", "columns", "expected"),
    [(224, 224, (112, 112)), (480, 640, (84, 112)), (50, 60, (50, 60))],
)
def test_thumbnails_keep_the_shape_and_never_grow(rows, columns, expected):
    assert thumbnail(gradient(rows, columns)).shape == (*expected, 3)


def test_depth_survives_in_millimetres():
    depth_m = np.random.default_rng(0).uniform(0.0, 10.0, (40, 50)).astype(np.float32)
    back = depth_from_png(depth_png(depth_m))
    assert back.dtype == np.float32
    assert np.abs(back - depth_m).max() <= 0.5e-3 + 1e-6
    assert np.array_equal(depth_from_png(depth_png(back)), back)


def test_holes_of_any_kind_come_back_as_zero_and_far_is_clipped():
    depth_m = np.asarray([[0.0, np.nan, np.inf, 80.0, 1.234]], np.float32)
    assert depth_from_png(depth_png(depth_m)).tolist()[0] == pytest.approx(
        [0.0, 0.0, 0.0, 65.535, 1.234]
    )


def test_what_is_no_picture_is_refused():
    with pytest.raises(InternalError, match="expected a 16-bit depth PNG"):
        depth_from_png(b"no png")
    eight_bit = cv2.imencode(".png", np.zeros((2, 2), np.uint8))[1].tobytes()
    with pytest.raises(InternalError, match="expected a 16-bit depth PNG"):
        depth_from_png(eight_bit)
