"""Checked reading of untyped JSON: every wrong value is named by its owner and its field."""

from __future__ import annotations

import gzip
import json
import math
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import cast

from c2nav_engine.errors import EpisodeError
from c2nav_engine.geometry import Point

_GZIP_MAGIC = b"\x1f\x8b"


@dataclass(frozen=True, slots=True)
class Fields:
    """One JSON object on its way to a typed value.

    Attributes:
        owner: What error messages call it ("val.json.gz, episode 7").
        values: The object.
        prefix: Path of this object inside its owner ("info.").
    """

    owner: str
    values: Mapping[str, object]
    prefix: str = ""

    def wrong(self, field: str, expected: str) -> EpisodeError:
        """The error for one field, with what came."""
        came = repr(self.values[field]) if field in self.values else "nothing"
        shown = came if len(came) <= 80 else f"{came[:77]}…"
        return EpisodeError(
            f"{self.owner}: {self.prefix}{field}: expected {expected}, came {shown}"
        )

    def has(self, field: str) -> bool:
        """Whether the field is there and not null."""
        return self.values.get(field) is not None

    def text(self, field: str) -> str:
        """A string that can be written as UTF-8."""
        value = self.values.get(field)
        if not isinstance(value, str) or not _is_unicode(value):
            raise self.wrong(field, "a text")
        return value

    def number(self, field: str) -> float:
        """A finite number."""
        value = _finite(self.values.get(field))
        if value is None:
            raise self.wrong(field, "a finite number")
        return value

    def vector(self, field: str, size: int) -> tuple[float, ...]:
        """A list of `size` finite numbers."""
        value = _vector(self.values.get(field), size)
        if value is None:
            raise self.wrong(field, f"{size} finite numbers")
        return value

    def point(self, field: str) -> Point:
        """A position."""
        x, y, z = self.vector(field, 3)
        return (x, y, z)

    def points(self, field: str) -> tuple[Point, ...]:
        """A list of positions."""
        found = [_vector(value, 3) for value in self.items(field)]
        if None in found:
            raise self.wrong(field, "a list of positions, 3 finite numbers each")
        return tuple((v[0], v[1], v[2]) for v in found if v is not None)

    def items(self, field: str) -> list[object]:
        """A list of anything."""
        value = self.values.get(field)
        if not isinstance(value, list):
            raise self.wrong(field, "a list")
        return cast("list[object]", value)

    def inner(self, field: str) -> Fields:
        """A nested object."""
        value = self.values.get(field)
        if not isinstance(value, dict):
            raise self.wrong(field, "an object")
        return Fields(self.owner, cast("dict[str, object]", value), f"{self.prefix}{field}.")

    def without(self, *fields: str) -> dict[str, object]:
        """Everything else, for what we keep without reading it."""
        return {name: value for name, value in self.values.items() if name not in fields}


def read_bytes(path: Path) -> bytes:
    """A file's bytes; raises `EpisodeError`."""
    try:
        return path.read_bytes()
    except OSError as error:
        message = f"{path}: expected a readable file, came {error.strerror or error}"
        raise EpisodeError(message) from error


def parse_object(data: bytes, name: str) -> Fields:
    """The JSON object in plain or gzipped bytes; raises `EpisodeError`.

    Args:
        data: The file's bytes; what they hold decides, not the file's name.
        name: What error messages call the file.
    """
    try:
        text = gzip.decompress(data) if data.startswith(_GZIP_MAGIC) else data
    except (EOFError, OSError, zlib.error) as error:
        message = f"{name}: expected whole gzip data, came a damaged or cut-off file ({error})"
        raise EpisodeError(message) from error
    try:
        value = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise EpisodeError(f"{name}: expected JSON, came something else ({error})") from error
    if not isinstance(value, dict):
        raise EpisodeError(f"{name}: expected a JSON object, came {type(value).__name__}")
    return Fields(name, cast("dict[str, object]", value))


def _finite(value: object) -> float | None:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None


def _vector(value: object, size: int) -> tuple[float, ...] | None:
    if not isinstance(value, list):
        return None
    numbers = [_finite(item) for item in cast("list[object]", value)]
    found = tuple(number for number in numbers if number is not None)
    return found if len(found) == len(numbers) == size else None


def _is_unicode(text: str) -> bool:
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True
