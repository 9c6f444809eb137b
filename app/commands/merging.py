"""People's reviews as a trace takes them in: out of a store, a file, or another trace."""

from __future__ import annotations

from pathlib import Path

from app.reviews.audit import store_beside
from app.reviews.events import Event
from app.reviews.store import FILE, Store, read_lines, shared_events
from c2nav_engine.errors import UsageError
from c2nav_engine.traces.exports import Review, reviews_of
from c2nav_engine.traces.reader import TraceFile


def reviews_for(trace: TraceFile, source: Path | None) -> list[Review]:
    """The reviews of one trace.

    Args:
        trace: Which trace; events of others are passed over.
        source: A run folder, its store, an export of reviews, or a merged trace; by default the
            run or folder that the trace lies in.

    Raises:
        UsageError: There is no such source.
    """
    found = source if source is not None else store_beside(trace.path).parent
    if found.suffix == ".mcap":
        with TraceFile(found) as other:
            return [review for review in reviews_of(other) if review.trace_sha256 == trace.sha256]
    return [_review(event) for event in _events(found) if event.trace_sha256 == trace.sha256]


def _events(source: Path) -> list[Event]:
    """Events with people under their pseudonyms."""
    store = source / FILE if source.is_dir() else source
    if not store.is_file():
        message = (
            f"expected reviews at {store}, found none; name a run folder, its {FILE}, an export "
            "of reviews, or a merged trace with --with"
        )
        raise UsageError(message)
    if store.suffix == Path(FILE).suffix:
        with Store(store) as opened:
            return shared_events(opened)
    return read_lines(store.read_text(encoding="utf-8").splitlines(), where=str(store))


def _review(event: Event) -> Review:
    return Review(
        id=event.id,
        trace_sha256=event.trace_sha256,
        decision=event.decision,
        author=event.author,
        kind=event.kind.value,
        outcome=event.said,
        reason=event.reason,
        blind=event.blind,
        model_seen=event.model_seen,
        target=event.target,
        when_s=event.when_s,
        extra=dict(event.extra),
    )
