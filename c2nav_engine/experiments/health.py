"""Whether a run's answers can be trusted: unusable ones, order effects, tokens, who served.

Counted once a trace and added up over a run, so that a page need not read traces again.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields

from pydantic import TypeAdapter

from c2nav_engine.contract.outcome import (
    Empty,
    Invalid,
    Ordering,
    Refused,
    TransportFailure,
    Truncated,
)
from c2nav_engine.contract.prompt import Prompt, Query
from c2nav_engine.experiments.expected import CHARS_PER_TOKEN, picture_tokens
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.exchange import Exchange

_KINDS: Mapping[type, str] = {
    Invalid: "invalid",
    Refused: "refused",
    Truncated: "truncated",
    Empty: "empty",
    TransportFailure: "failed",
}


@dataclass(slots=True)
class SlotHealth:
    """Counts of one decision slot.

    Attributes:
        questions: Questions put.
        queries: Queries they took.
        invalid: Answers that named no ordering.
        refused: Answers declined.
        truncated: Answers cut off.
        empty: Answers that held nothing.
        failed: Queries without an answer.
        reordered: Questions shown in two or more orders, all of them answered with a winner.
        consistent: Of these, with one winner.
        counted: Queries whose prompt tokens are known.
        tokens_in: Sum of their prompt tokens.
        expected_tokens_in: What their words and pictures should have taken.
    """

    questions: int = 0
    queries: int = 0
    invalid: int = 0
    refused: int = 0
    truncated: int = 0
    empty: int = 0
    failed: int = 0
    reordered: int = 0
    consistent: int = 0
    counted: int = 0
    tokens_in: int = 0
    expected_tokens_in: float = 0.0

    @property
    def unusable(self) -> int:
        """Answers that could not be used."""
        return self.invalid + self.refused + self.truncated + self.empty

    def add(self, other: SlotHealth) -> None:
        """Add up, in place."""
        for each in fields(self):
            setattr(self, each.name, getattr(self, each.name) + getattr(other, each.name))


@dataclass(slots=True)
class Health:
    """Counts of one or more episodes.

    Attributes:
        slots: By decision slot.
        models: Served model id → queries that it answered.
    """

    slots: dict[str, SlotHealth] = field(default_factory=dict[str, SlotHealth])
    models: dict[str, int] = field(default_factory=dict[str, int])

    def slot(self, name: str) -> SlotHealth:
        """The counts of a slot, empty ones where it was never asked."""
        return self.slots.setdefault(name, SlotHealth())

    def as_json(self) -> str:
        """For keeping."""
        return _HEALTH.dump_json(self).decode()

    @staticmethod
    def from_json(text: str) -> Health:
        """What was kept; "" is nothing."""
        return _HEALTH.validate_json(text) if text else Health()


_HEALTH = TypeAdapter(Health)


def health_of(exchanges: Iterable[Exchange]) -> Health:
    """Count one episode."""
    health = Health()
    for exchange in exchanges:
        if isinstance(exchange.request, Ask) and exchange.ranked is not None:
            slot = health.slot(exchange.request.question.slot.value)
            slot.questions += 1
            for query in exchange.ranked.queries:
                _add_query(slot, health.models, query)
            _add_orders(slot, exchange.ranked.queries)
    return health


def merged(parts: Iterable[Health]) -> Health:
    """Add up episodes."""
    whole = Health()
    for part in parts:
        for name, counts in part.slots.items():
            whole.slot(name).add(counts)
        for model, count in part.models.items():
            whole.models[model] = whole.models.get(model, 0) + count
    return whole


def _add_query(slot: SlotHealth, models: dict[str, int], query: Query) -> None:
    slot.queries += 1
    kind = _KINDS.get(type(query.outcome))
    if kind is not None:
        setattr(slot, kind, getattr(slot, kind) + 1)
    if query.reply.model:
        models[query.reply.model] = models.get(query.reply.model, 0) + 1
    if query.reply.tokens_in is not None:
        slot.counted += 1
        slot.tokens_in += query.reply.tokens_in
        slot.expected_tokens_in += expected_tokens(query.prompt)


def expected_tokens(prompt: Prompt, *, least: int = 1) -> float:
    """Prompt tokens by its words and its pictures' sizes, as Qwen3-VL counts patches."""
    return sum(
        len(part) / CHARS_PER_TOKEN
        if isinstance(part, str)
        else picture_tokens(part.width_px, part.height_px, least=least)
        for part in prompt.parts
    )


def _add_orders(slot: SlotHealth, queries: Iterable[Query]) -> None:
    winners: Mapping[int, str] = {
        query.prompt.order: query.outcome.winner
        for query in queries
        if isinstance(query.outcome, Ordering)
    }
    if len(winners) >= 2:
        slot.reordered += 1
        slot.consistent += len(set(winners.values())) == 1
