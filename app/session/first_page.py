"""Until the first page stands, heavy work waits: it would take the cores that the page needs."""

from __future__ import annotations

import threading


class FirstPage:
    """Whether anybody has asked for a page yet, and whether one stands.

    A page that is being built wants every core for a second or two. What nobody can use before it
    stands (scene, map, suspects) begins after it. Where nobody comes it begins soon, so that it
    is there when somebody does.
    """

    def __init__(self, *, asked_within_s: float = 0.0, stands_within_s: float = 0.0) -> None:
        """Nobody has come yet; by default nothing waits.

        Args:
            asked_within_s: How long to wait for somebody to ask for a page, seconds.
            stands_within_s: How long a page that was asked for may take, seconds: one whose
                script never runs must not hold up what others wait for.
        """
        self._asked_within_s = asked_within_s
        self._stands_within_s = stands_within_s
        self._asked = threading.Event()
        self._stands = threading.Event()

    def asked(self) -> None:
        """Somebody asks for a page."""
        self._asked.set()

    def stands(self) -> None:
        """A page shows the decision in view, pictures included."""
        self._stands.set()
        self._asked.set()

    def wait(self) -> None:
        """Return once heavy work is in nobody's way."""
        if self._asked.wait(self._asked_within_s):
            self._stands.wait(self._stands_within_s)
