"""Keeps what is written off the files that it is made from."""

from __future__ import annotations

import os
from pathlib import Path

from c2nav_engine.errors import UsageError


def keep_apart(out: Path, *inputs: Path) -> None:
    """Refuse an output that would write over an input, also through a link; `UsageError`."""
    for path in inputs:
        if _same(out, path):
            message = (
                f"expected another file to write than the one that is read, came {out} for both; "
                "name a new one"
            )
            raise UsageError(message)


def _same(one: Path, other: Path) -> bool:
    try:
        # Two hard links to one file have different names and the same bytes.
        return one.samefile(other)
    except OSError:  # One of them is not there yet, or cannot be looked at.
        return os.path.realpath(one) == os.path.realpath(other)
