"""The one wrapper around every adapter: it owns the protocol, adapters only carry questions.

Order of events for one question: every presentation goes out; failures of the transport are
tried again; answers that cannot be read get one repair attempt with the format reminder; then the
outcomes are aggregated. The full record of all queries goes back with the outcome.
"""

from __future__ import annotations

import itertools
import logging
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path
from threading import BoundedSemaphore, Lock

from c2nav_engine.contract.aggregate import aggregate
from c2nav_engine.contract.outcome import (
    Answered,
    Empty,
    Invalid,
    Refused,
    TransportFailure,
    Truncated,
)
from c2nav_engine.contract.presentation import presentations
from c2nav_engine.contract.prompt import Prompt, Query, Ranked, Reply
from c2nav_engine.contract.question import Question
from c2nav_engine.contract.render import render, render_as
from c2nav_engine.errors import RankerUnavailable
from c2nav_engine.rankers.accounting import AskingConfig, Spent
from c2nav_engine.rankers.cache import AnswerCache
from c2nav_engine.rankers.protocol import (
    Adapter,
    BatchAdapter,
    Closable,
    Fingerprinted,
    Startable,
)
from c2nav_engine.rankers.reading import read
from c2nav_engine.rankers.tally import Tally, Telling

REPAIRABLE = (Invalid, Empty, Truncated, Refused)
"""Answers that a format reminder may mend. A tie or an abstention is well formed: pressing for a
winner would turn doubt into a choice."""


_LOG = logging.getLogger(__name__)


