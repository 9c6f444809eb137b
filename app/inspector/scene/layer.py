"""What a 3-D layer is, and the one trick all share: draw only what changed."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Protocol

import viser

from app.session.snapshot import Snapshot


class Layer(Protocol):
    """A part of the map that follows the snapshot."""

    def update(self, snapshot: Snapshot) -> None:
        """Draw what changed since the last time."""
        ...


class Group:
    """Scene nodes under one name that are replaced together when their key changes."""

    def __init__(self, scene: viser.SceneApi, name: str) -> None:
        """Own everything below `name`."""
        self._scene = scene
        self._name = name
        self._key: Hashable = None
        self._handles: list[viser.SceneNodeHandle] = []

    def draw(self, key: Hashable, make: Callable[[], list[viser.SceneNodeHandle]]) -> None:
        """Replace the nodes, unless the key is the last one; None removes them."""
        if key == self._key:
            return
        self._key = key
        stale = {handle.name: handle for handle in self._handles}
        self._handles = make() if key is not None else []
        for handle in self._handles:
            # A node of the same name was replaced in place, without a flicker.
            stale.pop(handle.name, None)
        for handle in stale.values():
            handle.remove()
