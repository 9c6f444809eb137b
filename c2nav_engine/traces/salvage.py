"""Everything intact in a file, finished or not, by one linear read."""

from __future__ import annotations

from collections import Counter
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Message, Metadata, Schema

from c2nav_engine.errors import TraceError
from c2nav_engine.traces.index import Index
from c2nav_engine.traces.records import (
    MAGIC,
    Record,
    Stored,
    attachment_of,
    chunk_records,
    data_sums,
    parse,
    walk,
)
from c2nav_engine.traces.topics import EPOCH_NS, EXCHANGE_TOPICS, step_and_exchange


@dataclass(slots=True)
class Salvaged:
    """What a file holds.

    Attributes:
        messages: In file order.
        attachments: In file order.
        metadata: By name; the last one of a name counts.
        damaged: Records left out because their CRC did not hold or they made no sense.
        end: First byte after the last whole record.
        finished: Whether the data section had been closed.
        sum_holds: Whether the closing CRC, the only one over metadata, holds; None without one.
    """

    messages: list[Stored] = field(default_factory=list[Stored])
    attachments: list[Attachment] = field(default_factory=list[Attachment])
    metadata: dict[str, dict[str, str]] = field(default_factory=dict[str, dict[str, str]])
    damaged: int = 0
    end: int = len(MAGIC)
    finished: bool = False
    sum_holds: bool | None = None


def salvage(data: bytes) -> Salvaged:
    """Read a file's bytes as far as they go; damage costs only the record it hit."""
    reading = _Reading()
    for record in walk(data):
        reading.learn(record)
    for record in walk(data):
        reading.found.end = record.end
        try:
            reading.take(record)
            if record.opcode == Opcode.DATA_END:
                written, found = data_sums(data, record)
                reading.found.sum_holds = written == found
        except TraceError:
            reading.found.damaged += 1
    return reading.found


def unfinished_words(path: Path) -> str:
    """What an unfinished file holds and how to get it out, for a person."""
    data = path.read_bytes()
    found = salvage(data)
    counts = Counter(stored.topic for stored in found.messages)
    decisions = counts["/decision"]
    others = sum(counts[topic] for topic in EXCHANGE_TOPICS) - decisions
    last_ns = max((stored.log_time_ns for stored in found.messages), default=EPOCH_NS)
    step, _ = step_and_exchange(last_ns)
    target = path.name.removesuffix(".part").removesuffix(".mcap") + ".recovered.mcap"
    return (
        f"unfinished trace: {path} ends without its closing record; {decisions} decisions and "
        f"{others} other exchanges up to step {step} are there ({found.end} of {len(data)} bytes); "
        f"get them out with `c2nav trace recover {path} --out {target}`"
    )


@dataclass(slots=True)
class _Reading:
    found: Salvaged = field(default_factory=Salvaged)
    index: Index = field(default_factory=Index)

    def learn(self, record: Record) -> None:
        """A finished file repeats its channels at the end: they outlive the chunk that had them."""
        with suppress(TraceError):
            if record.opcode == Opcode.SCHEMA:
                self.index.keep(parse(Schema.read, record))
            elif record.opcode == Opcode.CHANNEL:
                self.index.keep(parse(Channel.read, record))

    def take(self, record: Record) -> None:
        """Read one record of the data section."""
        if record.opcode == Opcode.CHUNK:
            self._chunk(record)
        elif record.opcode == Opcode.ATTACHMENT:
            self.found.attachments.append(attachment_of(record))
        elif record.opcode == Opcode.METADATA:
            metadata = parse(Metadata.read, record)
            self.found.metadata[metadata.name] = metadata.metadata
        elif record.opcode == Opcode.DATA_END:
            self.found.finished = True

    def _chunk(self, record: Record) -> None:
        for inner in chunk_records(record):
            if not isinstance(inner, Message):
                self.index.keep(inner)
            elif self.index.knows(inner):
                self.found.messages.append(self.index.stored(inner))
