"""sRGB and linear light as tables, for compiled kernels."""

from __future__ import annotations

import numpy as np

from c2nav_engine.world.compiled import compiled

_LEVELS = np.arange(256) / 255.0
DECODED = np.where(_LEVELS <= 0.04045, _LEVELS / 12.92, ((_LEVELS + 0.055) / 1.055) ** 2.4).astype(
    np.float32
)
"""Linear value of each 8-bit sRGB level."""

_STEPS = np.arange(4097) / 4096.0
ENCODED = np.rint(
    255.0 * np.where(_STEPS <= 0.0031308, 12.92 * _STEPS, 1.055 * _STEPS ** (1.0 / 2.4) - 0.055)
).astype(np.uint8)
"""8-bit sRGB level of a linear value in steps of 1/4096, fine enough for the darkest levels."""


@compiled
def encode_level(linear: float | np.float32) -> int:
    """The 8-bit sRGB level of a linear value, clipped."""
    clipped = min(max(linear, np.float32(0.0)), np.float32(1.0))
    return ENCODED[int(clipped * np.float32(4096.0) + np.float32(0.5))]


@compiled
def decode_channel(texel: int, shift: int) -> float:
    """Linear value of one colour channel of a packed texel (red lowest)."""
    return DECODED[(texel >> shift) & 255]


@compiled
def alpha_of(texel: int) -> float:
    """Alpha of a packed texel in [0, 1]."""
    return (texel >> 24) * (1.0 / 255.0)
