"""The final layout of a trace: what is read together lies together.

While a run goes on, each exchange is a chunk of its own, so that a kill costs nothing. That is a
poor file to read: neighbouring decisions share nearly all their words, and each would repeat them.
A finished trace is therefore written once more, lane by lane.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path

from mcap.records import Attachment

from c2nav_engine.traces.container import Container
from c2nav_engine.traces.records import Stored
from c2nav_engine.traces.topics import METADATA, TOPICS, Lane

CHUNK_BYTES = {Lane.THUMBNAILS: 64 * 1024, Lane.DECISIONS: 128 * 1024, Lane.FACTS: 256 * 1024}
"""Most that a chunk of these lanes holds before compression [C].

A decision is read from 128 KiB in a fraction of a millisecond; 4 MiB would cost tens. Pictures
and depth stay one chunk an exchange: a question shows the pictures of one look.
"""


def settle(
    messages: Iterable[Stored],
    out: Path,
    *,
    attachments: Sequence[Attachment],
    metadata: Mapping[str, Mapping[str, str]],
) -> str:
    """Write a finished trace, whole or not at all; returns its SHA-256.

    The record `METADATA` is written last: whoever finds it knows that nothing is missing.
    """
    settling = out.with_name(f"{out.name}.settling")
    out.parent.mkdir(parents=True, exist_ok=True)
    container = Container(settling)
    try:
        for attached in attachments:
            container.attach(attached.name, attached.data, media_type=attached.media_type)
        for name, facts in metadata.items():
            if name != METADATA:
                container.describe(name, facts)
        for chunk in _chunks(messages):
            container.chunk(chunk)
        container.describe(METADATA, metadata[METADATA])
        digest = container.finish()
    except BaseException:
        container.close()
        settling.unlink()
        raise
    settling.replace(out)
    return digest


def _chunks(messages: Iterable[Stored]) -> Iterator[list[Stored]]:
    """Lane by lane, in time order within each."""
    by_lane: dict[Lane, list[Stored]] = {lane: [] for lane in Lane}
    for stored in messages:
        by_lane[lane_of(stored.topic)].append(stored)
    for lane, found in by_lane.items():
        found.sort(key=lambda stored: stored.log_time_ns)
        for _, together in groupby(found, key=lambda stored: stored.log_time_ns):
            if lane not in CHUNK_BYTES:
                yield list(together)
        if lane in CHUNK_BYTES:
            yield from _filled(found, CHUNK_BYTES[lane])


def lane_of(topic: str) -> Lane:
    """The lane of a topic; unknown topics of a newer program count as facts."""
    return TOPICS[topic].lane if topic in TOPICS else Lane.FACTS


def _filled(messages: Sequence[Stored], limit: int) -> Iterator[list[Stored]]:
    chunk: list[Stored] = []
    size = 0
    for stored in messages:
        if chunk and size + len(stored.data) > limit:
            yield chunk
            chunk, size = [], 0
        chunk.append(stored)
        size += len(stored.data)
    if chunk:
        yield chunk
