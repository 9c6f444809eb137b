"""Judgements of decisions while the page is open: an append-only list with undo and redo."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from app.session.snapshot import Judgement

Change = Callable[[Judgement], Judgement]


class Bench:
    """What people said about the decisions of one recording.

    Nothing here touches the trace: judgements stand beside it, tied to its digest.
    """

    def __init__(self, trace_sha256: str = "") -> None:
        """Start empty for one recording ("" for a live episode)."""
        self.trace_sha256 = trace_sha256
        self._done: list[tuple[int, Change]] = []
        self._undone: list[tuple[int, Change]] = []

    def judge(self, decision: int, change: Change) -> None:
        """Add one judgement; what was undone before is gone."""
        self._done.append((decision, change))
        self._undone.clear()

    def undo(self) -> int | None:
        """Take the last one back; returns its decision."""
        return _shift(self._done, self._undone)

    def redo(self) -> int | None:
        """Put the last undone one back; returns its decision."""
        return _shift(self._undone, self._done)

    def judgements(self) -> dict[int, Judgement]:
        """What holds now, by decision."""
        held: dict[int, Judgement] = {}
        for decision, change in self._done:
            held[decision] = change(held.get(decision, Judgement()))
        return {number: judgement for number, judgement in held.items() if judgement != Judgement()}


def _shift(source: list[tuple[int, Change]], target: list[tuple[int, Change]]) -> int | None:
    if not source:
        return None
    target.append(source.pop())
    return target[-1][0]


def verdict(value: str) -> Change:
    """Give a verdict; the same again takes it back."""
    return lambda j: replace(j, verdict="" if j.verdict == value else value)


def tag(value: str) -> Change:
    """Add a tag, or take it off."""
    return lambda j: replace(
        j, tags=tuple(t for t in j.tags if t != value) if value in j.tags else (*j.tags, value)
    )


def flag() -> Change:
    """Mark for later, or take the mark off."""
    return lambda j: replace(j, flagged=not j.flagged)


def remark(text: str) -> Change:
    """Write a note; empty takes it away."""
    return lambda j: replace(j, note=text)
