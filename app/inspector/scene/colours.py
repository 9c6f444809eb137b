"""The signs' colours in the map: one meaning each, always beside a second sign."""

from __future__ import annotations

Rgb = tuple[int, int, int]

BLUE: Rgb = (0x00, 0x72, 0xB2)
"""Current or interactive."""

GREEN: Rgb = (0x00, 0x9E, 0x73)
"""Success: the goal disc."""

VERMILION: Rgb = (0xD5, 0x5E, 0x00)
"""Fault: vetoed or collided, always with ✕."""

SLATE: Rgb = (0x4A, 0x55, 0x68)
"""What is done: earlier legs, views that were offered and not elected."""

GREY: Rgb = (0x9A, 0xA3, 0xB0)
"""What is not in play: vetoed views, the recorded rest."""

INK: Rgb = (0x1A, 0x20, 0x3A)
"""The body."""
"""Colour of the body's wedge."""
