"""What a panel is: built once, told of every snapshot."""

from __future__ import annotations

from collections.abc import Callable

import viser

from app.session.commands import Command
from app.session.snapshot import Snapshot

Dispatch = Callable[[Command], None]
"""Enqueues a command; callbacks do nothing else."""

Update = Callable[[Snapshot], None]
"""Assigns to the panel's handles."""

Build = Callable[[viser.GuiApi, Dispatch], Update]


class Html:
    """An HTML block that is sent only when its content changed."""

    def __init__(self, gui: viser.GuiApi) -> None:
        """Place an empty block at the current position."""
        self._content = ""
        self._handle = gui.add_html("")

    def show(self, content: str) -> None:
        """Replace the content."""
        if content != self._content:
            self._content = content
            self._handle.content = content
