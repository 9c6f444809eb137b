"""An MCAP file being written: schemas, channels, chunks, attachments, and the file's digest."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import IO, cast

from mcap.well_known import MessageEncoding, SchemaEncoding
from mcap.writer import CompressionType, Writer

from c2nav_engine.traces.records import Stored
from c2nav_engine.traces.topics import EPOCH_NS

LIBRARY = "c2nav"


class _HashedFile:
    """A binary file that digests what passes; the mcap writer only ever appends."""

    def __init__(self, path: Path) -> None:
        self._file = path.open("wb")
        self._digest = hashlib.sha256()
        self._size = 0

    @property
    def sha256(self) -> str:
        """Digest of everything written so far."""
        return self._digest.hexdigest()

    def write(self, data: bytes) -> int:
        """Append."""
        self._digest.update(data)
        self._size += len(data)
        return self._file.write(data)

    def tell(self) -> int:
        """Bytes written."""
        return self._size

    def flush(self) -> None:
        """Hand everything to the operating system, which keeps it when this process is killed."""
        self._file.flush()

    def sync(self) -> None:
        """Wait until it is on the disk, which keeps it when the power fails."""
        self.flush()
        os.fsync(self._file.fileno())

    def close(self) -> None:
        """Close; idempotent."""
        self._file.close()


class Container:
    """One MCAP file under construction, chunk by chunk.

    Args:
        path: The file to write.
        compressed: Whether chunks are compressed (pictures do not shrink, words do).
    """

    def __init__(self, path: Path, *, compressed: bool = True) -> None:
        self._file = _HashedFile(path)
        self._writer = Writer(
            cast("IO[bytes]", self._file),
            compression=CompressionType.ZSTD if compressed else CompressionType.NONE,
            # Chunks end where we say, not at a size.
            chunk_size=2**62,
            # The data section's CRC makes a flip anywhere, attachments included, findable.
            enable_data_crcs=True,
        )
        self._writer.start(profile="", library=LIBRARY)
        self._schemas: dict[tuple[str, bytes], int] = {}
        self._channels: dict[str, int] = {}

    def chunk(self, messages: Iterable[Stored]) -> None:
        """Write messages as one chunk, and hand it to the operating system."""
        for stored in messages:
            self._writer.add_message(
                self._channel(stored),
                log_time=stored.log_time_ns,
                publish_time=stored.log_time_ns,
                sequence=stored.sequence,
                data=stored.data,
            )
        self._writer.flush()

    def _channel(self, stored: Stored) -> int:
        if stored.topic not in self._channels:
            key = (stored.schema, stored.schema_data)
            if key not in self._schemas:
                self._schemas[key] = self._writer.register_schema(
                    stored.schema, SchemaEncoding.Protobuf, stored.schema_data
                )
            self._channels[stored.topic] = self._writer.register_channel(
                stored.topic, MessageEncoding.Protobuf, self._schemas[key]
            )
        return self._channels[stored.topic]

    def attach(self, name: str, data: bytes, *, media_type: str) -> None:
        """Add a file to the file."""
        self._writer.add_attachment(0, EPOCH_NS, name, media_type, data)
        self._writer.flush()

    def describe(self, name: str, facts: Mapping[str, str]) -> None:
        """Add a metadata record: text by name, readable in milliseconds."""
        self._writer.add_metadata(name, dict(facts))
        self._writer.flush()

    def sync(self) -> None:
        """Wait for the disk."""
        self._file.sync()

    def finish(self) -> str:
        """Write index and footer, close, and return the file's SHA-256."""
        self._writer.finish()
        self._file.sync()
        self._file.close()
        return self._file.sha256

    def close(self) -> None:
        """Close the file as it is; idempotent."""
        self._file.close()
