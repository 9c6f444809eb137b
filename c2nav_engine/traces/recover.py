"""Gets out of an interrupted or damaged trace whatever is intact."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Message, Metadata, Schema

from c2nav_engine.errors import TraceError, UsageError
from c2nav_engine.traces.reader import METADATA, STARTED
from c2nav_engine.traces.records import (
    MAGIC,
    Record,
    Stored,
    attachment_of,
    chunk_records,
    parse,
    walk,
)
from c2nav_engine.traces.topics import EXCHANGE_TOPICS
from c2nav_engine.traces.writer import TraceFileWriter


@dataclass(frozen=True, slots=True)
class Recovered:
    """What a recovery found.

    Attributes:
        path: The new trace.
        sha256: Its digest.
        messages: Messages kept.
        exchanges: Of these, exchanges of the loop.
        damaged_chunks: Chunks left out because their CRC did not hold.
        lost_bytes: Bytes after the last whole record.
        complete: Whether the source had been written to its end.
    """

    path: Path
    sha256: str
    messages: int
    exchanges: int
    damaged_chunks: int
    lost_bytes: int
    complete: bool


@dataclass(slots=True)
class _Salvage:
    """What a linear read of a file gives, damaged chunks skipped."""

    data: bytes
    schemas: dict[int, Schema] = field(default_factory=dict[int, Schema])
    channels: dict[int, Channel] = field(default_factory=dict[int, Channel])
    metadata: dict[str, dict[str, str]] = field(default_factory=dict[str, dict[str, str]])
    damaged_chunks: int = 0
    end: int = len(MAGIC)
    finished: bool = False

    def records(self) -> Iterator[list[Stored] | Attachment]:
        """Chunks as lists of messages, and attachments, in file order."""
        # A finished file repeats its channels at the end: they outlive the chunk that held them.
        for record in walk(self.data):
            if record.opcode == Opcode.SCHEMA:
                self._name(parse(Schema.read, record))
            elif record.opcode == Opcode.CHANNEL:
                self._name(parse(Channel.read, record))
        for record in walk(self.data):
            self.end = record.end
            try:
                yield from self._read(record)
            except TraceError:
                self.damaged_chunks += 1

    def _read(self, record: Record) -> Iterator[list[Stored] | Attachment]:
        if record.opcode == Opcode.CHUNK:
            yield self._messages(record)
        elif record.opcode == Opcode.ATTACHMENT:
            yield attachment_of(record)
        elif record.opcode == Opcode.METADATA:
            found = parse(Metadata.read, record)
            self.metadata[found.name] = found.metadata
        elif record.opcode == Opcode.DATA_END:
            self.finished = True

    def _messages(self, record: Record) -> list[Stored]:
        messages: list[Stored] = []
        for inner in chunk_records(record):
            if not isinstance(inner, Message):
                self._name(inner)
            elif inner.channel_id in self.channels:
                messages.append(self._stored(inner))
        return messages

    def _name(self, named: Schema | Channel) -> None:
        if isinstance(named, Schema):
            self.schemas[named.id] = named
        else:
            self.channels[named.id] = named

    def _stored(self, message: Message) -> Stored:
        channel = self.channels[message.channel_id]
        schema = self.schemas[channel.schema_id]
        return Stored(
            channel.topic,
            schema.name,
            schema.data,
            message.sequence,
            message.log_time,
            message.data,
        )


def recover(source: Path, out: Path) -> Recovered:
    """Copy every intact chunk of `source` into a new, readable trace.

    The new trace says `complete: no` and `recovered: yes`, unless nothing was missing.

    Raises:
        UsageError: `out` is `source`.
        TraceError: Nothing of a trace is there.
    """
    if source.resolve() == out.resolve():
        message = f"expected another file for the recovered trace, came {out} for both"
        raise UsageError(message)
    if not source.is_file():
        message = f"expected a trace file, found none at {source}"
        raise TraceError(message)
    data = source.read_bytes()
    if not data.startswith(MAGIC):
        message = f"nothing to recover: {source} does not begin as an MCAP file"
        raise TraceError(message)
    salvage = _Salvage(data)
    writer = TraceFileWriter(out)
    try:
        messages, exchanges = _copy(salvage, writer)
        facts = _facts(salvage, source)
        writer.describe(METADATA, facts)
        digest = writer.finish()
    except BaseException:
        writer.abandon()
        writer.part.unlink()
        raise
    return Recovered(
        path=out,
        sha256=digest,
        messages=messages,
        exchanges=exchanges,
        damaged_chunks=salvage.damaged_chunks,
        lost_bytes=0 if salvage.finished else len(data) - salvage.end,
        complete=facts["complete"] == "yes",
    )


def _copy(salvage: _Salvage, writer: TraceFileWriter) -> tuple[int, int]:
    messages = exchanges = 0
    for found in salvage.records():
        if isinstance(found, Attachment):
            writer.attach(found.name, found.data, media_type=found.media_type)
            continue
        writer.copy(found)
        messages += len(found)
        exchanges += sum(stored.topic in EXCHANGE_TOPICS for stored in found)
    if STARTED in salvage.metadata:
        writer.describe(STARTED, salvage.metadata[STARTED])
    return messages, exchanges


def _facts(salvage: _Salvage, source: Path) -> dict[str, str]:
    facts = dict(salvage.metadata.get(METADATA) or salvage.metadata.get(STARTED) or {})
    if not facts:
        message = f"nothing to recover: {source} was cut off before it said which run it is"
        raise TraceError(message)
    intact = METADATA in salvage.metadata and salvage.finished and not salvage.damaged_chunks
    if not intact:
        facts |= {"complete": "no", "recovered": "yes"}
        facts.setdefault("outcome", "interrupted")
    return facts
