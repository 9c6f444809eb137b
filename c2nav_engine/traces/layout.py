"""The Foxglove layout that ships with the program and inside every trace."""

from __future__ import annotations

from importlib.resources import files

LAYOUT_FILE = "foxglove-layout.json"


def foxglove_layout() -> bytes:
    """A layout for Foxglove: import it from the layouts menu, or take it out of the trace."""
    return (files("c2nav_engine.traces") / "foxglove_layout.json").read_bytes()
