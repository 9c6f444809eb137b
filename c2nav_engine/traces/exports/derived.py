"""Traces made from a trace: with people's reviews, or without its pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from c2nav_engine.contract.outcome import Answered
from c2nav_engine.errors import UsageError
from c2nav_engine.traces.apart import keep_apart
from c2nav_engine.traces.contract_messages import outcome_message, outcome_of
from c2nav_engine.traces.pb import common_pb2, review_pb2
from c2nav_engine.traces.reader import TraceFile
from c2nav_engine.traces.settle import settle
from c2nav_engine.traces.topics import IMAGE_TOPICS, METADATA, STARTED
from c2nav_engine.traces.writer import Outgoing, stored_message


@dataclass(frozen=True, slots=True)
class Review:
    """One event of a person's reviewing.

    Attributes:
        id: Names the event.
        trace_sha256: The trace it was made on.
        decision: Which decision.
        author: Name or pseudonym.
        kind: "ranking", "note", "undo", "redo" and whatever else the reviewing side names.
        outcome: The person's answer; None for events without one.
        reason: Free words.
        blind: Whether the model's ranking was hidden when it was made.
        model_seen: Whether the model's ranking had been seen before.
        target: The event that this one undoes or redoes.
        when_s: Wall clock, seconds since the epoch; outside the equality of traces.
        extra: Further facts, name → text.
    """

    id: str
    trace_sha256: str
    decision: int
    author: str
    kind: str
    outcome: Answered | None = None
    reason: str = ""
    blind: bool = True
    model_seen: bool = False
    target: str = ""
    when_s: float = 0.0
    extra: Mapping[str, str] = field(default_factory=dict[str, str])


def export_merged(trace: TraceFile, out: Path, *, reviews: Sequence[Review]) -> str:
    """A new trace with reviews beside the decisions they are about; returns its SHA-256.

    Raises:
        UsageError: A review is of another trace, or of a decision that is not there.
    """
    times_ns = trace.times_ns("/decision")
    for review in reviews:
        if review.trace_sha256 != trace.sha256:
            message = (
                f"expected reviews of trace {trace.sha256[:12]} ({trace.path}), review {review.id} "
                f"is of {review.trace_sha256[:12]}"
            )
            raise UsageError(message)
        if not 0 <= review.decision < len(times_ns):
            message = (
                f"expected a review of a decision from 0 to {len(times_ns) - 1}, review "
                f"{review.id} is of decision {review.decision}"
            )
            raise UsageError(message)
    messages = [
        Outgoing("/review", _review_message(review), times_ns[review.decision])
        for review in sorted(reviews, key=lambda review: review.decision)
    ]
    facts = {"merged_from": trace.sha256, "reviews": str(len(reviews))}
    return _derive(trace, out, facts=facts, extra=messages)


def export_redacted(trace: TraceFile, out: Path) -> str:
    """A new trace without any picture: digests, words and numbers only; returns its SHA-256.

    Renderings of licensed scenes are derivatives of them; what is left here is not.
    """
    facts = {"redacted": "yes", "redacted_from": trace.sha256}
    return _derive(trace, out, facts=facts, without=IMAGE_TOPICS)


def reviews_of(trace: TraceFile) -> list[Review]:
    """The reviews in a merged trace, in its order."""
    messages = trace.messages("/review")
    return [_review_of(review_pb2.Review.FromString(stored.data)) for stored in messages]


def _derive(
    trace: TraceFile,
    out: Path,
    *,
    facts: Mapping[str, str],
    without: Sequence[str] = (),
    extra: Sequence[Outgoing] = (),
) -> str:
    keep_apart(out, trace.path)
    kept = [stored for stored in trace.messages() if stored.topic not in without]
    added = [stored_message(outgoing, number) for number, outgoing in enumerate(extra)]
    return settle(
        [*kept, *added],
        out,
        attachments=[trace.attached(name) for name in trace.attachments],
        metadata={
            STARTED: trace.metadata(STARTED),
            METADATA: {**trace.facts, **facts},
        },
    )


def _review_message(review: Review) -> review_pb2.Review:
    return review_pb2.Review(
        id=review.id,
        trace_sha256=review.trace_sha256,
        decision=review.decision,
        author=review.author,
        kind=review.kind,
        outcome=None if review.outcome is None else outcome_message(review.outcome),
        reason=review.reason,
        blind=review.blind,
        model_seen=review.model_seen,
        target=review.target,
        extra=[common_pb2.Text(name=name, value=text) for name, text in review.extra.items()],
        wall=review_pb2.ReviewWall(when_s=review.when_s),
    )


def _review_of(message: review_pb2.Review) -> Review:
    return Review(
        id=message.id,
        trace_sha256=message.trace_sha256,
        decision=message.decision,
        author=message.author,
        kind=message.kind,
        outcome=outcome_of(message.outcome) if message.HasField("outcome") else None,
        reason=message.reason,
        blind=message.blind,
        model_seen=message.model_seen,
        target=message.target,
        when_s=message.wall.when_s,
        extra={each.name: each.value for each in message.extra},
    )
