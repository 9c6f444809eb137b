"""Careful steps into JSON of unknown shape: a missing or odd field is None, never an error."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import cast


def field(value: object, *path: str | int) -> object:
    """What stands at a path of keys and indices, or None."""
    for step in path:
        if isinstance(step, str) and isinstance(value, Mapping):
            value = cast("Mapping[str, object]", value).get(step)
        elif isinstance(step, int) and is_list(value) and step < len(items(value)):
            value = items(value)[step]
        else:
            return None
    return value


def text(value: object, *path: str | int) -> str:
    """A string at a path, or ""."""
    found = field(value, *path)
    return found if isinstance(found, str) else ""


def count(value: object, *path: str | int) -> int | None:
    """A whole number at a path, or None."""
    found = field(value, *path)
    return found if isinstance(found, int) and not isinstance(found, bool) and found >= 0 else None


def items(value: object, *path: str | int) -> Sequence[object]:
    """A list at a path, or ()."""
    found = field(value, *path)
    return cast("Sequence[object]", found) if is_list(found) else ()


def is_list(value: object) -> bool:
    """Whether this is a JSON array."""
    return isinstance(value, list)
