"""How persistently a ranker asks, and what it has used."""

from __future__ import annotations

from dataclasses import dataclass, field
from threading import Lock

from c2nav_engine.contract.prompt import Reply
from c2nav_engine.errors import RankerStopped


@dataclass(frozen=True, slots=True)
class AskingConfig:
    """How persistently and how widely a ranker asks.

    Attributes:
        repairs: Repair attempts per presentation [C].
        retries: Further tries after a transport failure, per query [C].
        backoff_s: First pause before a retry; doubles each time [C].
        longest_pause_s: A server's Retry-After beyond this is not waited for [C].
        concurrency: Queries under way at once, over all episodes that share the ranker [C].
        max_queries: Queries before the run stops; None for no limit.
        max_cost_usd: Known cost before the run stops; None for no limit.
        cache: Folder of the answer cache; "" asks every time.
    """

    repairs: int = 1
    retries: int = 4
    backoff_s: float = 0.5
    longest_pause_s: float = 60.0
    concurrency: int = 8
    max_queries: int | None = None
    max_cost_usd: float | None = None
    cache: str = ""


@dataclass
class Spent:
    """What a ranker has used so far; safe to share between threads.

    Attributes:
        queries: Queries answered, retries and repairs included.
        cached: Of these, answered from the cache.
        tokens_in: Prompt tokens where known.
        tokens_out: Completion tokens where known.
        cost_usd: Price where known.
        latency_s: Waiting time over all queries.
    """

    queries: int = 0
    cached: int = 0
    tokens_in: int = 0
    tokens_out: int = 0
    cost_usd: float = 0.0
    latency_s: float = 0.0
    _lock: Lock = field(default_factory=Lock, repr=False, compare=False)

    def add(self, reply: Reply) -> None:
        """Count one query."""
        with self._lock:
            self.queries += 1
            self.cached += reply.cached
            self.tokens_in += reply.tokens_in or 0
            self.tokens_out += reply.tokens_out or 0
            self.cost_usd += reply.cost_usd or 0.0
            self.latency_s += reply.latency_s

    def check(self, config: AskingConfig, *, more: int) -> None:
        """Raise `RankerStopped` when that many more queries would leave the budget."""
        sent = self.queries - self.cached
        if config.max_queries is not None and sent + more > config.max_queries:
            raise RankerStopped(f"the budget of {config.max_queries} queries is used up")
        if config.max_cost_usd is not None and self.cost_usd >= config.max_cost_usd:
            raise RankerStopped(f"the budget of {config.max_cost_usd} USD is used up")
