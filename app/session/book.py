"""What the session asks of a book of reviews; `app.reviews.audit` keeps one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

from c2nav_engine.contract.outcome import Said

_NOTHING: Mapping[str, str] = {}


class Opinion(Protocol):
    """What one person now says about one decision: `app.reviews.state.Opinion`."""

    @property
    def ranking(self) -> Said | None:
        """Their own answer."""
        ...

    @property
    def verdict(self) -> str:
        """One of `VERDICTS`, or ""."""
        ...

    @property
    def better(self) -> Said | None:
        """The better alternative."""
        ...

    @property
    def tags(self) -> tuple[str, ...]:
        """In the order they were put on."""
        ...

    @property
    def leg_ends_m(self) -> Mapping[int, float]:
        """Leg → metres along the path."""
        ...

    @property
    def note(self) -> str:
        """Free words."""
        ...

    @property
    def blind(self) -> bool:
        """Whether all of it was said with the model's answer hidden."""
        ...


class Book(Protocol):
    """The reviews of one trace: `app.reviews.audit.AuditBook`."""

    def opinions(self) -> Mapping[tuple[str, int], Opinion]:
        """(Author, decision) → what they now say about it."""
        ...

    def seen_before(self, who: str) -> int:
        """Decisions, from 0, whose answers this person is known to have seen."""
        ...

    def add(
        self,
        kind: str,
        decision: int,
        *,
        who: str,
        seen: bool,
        said: Said | None = None,
        words: str = "",
        extra: Mapping[str, str] = _NOTHING,
    ) -> None:
        """Say something; raises `C2NavError` when it cannot be stored."""
        ...

    def take_back(self, decision: int, kinds: Sequence[str], *, who: str) -> None:
        """Take back whatever of these kinds the person says about a decision."""
        ...

    def undo(self, who: str) -> int | None:
        """Take the person's last word back; returns its decision."""
        ...

    def redo(self, who: str) -> int | None:
        """Say again what was taken back last; returns its decision."""
        ...

    def bind(self, trace_sha256: str) -> None:
        """The trace is finished and has this digest."""
        ...

    def tags(self) -> tuple[str, ...]:
        """The list of tags to choose from."""
        ...

    def keep_tags(self, tags: Sequence[str]) -> None:
        """Replace that list."""
        ...
