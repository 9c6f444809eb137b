"""What a designer would not accept, measured in the page: overflow, overlap, faint text."""

from __future__ import annotations

from pathlib import Path

from tests.helpers.page import Visit

_SCRIPT = Path(__file__).with_suffix(".js").read_text(encoding="utf-8")

_LOOKS, _PAUSE_MS = 40, 250


def problems(seen: Visit) -> list[str]:
    """Everything wrong with the layout, in words; what settles by itself after a move is not."""
    found: list[str] = []
    for _ in range(_LOOKS):
        found = seen.page.evaluate(_SCRIPT)
        if not found:
            break
        seen.page.wait_for_timeout(_PAUSE_MS)
    return found
