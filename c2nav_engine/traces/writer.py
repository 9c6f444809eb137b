"""Writes a trace so that a killed process loses nothing that was appended.

Each append is one or more whole chunks, handed to the operating system before it returns. The file
is called `NAME.part` until it is complete.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from types import TracebackType
from typing import IO, cast

from google.protobuf.message import Message
from mcap.well_known import MessageEncoding, SchemaEncoding
from mcap.writer import Writer

from c2nav_engine.errors import InternalError
from c2nav_engine.traces.records import Stored
from c2nav_engine.traces.topics import EPOCH_NS, TOPICS, schema_bytes

LIBRARY = "c2nav"


@dataclass(frozen=True, slots=True)
class Outgoing:
    """A message on its way into a trace."""

    topic: str
    message: Message
    log_time_ns: int


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


class TraceFileWriter:
    """One MCAP file under construction.

    Args:
        path: Where the complete file will stand; until then `path` + `.part` does.
        fsync: Wait for the disk at each append (about 0.6 ms more), against power failures.
    """

    def __init__(self, path: Path, *, fsync: bool = False) -> None:
        self._path = path
        self.part = path.with_name(f"{path.name}.part")
        self.part.parent.mkdir(parents=True, exist_ok=True)
        self._fsync = fsync
        self._file = _HashedFile(self.part)
        # The data section's CRC makes a flip anywhere, attachments included, findable.
        self._writer = Writer(cast("IO[bytes]", self._file), enable_data_crcs=True)
        self._writer.start(profile="", library=LIBRARY)
        self._schemas: dict[tuple[str, bytes], int] = {}
        self._channels: dict[str, int] = {}
        self._sequences: dict[str, int] = {}

    def append(self, messages: Sequence[Outgoing]) -> None:
        """Write the messages of one exchange: one chunk per lane, heavy ones first."""
        ordered = sorted(messages, key=lambda outgoing: TOPICS[outgoing.topic].lane)
        for _, lane in groupby(ordered, key=lambda outgoing: TOPICS[outgoing.topic].lane):
            self.copy(self._numbered(outgoing) for outgoing in lane)

    def _numbered(self, outgoing: Outgoing) -> Stored:
        sequence = self._sequences.get(outgoing.topic, 0)
        self._sequences[outgoing.topic] = sequence + 1
        kind = TOPICS[outgoing.topic].message
        if type(outgoing.message) is not kind:
            message = f"{outgoing.topic} takes {kind}, came {type(outgoing.message)}"
            raise InternalError(message)
        return Stored(
            outgoing.topic,
            kind.DESCRIPTOR.full_name,
            schema_bytes(kind),
            sequence,
            outgoing.log_time_ns,
            outgoing.message.SerializeToString(deterministic=True),
        )

    def copy(self, messages: Iterable[Stored]) -> None:
        """Write finished messages into one chunk of their own."""
        for stored in messages:
            self._writer.add_message(
                self._channel(stored),
                log_time=stored.log_time_ns,
                publish_time=stored.log_time_ns,
                sequence=stored.sequence,
                data=stored.data,
            )
        self._flush()

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
        self._flush()

    def describe(self, name: str, facts: Mapping[str, str]) -> None:
        """Add a metadata record: text by name, readable in milliseconds."""
        self._writer.add_metadata(name, dict(facts))
        self._flush()

    def _flush(self) -> None:
        self._writer.flush()
        if self._fsync:
            self._file.sync()

    def finish(self) -> str:
        """Close the file properly, give it its name, and return its SHA-256."""
        self._writer.finish()
        self._file.sync()
        self.abandon()
        self.part.replace(self._path)
        return self._file.sha256

    def abandon(self) -> None:
        """Stop writing and leave the `.part` as it is, for `recover`; idempotent."""
        self._file.close()

    def __enter__(self) -> TraceFileWriter:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Leaving without `finish` leaves a `.part` behind."""
        self.abandon()
