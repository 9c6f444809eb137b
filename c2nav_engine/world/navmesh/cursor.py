"""Reading numbers from hostile bytes: every read is checked and every complaint has an address."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from c2nav_engine.errors import NavMeshError

Records = Any
"""An array of structured records, or one of them; the fields stand beside its dtype."""


class Cursor:
    """A position in a file's bytes, little-endian, that never reads past the end.

    Attributes:
        offset: Next byte to read, from the start of the file.
        end: First byte that must not be read; a tile narrows it to its own size.
    """

    __slots__ = ("_data", "_path", "end", "offset")

    def __init__(self, data: bytes, path: Path) -> None:
        self._data = data
        self._path = path
        self.offset = 0
        self.end = len(data)

    def array(self, what: str, kind: DTypeLike, count: int) -> Records:
        """The next `count` records, read-only, and the cursor moves on.

        Raises `NavMeshError` where fewer bytes are left than the records need.
        """
        record = np.dtype(kind)
        needed = record.itemsize * count
        if count < 0 or needed > self.end - self.offset:
            raise self.error(
                f"{count} × {record.itemsize} bytes of {what}", f"{self.end - self.offset} bytes"
            )
        values = np.frombuffer(self._data, record, count, self.offset)
        self.offset += needed
        return values

    def integers(self, what: str, count: int) -> list[int]:
        """The next `count` signed 32-bit integers."""
        return [int(value) for value in self.array(what, "<i4", count)]

    def floats(self, what: str, count: int) -> list[float]:
        """The next `count` single-precision numbers."""
        return [float(value) for value in self.array(what, "<f4", count)]

    def peek(self, ahead: int, count: int) -> bytes:
        """Bytes further on, without moving; shorter where the file ends."""
        start = self.offset + ahead
        return self._data[start : min(start + count, self.end)]

    def error(self, expected: str, came: str, *, offset: int | None = None) -> NavMeshError:
        """The complaint about a place in this file, ready to raise."""
        place = self.offset if offset is None else offset
        return NavMeshError(
            f"{self._path}: at byte {place}: expected {expected}, came {came}; "
            "save the navigation mesh again with habitat-sim"
        )
