"""What people say about decisions, as events that are only ever added.

An event is tied to a trace by its digest and to a decision by its number; the trace itself is
never touched. Taking something back is an event too.
"""

from __future__ import annotations

import enum
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, cast

from pydantic import BaseModel, ConfigDict, ValidationError

from c2nav_engine.contract.outcome import Abstention, Ordering, Said, Tie
from c2nav_engine.errors import UsageError


class Kind(enum.StrEnum):
    """What an event says."""

    RANKING = "ranking"
    """The person's own answer to the question."""
    AGREE = "agree"
    ACCEPTABLE = "acceptable"
    WRONG = "wrong"
    CANNOT_TELL = "cannot-tell"
    BETTER = "better"
    """The alternative that would have been better."""
    TAG = "tag"
    """Puts a tag on (`extra["tag"]`), or takes it off where it is on."""
    LEG_END = "leg-end"
    """Where a leg ends on the path: `extra["leg"]` from 0, `extra["at_m"]` along the path."""
    NOTE = "note"
    REVEAL = "reveal"
    """The model's answer was shown to the person; that cannot be taken back."""
    UNDO = "undo"
    REDO = "redo"


VERDICTS = (Kind.AGREE, Kind.ACCEPTABLE, Kind.WRONG, Kind.CANNOT_TELL)


@dataclass(frozen=True, slots=True)
class Event:
    """One thing that one person said.

    Attributes:
        id: Names the event; adding the same event twice adds it once.
        kind: What it says.
        author: Who said it.
        trace_sha256: Digest of the trace.
        decision: Decision of that trace, from 0.
        said: The answer of a `RANKING` or `BETTER`; None for all others.
        reason: Free words; the text of a `NOTE`.
        blind: Whether the model's answer was hidden at that time.
        model_seen: Whether this person had seen the model's answer before.
        target: For `UNDO` and `REDO`: the event that it is about.
        when_s: Wall clock, seconds since the epoch.
        extra: Further facts, name → text.
    """

    id: str
    kind: Kind
    author: str
    trace_sha256: str
    decision: int
    said: Said | None = None
    reason: str = ""
    blind: bool = True
    model_seen: bool = False
    target: str = ""
    when_s: float = 0.0
    extra: Mapping[str, str] = field(default_factory=dict[str, str])


class _Line(BaseModel):
    """An event as one line of JSON; everything else is refused."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)

    id: str
    kind: str
    author: str
    trace_sha256: str
    decision: int
    said: dict[str, Any] | None = None
    reason: str = ""
    blind: bool = True
    model_seen: bool = False
    target: str = ""
    when_s: float = 0.0
    extra: dict[str, str] = {}


def event_json(event: Event) -> dict[str, Any]:
    """The event as plain JSON values."""
    return {
        "id": event.id,
        "kind": event.kind.value,
        "author": event.author,
        "trace_sha256": event.trace_sha256,
        "decision": event.decision,
        "said": said_json(event.said),
        "reason": event.reason,
        "blind": event.blind,
        "model_seen": event.model_seen,
        "target": event.target,
        "when_s": event.when_s,
        "extra": dict(event.extra),
    }


def event_line(event: Event) -> str:
    """The event as one line, the same for equal events."""
    return json.dumps(event_json(event), ensure_ascii=False, sort_keys=True)


def event_of(line: str, *, where: str = "the line") -> Event:
    """Read one line back; raises `UsageError` naming `where`."""
    try:
        read = _Line.model_validate_json(line)
        kind, said = Kind(read.kind), said_of(read.said)
    except (ValidationError, ValueError) as error:
        first = str(error).splitlines()[0]
        message = f"expected a review event in {where}, came {line[:80]!r} ({first})"
        raise UsageError(message) from None
    values = {name: getattr(read, name) for name in _PLAIN}
    return Event(kind=kind, said=said, **values)


_PLAIN = (
    "id",
    "author",
    "trace_sha256",
    "decision",
    "reason",
    "blind",
    "model_seen",
    "target",
    "when_s",
    "extra",
)


def said_json(said: Said | None) -> dict[str, Any] | None:
    """An answer as JSON: its tiers under "ordering" or "tie", or a reason under "none"."""
    if said is None:
        return None
    if isinstance(said, Abstention):
        return {"none": said.reason}
    name = "ordering" if isinstance(said, Ordering) else "tie"
    return {name: [list(tier) for tier in said.tiers]}


def said_of(value: Mapping[str, Any] | None) -> Said | None:
    """Read an answer back; raises `ValueError`."""
    if value is None:
        return None
    if len(value) != 1:
        message = f"expected one of ordering, tie, none; came {sorted(value)}"
        raise ValueError(message)
    (name, content), *_ = value.items()
    if name == "none" and isinstance(content, str):
        return Abstention(content)
    if name in ("ordering", "tie") and _tiered(content):
        tiers = tuple(tuple(tier) for tier in cast("list[list[str]]", content))
        return Ordering(tiers) if name == "ordering" else Tie(tiers)
    message = f"expected one of ordering, tie, none; came {name}: {content!r}"
    raise ValueError(message)


def _tiered(content: object) -> bool:
    if not isinstance(content, list):
        return False
    tiers = cast("list[object]", content)
    return all(
        isinstance(tier, list) and all(isinstance(key, str) for key in cast("list[object]", tier))
        for tier in tiers
    )