class AskingRanker:
    """A `Ranker` out of an adapter; one instance serves any number of threads.

    Args:
        adapter: What answers single prompts.
        config: Retries, budget, concurrency, cache.
        clock: Monotonic seconds, for latencies alone.
        sleep: Waits between retries.
        privileged: Whether the adapter knows the truth (simulated observers).
    """

    def __init__(
        self,
        adapter: Adapter,
        config: AskingConfig | None = None,
        *,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
        privileged: bool = False,
    ) -> None:
        self._adapter = adapter
        self._config = config or AskingConfig()
        self._cache = _cache_of(adapter, self._config)
        self._clock = clock
        self._sleep = sleep
        self._privileged = privileged
        self._under_way = BoundedSemaphore(self._config.concurrency)
        self._starting = Lock()
        self._warnings: tuple[str, ...] | None = None
        self.spent = Spent()

    @property
    def name(self) -> str:
        """The adapter's name, with the model id where there is one."""
        return self._adapter.name

    def rank(self, question: Question) -> Ranked:
        """Ask in every order the question wants, parse, repair once, aggregate.

        Raises:
            RankerStopped: No further query makes sense, or the budget is used up.
            RankerUnavailable: A transport failure outlived its retries.
        """
        return self._rank(question, Tally())

    def rank_telling(self, question: Question, told: Telling) -> Ranked:
        """As `rank`; tells how many queries are answered, of how many it takes so far."""
        return self._rank(question, Tally(told))

    def _rank(self, question: Question, tally: Tally) -> Ranked:
        self.start()
        shown = presentations(question, once=self._adapter.asks_once)
        asked = [render(question, order) for order in range(len(shown))]
        queries, final = self._settle(asked, tally)
        outcome = aggregate(question, list(final.values()))
        return Ranked(outcome, tuple(queries), self.name, self._privileged)

    def put(self, prompt: Prompt) -> tuple[Query, ...]:
        """Put exactly this prompt, with retries and repairs; the last query is its answer.

        For audits, which choose labels and orders themselves. Raises as `rank`.
        """
        self.start()
        return tuple(self._settle([prompt], Tally())[0])

    def start(self) -> tuple[str, ...]:
        """Let the adapter try itself out, once; returns its warnings, which are logged too.

        The first question does this where the caller did not.
        """
        with self._starting:
            if self._warnings is None:
                adapter = self._adapter
                self._warnings = adapter.start() if isinstance(adapter, Startable) else ()
                for warning in self._warnings:
                    _LOG.warning("%s: %s", self.name, warning)
            return self._warnings

    def close(self) -> None:
        """Release what the adapter holds, if it holds anything."""
        if isinstance(self._adapter, Closable):
            self._adapter.close()

    def _settle(self, asked: list[Prompt], tally: Tally) -> tuple[list[Query], dict[int, Answered]]:
        """Every query it took, and the final outcome of each presentation."""
        queries: list[Query] = []
        final: dict[int, Answered] = {}
        while asked:
            tally.expect(len(asked))
            finished = self._ask_until_answered(asked, queries, tally)
            final.update({query.prompt.order: query.outcome for query in finished})
            asked = [
                _repaired(query.prompt)
                for query in finished
                if isinstance(query.outcome, REPAIRABLE)
                and query.prompt.repair < self._config.repairs
            ]
        return queries, final

    def _ask_until_answered(
        self, prompts: list[Prompt], queries: list[Query], tally: Tally
    ) -> list[Query]:
        """One finished query per prompt; every try is appended to `queries`."""
        finished: list[Query] = []
        for attempt in itertools.count():
            tried = [
                Query(prompt, reply, read(prompt, reply))
                for prompt, reply in zip(prompts, self._send(prompts, tally), strict=True)
            ]
            queries += tried
            failed = [query for query in tried if isinstance(query.outcome, TransportFailure)]
            finished += [query for query in tried if query not in failed]
            if not failed:
                break
            self._sleep(max(self._pause_s(query, attempt) for query in failed))
            prompts = [query.prompt for query in failed]
        return finished

    def _pause_s(self, failed: Query, attempt: int) -> float:
        """How long to wait before the next try; raises `RankerUnavailable` when there is none."""
        wanted_s = failed.reply.retry_after_s
        hopeless = wanted_s is None or wanted_s > self._config.longest_pause_s
        if hopeless or attempt >= self._config.retries:
            raise self._unavailable(failed)
        return max(self._config.backoff_s * 2**attempt, wanted_s or 0.0)

    def _unavailable(self, failed: Query) -> RankerUnavailable:
        slot = failed.prompt.question.slot.value
        reason = getattr(failed.outcome, "reason", "")
        return RankerUnavailable(
            f"expected {self.name} to answer a {slot} question, came: {reason}. "
            "Mend that, then resume the run"
        )

    def _send(self, prompts: Sequence[Prompt], tally: Tally) -> list[Reply]:
        """One reply per prompt: from the cache where it has one, else from the adapter."""
        replies = [self._cache.get(prompt) if self._cache else None for prompt in prompts]
        missing = [index for index, reply in enumerate(replies) if reply is None]
        tally.came(len(prompts) - len(missing))
        asked = self._ask_adapter([prompts[index] for index in missing], tally) if missing else []
        for index, reply in zip(missing, asked, strict=True):
            replies[index] = reply
            if self._cache:
                self._cache.put(prompts[index], reply)
        finished = [reply for reply in replies if reply is not None]
        for reply in finished:
            self.spent.add(reply)
        return finished

    def _ask_adapter(self, prompts: Sequence[Prompt], tally: Tally) -> list[Reply]:
        self.spent.check(self._config, more=len(prompts))
        if isinstance(self._adapter, BatchAdapter):
            replies = self._batch(self._adapter, prompts)
            tally.came(sum(_arrived(reply) for reply in replies))
            return replies
        if len(prompts) == 1 or self._config.concurrency == 1:
            return [self._one(prompt, tally) for prompt in prompts]
        with ThreadPoolExecutor(len(prompts)) as pool:
            return list(pool.map(partial(self._one, tally=tally), prompts))

    def _one(self, prompt: Prompt, tally: Tally) -> Reply:
        reply = self._timed(lambda: [self._adapter.answer(prompt)])[0]
        if _arrived(reply):
            tally.came()
        return reply

    def _batch(self, adapter: BatchAdapter, prompts: Sequence[Prompt]) -> list[Reply]:
        return self._timed(lambda: adapter.answer_all(prompts))

    def _timed(self, ask: Callable[[], list[Reply]]) -> list[Reply]:
        with self._under_way:
            start_s = self._clock()
            replies = ask()
            share_s = (self._clock() - start_s) / max(1, len(replies))
        return [replace(reply, latency_s=reply.latency_s or share_s) for reply in replies]


def _arrived(reply: Reply) -> bool:
    return not isinstance(reply.outcome, TransportFailure)


def _repaired(prompt: Prompt) -> Prompt:
    """The same presentation with the format reminder."""
    repair = prompt.repair + 1
    return render_as(prompt.question, prompt.labels, order=prompt.order, repair=repair)


def _cache_of(adapter: Adapter, config: AskingConfig) -> AnswerCache | None:
    """The answer cache, keyed by everything besides the request that shapes an answer."""
    if not config.cache:
        return None
    fingerprint = adapter.fingerprint if isinstance(adapter, Fingerprinted) else ""
    return AnswerCache(Path(config.cache), {"name": adapter.name, "settings": fingerprint})
