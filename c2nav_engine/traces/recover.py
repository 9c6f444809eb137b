"""Gets out of an interrupted or damaged trace whatever is intact."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from c2nav_engine.errors import TraceError
from c2nav_engine.traces.apart import keep_apart
from c2nav_engine.traces.check import missing_pictures
from c2nav_engine.traces.reader import TraceFile
from c2nav_engine.traces.records import MAGIC
from c2nav_engine.traces.salvage import Salvaged, salvage
from c2nav_engine.traces.settle import settle
from c2nav_engine.traces.topics import EXCHANGE_TOPICS, METADATA, STARTED

UNVERIFIED = "unverified_"
"""What the names of facts begin with that may be damaged."""

_CLOSING = ("outcome", "error", "metrics")
"""Facts that only the closing record holds, and only the checksum over the whole file covers."""


@dataclass(frozen=True, slots=True)
class Recovered:
    """What a recovery found.

    Attributes:
        path: The new trace.
        sha256: Its digest.
        messages: Messages kept.
        exchanges: Of these, exchanges of the loop.
        damaged: Records left out because their CRC did not hold.
        lost_bytes: Bytes after the last whole record.
        lost_pictures: Pictures that a kept exchange names and that are not there.
        unverified: Closing facts (outcome, metrics) that no checksum vouches for any more; the new
            trace has them as `unverified_…`.
        complete: Whether nothing was missing.
    """

    path: Path
    sha256: str
    messages: int
    exchanges: int
    damaged: int
    lost_bytes: int
    lost_pictures: int
    unverified: tuple[str, ...]
    complete: bool

    def __str__(self) -> str:
        """For a person, on one line."""
        kept = f"{self.exchanges} exchanges in {self.messages} messages"
        if self.complete:
            return f"{kept}, nothing missing"
        return (
            f"{kept}; left out: {self.damaged} damaged records, {self.lost_bytes} bytes at the "
            f"end; {self.lost_pictures} pictures are missing{self._doubt()}"
        )

    def _doubt(self) -> str:
        if not self.unverified:
            return ""
        names = ", ".join(self.unverified)
        return (
            f"; the checksum over the whole file does not hold, so that {names} may be wrong: "
            f"they are kept as {UNVERIFIED}…, not as results"
        )


def recover(source: Path, out: Path) -> Recovered:
    """Copy everything intact in `source` into a new, readable trace.

    The new trace says `complete: no` and `recovered: yes`, unless nothing was missing and the
    checksum over the whole holds. Chunks and attachments have checksums of their own; where the one
    over the whole does not hold, outcome and metrics are no longer taken for results.

    Raises:
        UsageError: `out` is `source`.
        TraceError: Nothing of a trace is there.
    """
    keep_apart(out, source)
    if not source.is_file():
        message = f"expected a trace file, found none at {source}"
        raise TraceError(message)
    data = source.read_bytes()
    if not data.startswith(MAGIC):
        message = f"nothing to recover: {source} does not begin as an MCAP file"
        raise TraceError(message)
    found = salvage(data)
    facts = _facts(found, source)
    metadata = {**found.metadata, METADATA: facts}
    digest = settle(found.messages, out, attachments=found.attachments, metadata=metadata)
    with TraceFile(out) as written:
        lost_pictures = len(list(missing_pictures(written)))
    return Recovered(
        path=out,
        sha256=digest,
        messages=len(found.messages),
        exchanges=sum(stored.topic in EXCHANGE_TOPICS for stored in found.messages),
        damaged=found.damaged,
        lost_bytes=0 if found.finished else len(data) - found.end,
        lost_pictures=lost_pictures,
        unverified=tuple(name for name in _CLOSING if f"{UNVERIFIED}{name}" in facts),
        complete=facts["complete"] == "yes",
    )


def _facts(found: Salvaged, source: Path) -> dict[str, str]:
    facts = dict(found.metadata.get(METADATA) or found.metadata.get(STARTED) or {})
    if not facts:
        message = f"nothing to recover: {source} was cut off before it said which run it is"
        raise TraceError(message)
    # The last metadata record is written after the last exchange: with it, everything is there.
    whole = METADATA in found.metadata and not found.damaged
    if found.sum_holds is False:
        whole = False
        for name in _CLOSING:
            if facts.get(name):
                facts[f"{UNVERIFIED}{name}"] = facts.pop(name)
    if not whole:
        facts |= {"complete": "no", "recovered": "yes"}
        facts.setdefault("outcome", "interrupted")
    return facts
