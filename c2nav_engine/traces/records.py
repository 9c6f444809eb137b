"""MCAP records in memory: the one module that takes bytes apart.

A trace is a few tens of megabytes, so whole files are walked in memory. Everything that damage can
do to a record ends as a `TraceError` that says where.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from io import BytesIO
from typing import TypeVar

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Chunk, DataEnd, Footer, Message, Schema
from mcap.stream_reader import breakup_chunk
from zstandard import ZstdError

from c2nav_engine.errors import TraceError

MAGIC = b"\x89MCAP0\r\n"
PREFIX = struct.Struct("<BQ")
FOOTER_BYTES = PREFIX.size + 20

R = TypeVar("R")


@dataclass(frozen=True, slots=True)
class Record:
    """One top-level record: what it is, where it begins, and its payload."""

    opcode: int
    offset: int
    payload: bytes

    @property
    def end(self) -> int:
        """First byte after it."""
        return self.offset + PREFIX.size + len(self.payload)


@dataclass(frozen=True, slots=True)
class Stored:
    """One message as it lies in a file.

    Attributes:
        topic: Where it was published.
        schema: Name of its protobuf message.
        schema_data: The schema as the file carries it.
        sequence: Counts the messages of the topic from 0.
        log_time_ns: On the episode's clock (`topics.log_time_ns`).
        data: Protobuf bytes.
    """

    topic: str
    schema: str
    schema_data: bytes
    sequence: int
    log_time_ns: int
    data: bytes


def walk(data: bytes, start: int = len(MAGIC)) -> Iterator[Record]:
    """Whole records from `start` on; ends at the footer, or silently where one is cut off."""
    offset = start
    while offset + PREFIX.size <= len(data):
        opcode, length = PREFIX.unpack_from(data, offset)
        begin = offset + PREFIX.size
        if begin + length > len(data):
            return
        yield Record(opcode, offset, data[begin : begin + length])
        if opcode == Opcode.FOOTER:
            return
        offset = begin + length


def parse(read: Callable[[ReadDataStream], R], record: Record) -> R:
    """The record by its type's `read`; raises `TraceError` where it makes no sense."""
    try:
        return read(ReadDataStream(BytesIO(record.payload)))
    except (McapError, struct.error, ValueError) as error:
        message = (
            f"damaged trace: the record at byte {record.offset} cannot be read ({error}); "
            "`c2nav trace recover` saves what is intact"
        )
        raise TraceError(message) from error


def chunk_records(record: Record) -> list[Schema | Channel | Message]:
    """What a chunk holds, once its CRC holds; raises `TraceError` where it does not."""
    try:
        inner = breakup_chunk(parse(Chunk.read, record), validate_crc=True)
    except (McapError, ZstdError, struct.error, ValueError, MemoryError) as error:
        message = (
            f"damaged trace: the chunk at byte {record.offset} does not hold what was written "
            f"({error}); `c2nav trace recover` saves the other chunks"
        )
        raise TraceError(message) from error
    return [each for each in inner if isinstance(each, Schema | Channel | Message)]


def attachment_of(record: Record) -> Attachment:
    """An attached file, once its CRC holds; raises `TraceError` where it does not."""
    (expected,) = struct.unpack("<I", record.payload[-4:].rjust(4, b"\0"))
    if zlib.crc32(record.payload[:-4]) != expected:
        message = f"damaged trace: the attachment at byte {record.offset} is not what was written"
        raise TraceError(message)
    return parse(Attachment.read, record)


def footer_of(tail: bytes) -> Footer | None:
    """The footer in a file's last bytes; None when they do not end as a finished MCAP does."""
    if len(tail) < FOOTER_BYTES + len(MAGIC) or not tail.endswith(MAGIC):
        return None
    payload = tail[-FOOTER_BYTES - len(MAGIC) : -len(MAGIC)]
    opcode, length = PREFIX.unpack_from(payload)
    if opcode != Opcode.FOOTER or length != FOOTER_BYTES - PREFIX.size:
        return None
    return parse(Footer.read, Record(opcode, 0, payload[PREFIX.size :]))


def data_sums(data: bytes, record: Record) -> tuple[int, int]:
    """The CRC of everything before a `DataEnd` record: as it was written, and as it is."""
    written = parse(DataEnd.read, record).data_section_crc
    return written, zlib.crc32(memoryview(data)[: record.offset])


def summary_crc_holds(footer: Footer, summary: bytes) -> bool:
    """Whether the summary section and the footer are as they were written."""
    head = PREFIX.pack(Opcode.FOOTER, FOOTER_BYTES - PREFIX.size)
    head += struct.pack("<QQ", footer.summary_start, footer.summary_offset_start)
    return zlib.crc32(head, zlib.crc32(summary)) == footer.summary_crc
