"""`complete(text) -> text` through a ranker's server: the route parser's language model."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from functools import lru_cache

from c2nav_engine.contract.outcome import TransportFailure
from c2nav_engine.errors import RankerUnavailable, UsageError
from c2nav_engine.rankers.accounting import AskingConfig
from c2nav_engine.rankers.protocol import Adapter, Saying


def completion_through(
    adapter: Adapter,
    config: AskingConfig | None = None,
    *,
    sleep: Callable[[float], None] = time.sleep,
) -> Callable[[str], str]:
    """A function that completes each text once and remembers it.

    It raises `RankerUnavailable` when there is no answer and `RankerStopped` when none can come;
    this function itself raises `UsageError` for a ranker without a language model.
    """
    if not isinstance(adapter, Saying):
        message = f"expected a ranker with a language model to parse routes, came {adapter.name}"
        raise UsageError(f"{message}. Use openai-chat or openai-responses, or the English parser")
    asking = config or AskingConfig()

    @lru_cache(maxsize=4096)
    def complete(text: str) -> str:
        for attempt in itertools.count():
            reply = adapter.say(text)
            if not isinstance(reply.outcome, TransportFailure):
                return reply.text
            if reply.retry_after_s is None or attempt >= asking.retries:
                reason = reply.outcome.reason
                raise RankerUnavailable(f"{adapter.name} completed no text: {reason}")
            sleep(max(asking.backoff_s * 2**attempt, reply.retry_after_s))
        return ""

    return complete
