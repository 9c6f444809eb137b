"""What comes first when a page is opened: heavy work would take the cores that it needs."""

from __future__ import annotations

import threading


class FirstPage:
    """Whether anybody has asked for a page yet, whether one stands, whether the scene is sent.

    A page that is being built wants every core for a second or two. What nobody can use before it
    stands (scene, map) begins after it, and what is looked at last (suspects) once that shows the
    scene.
    Where nobody comes all of it begins soon, so that it is there when somebody does.
    """

    def __init__(
        self,
        *,
        asked_within_s: float = 0.0,
        stands_within_s: float = 0.0,
        sent_within_s: float = 0.0,
        shown_within_s: float = 0.0,
    ) -> None:
        """Nobody has come yet; by default nothing waits.

        Args:
            asked_within_s: How long to wait for somebody to ask for a page, seconds.
            stands_within_s: How long a page that was asked for may take, seconds: one whose
                script never runs must not hold up what others wait for.
            sent_within_s: How long the scene may take after that, seconds.
            shown_within_s: How long a page may take to show it, seconds.
        """
        self._asked_within_s = asked_within_s
        self._stands_within_s = stands_within_s
        self._sent_within_s = sent_within_s
        self._shown_within_s = shown_within_s
        self._asked = threading.Event()
        self._stands = threading.Event()
        self._sent = threading.Event()
        self._shown = threading.Event()

    def asked(self) -> None:
        """Somebody asks for a page."""
        self._asked.set()

    def stands(self) -> None:
        """A page shows the decision in view, pictures included."""
        self._stands.set()
        self._asked.set()

    def sent(self) -> None:
        """The scene is on its way to whoever looks."""
        self._sent.set()

    def shown(self) -> None:
        """A page shows the scene."""
        self._shown.set()

    def release(self) -> None:
        """Nothing is worth waiting for any longer."""
        for event in (self._asked, self._stands, self._sent, self._shown):
            event.set()

    def wait(self) -> None:
        """Return once heavy work is in nobody's way."""
        if self._asked.wait(self._asked_within_s):
            self._stands.wait(self._stands_within_s)

    def wait_for_scene(self) -> None:
        """Return once that is so and the scene is sent, and shown where somebody looks."""
        self.wait()
        if self._sent.wait(self._sent_within_s) and self._asked.is_set():
            self._shown.wait(self._shown_within_s)
