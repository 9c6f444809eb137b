"""How many heaps the threads of a long-lived server share."""

from __future__ import annotations

import ctypes
from contextlib import suppress

_M_ARENA_MAX = -8
"""Of glibc's `mallopt`."""

HEAPS = 2
"""Enough for threads that mostly wait for each other."""


def share_heaps() -> None:
    """Let all threads share a few heaps, before there are threads.

    glibc gives each thread a heap of its own, up to eight a core, and every heap keeps the room
    that its largest look took. Other C libraries have no such setting and are left alone.
    """
    with suppress(AttributeError):
        ctypes.CDLL(None).mallopt(_M_ARENA_MAX, HEAPS)
