"""Reads a finished trace: its summary at once, everything else when it is asked for.

Only the chunks that hold a wanted topic are touched, every chunk's CRC is checked, and a file
without its closing magic is called what it is.
"""

from __future__ import annotations

import os
from bisect import bisect_right
from collections import OrderedDict
from collections.abc import Iterator, Mapping
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from types import TracebackType

from foxglove_schemas_protobuf.CompressedImage_pb2 import CompressedImage
from mcap.records import Attachment, ChunkIndex, Footer, Message, MessageIndex, Metadata

from c2nav_engine.errors import TraceError, UnfinishedTrace
from c2nav_engine.traces.index import Index
from c2nav_engine.traces.records import (
    FOOTER_BYTES,
    MAGIC,
    PREFIX,
    Record,
    Stored,
    attachment_of,
    chunk_records,
    footer_of,
    parse,
    summary_crc_holds,
    walk,
)
from c2nav_engine.traces.salvage import unfinished_words
from c2nav_engine.traces.topics import METADATA, SCHEMA_VERSION, rank_of

CACHED_CHUNKS = 8
"""Opened chunks kept: a decision's pictures mostly share one."""


class TraceFile:
    """A finished trace on disk; safe to read from several threads.

    Args:
        path: The file.

    Raises:
        UnfinishedTrace: It lacks its closing record; the message says what is there.
        TraceError: It is no trace, is damaged, or is newer than this program.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.bytes_read = 0
        """What was read from the disk so far, for benchmarks."""
        if not path.is_file():
            message = f"expected a trace file, found none at {path}"
            raise TraceError(message)
        self._descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_BINARY", 0))
        self._size = os.fstat(self._descriptor).st_size
        self._opened: OrderedDict[int, list[Message]] = OrderedDict()
        try:
            self._index = self._open()
            self._identify()
        except BaseException:
            self.close()
            raise

    # ------------------------------------------------------------ opening

    def _open(self) -> Index:
        if self._read(0, len(MAGIC)) != MAGIC:
            message = f"expected a trace (an MCAP file), but {self.path} begins otherwise"
            raise TraceError(message)
        tail_bytes = FOOTER_BYTES + len(MAGIC)
        footer = footer_of(self._read(max(0, self._size - tail_bytes), tail_bytes))
        if footer is None:
            raise UnfinishedTrace(unfinished_words(self.path))
        return self._indexed(footer)

    def _indexed(self, footer: Footer) -> Index:
        end = self._size - FOOTER_BYTES - len(MAGIC)
        start = footer.summary_start
        summary = self._read(start, end - start) if 0 < start <= end else b""
        if not summary_crc_holds(footer, summary):
            message = (
                f"damaged trace: the index of {self.path} does not hold what was written; "
                "`c2nav trace recover` rebuilds it"
            )
            raise TraceError(message)
        return Index.of(summary)

    def _identify(self) -> None:
        if METADATA not in self._index.metadata:
            message = f"expected a trace of this program, but {self.path} is some other MCAP file"
            raise TraceError(message)
        version = self.facts.get("schema_version", "")
        if not version.isdecimal() or not 1 <= int(version) <= SCHEMA_VERSION:
            message = (
                f"{self.path} has trace schema {version!r}; this version reads 1 to "
                f"{SCHEMA_VERSION}: update the program to open it"
            )
            raise TraceError(message)

    # ------------------------------------------------------------ bytes

    def _read(self, offset: int, length: int) -> bytes:
        self.bytes_read += length
        return os.pread(self._descriptor, length, offset)

    def _record(self, offset: int, length: int) -> Record:
        data = self._read(offset, length)
        found = next(walk(data, 0), None)
        if found is None or len(found.payload) + PREFIX.size != length:
            message = f"damaged trace: no record of {length} bytes at byte {offset} of {self.path}"
            raise TraceError(message)
        return Record(found.opcode, offset, found.payload)

    def _messages_in(self, chunk: ChunkIndex) -> list[Message]:
        offset = chunk.chunk_start_offset
        messages = self._opened.get(offset)
        if messages is None:
            inner = chunk_records(self._record(offset, chunk.chunk_length))
            messages = [record for record in inner if isinstance(record, Message)]
            self._opened[offset] = messages
            while len(self._opened) > CACHED_CHUNKS:
                self._opened.popitem(last=False)
        return messages

    # ------------------------------------------------------------ what it holds

    @property
    def size_bytes(self) -> int:
        """Size of the file."""
        return self._size

    @cached_property
    def facts(self) -> Mapping[str, str]:
        """The `c2nav` metadata record."""
        return self.metadata(METADATA)

    @cached_property
    def sha256(self) -> str:
        """Digest of the whole file: what reviews and child traces call it by."""
        return sha256(self._read(0, self._size)).hexdigest()

    @property
    def complete(self) -> bool:
        """Whether the run wrote it to the end (a recovered trace is readable, not complete)."""
        return self.facts.get("complete") == "yes"

    @property
    def topics(self) -> tuple[str, ...]:
        """Topics with at least one message."""
        return tuple(self._index.by_topic)

    def metadata(self, name: str) -> dict[str, str]:
        """One metadata record; raises `TraceError` when there is none of that name."""
        if name not in self._index.metadata:
            message = (
                f"{self.path} has no metadata record {name!r}; it has {list(self._index.metadata)}"
            )
            raise TraceError(message)
        index = self._index.metadata[name]
        return parse(Metadata.read, self._record(index.offset, index.length)).metadata

    @property
    def attachments(self) -> tuple[str, ...]:
        """Names of the attached files."""
        return tuple(self._index.attachments)

    def attachment(self, name: str) -> bytes:
        """One attached file's bytes; raises `TraceError` when there is none of that name."""
        return self.attached(name).data

    def attached(self, name: str) -> Attachment:
        """One attached file; raises `TraceError` when there is none of that name."""
        if name not in self._index.attachments:
            message = (
                f"{self.path} has no attachment {name!r}; it has {list(self._index.attachments)}"
            )
            raise TraceError(message)
        index = self._index.attachments[name]
        return attachment_of(self._record(index.offset, index.length))

    def messages(self, *topics: str) -> Iterator[Stored]:
        """Messages of these topics (of all when none is named) by log time and topic rank."""
        channels = self._index.channels_of(*(topics or self._index.by_topic))
        found = [
            self._index.stored(message)
            for chunk in self._index.chunks
            if channels.intersection(chunk.message_index_offsets)
            for message in self._messages_in(chunk)
            if message.channel_id in channels
        ]
        found.sort(key=lambda stored: (stored.log_time_ns, rank_of(stored.topic)))
        return iter(found)

    def times_ns(self, topic: str) -> list[int]:
        """Log times of a topic's messages in order, from the index alone."""
        keys = self._index.channels_of(topic)
        times_ns: list[int] = []
        for chunk in self._index.by_topic.get(topic, []):
            for key in keys.intersection(chunk.message_index_offsets):
                offset = chunk.message_index_offsets[key]
                length = PREFIX.unpack(self._read(offset, PREFIX.size))[1] + PREFIX.size
                index = parse(MessageIndex.read, self._record(offset, length))
                times_ns.extend(time_ns for time_ns, _ in index.records)
        return times_ns

    def at(self, topic: str, log_time_ns: int) -> list[Stored]:
        """The messages of a topic with exactly this log time; reads one chunk."""
        chunks = self._index.by_topic.get(topic, [])
        place = bisect_right(chunks, log_time_ns, key=lambda chunk: chunk.message_start_time)
        if place == 0:
            return []
        return [
            stored
            for stored in map(self._index.stored, self._messages_in(chunks[place - 1]))
            if stored.topic == topic and stored.log_time_ns == log_time_ns
        ]

    def picture(self, topic: str, log_time_ns: int, digest: str) -> bytes:
        """The bytes of one picture, or b"" where this trace does not hold them."""
        for stored in self.at(topic, log_time_ns) if topic else []:
            data = CompressedImage.FromString(stored.data).data
            if sha256(data).hexdigest() == digest:
                return data
        return b""

    def forget(self) -> None:
        """Drop the chunks that are kept open."""
        self._opened.clear()

    def close(self) -> None:
        """Close the file; idempotent."""
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1

    def __enter__(self) -> TraceFile:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def __del__(self) -> None:
        """A file that nobody closed is closed with its last reader."""
        if hasattr(self, "_descriptor"):
            self.close()
