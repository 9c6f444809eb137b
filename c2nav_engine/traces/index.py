"""The index at a trace's end: where everything lies, read at once when it is opened."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from mcap.opcode import Opcode
from mcap.records import (
    AttachmentIndex,
    Channel,
    ChunkIndex,
    Message,
    MetadataIndex,
    Schema,
)

from c2nav_engine.traces.records import Stored, parse, walk


@dataclass(slots=True)
class Index:
    """What a file holds, and where.

    Attributes:
        schemas: By id.
        channels: By id.
        chunks: In file order.
        attachments: By name.
        metadata: By name.
        by_topic: The chunks that hold a topic, in file order.
    """

    schemas: dict[int, Schema] = field(default_factory=dict[int, Schema])
    channels: dict[int, Channel] = field(default_factory=dict[int, Channel])
    chunks: list[ChunkIndex] = field(default_factory=list[ChunkIndex])
    attachments: dict[str, AttachmentIndex] = field(default_factory=dict[str, AttachmentIndex])
    metadata: dict[str, MetadataIndex] = field(default_factory=dict[str, MetadataIndex])
    by_topic: dict[str, list[ChunkIndex]] = field(default_factory=dict[str, list[ChunkIndex]])

    @staticmethod
    def of(summary: bytes) -> Index:
        """The index of a summary section; raises `TraceError` where it makes no sense."""
        index = Index()
        for record in walk(summary, 0):
            read = _READERS.get(record.opcode)
            if read is not None:
                index.keep(parse(read, record))
        index.chunks.sort(key=lambda chunk: chunk.chunk_start_offset)
        for chunk in index.chunks:
            for channel in chunk.message_index_offsets:
                index.by_topic.setdefault(index.channels[channel].topic, []).append(chunk)
        return index

    def keep(self, record: Any) -> None:
        """Learn one record of the index; others are no matter of it."""
        match record:
            case Schema():
                self.schemas[record.id] = record
            case Channel():
                self.channels[record.id] = record
            case ChunkIndex():
                self.chunks.append(record)
            case AttachmentIndex():
                self.attachments[record.name] = record
            case MetadataIndex():
                self.metadata[record.name] = record
            case _:
                pass

    def channels_of(self, *topics: str) -> set[int]:
        """Ids of the channels of these topics."""
        return {key for key, channel in self.channels.items() if channel.topic in topics}

    def knows(self, message: Message) -> bool:
        """Whether a message's channel and schema are known."""
        channel = self.channels.get(message.channel_id)
        return channel is not None and channel.schema_id in self.schemas

    def stored(self, message: Message) -> Stored:
        """A message with its topic and schema."""
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


_READERS: dict[int, Callable[[Any], Any]] = {
    Opcode.SCHEMA: Schema.read,
    Opcode.CHANNEL: Channel.read,
    Opcode.CHUNK_INDEX: ChunkIndex.read,
    Opcode.ATTACHMENT_INDEX: AttachmentIndex.read,
    Opcode.METADATA_INDEX: MetadataIndex.read,
}
