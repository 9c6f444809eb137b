"""How far a question is: counted where answers come in, for whoever waits for them."""

from __future__ import annotations

from collections.abc import Callable
from threading import Lock

Telling = Callable[[int, int], None]
"""Told how many queries of a question are answered, and how many it takes as far as is known."""


class Tally:
    """Counts the queries of one question; answers may come in from several threads."""

    def __init__(self, told: Telling | None = None) -> None:
        """Count from nothing; `told` hears of every change, on the thread that makes it."""
        self._told = told
        self._lock = Lock()
        self._answered = 0
        self._wanted = 0

    def expect(self, count: int) -> None:
        """So many more queries go out: every presentation once, and every repair."""
        self._change(0, count)

    def came(self, count: int = 1) -> None:
        """So many more are answered; a try that failed on its way is no answer."""
        self._change(count, 0)

    def _change(self, answered: int, wanted: int) -> None:
        with self._lock:
            self._answered += answered
            self._wanted += wanted
            if self._told is not None:
                self._told(self._answered, self._wanted)
