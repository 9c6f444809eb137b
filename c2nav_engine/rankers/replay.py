"""Answers from a record: a mapping of request hashes, which the runner builds from a trace."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from threading import Lock

from c2nav_engine.contract.outcome import TransportFailure
from c2nav_engine.contract.prompt import Prompt, Ranked, Reply

NOT_RECORDED = "not in the record"
"""Begins the reason of the failure for a request that the record does not hold."""


class Replay:
    """Plays recorded replies; what it could not find is kept in `misses`.

    A request recorded several times (two steps with the same pictures) plays its replies in the
    recorded order and stays on the last.

    Args:
        recorded: Request hash → replies in recorded order.
        name: What records call it.
    """

    def __init__(self, recorded: Mapping[str, tuple[Reply, ...]], *, name: str = "replay") -> None:
        self._recorded = recorded
        self._played: dict[str, int] = {}
        self._lock = Lock()
        self._name = name
        self.misses: list[Prompt] = []

    @property
    def name(self) -> str:
        """What records call it."""
        return self._name

    @property
    def asks_once(self) -> bool:
        """It plays what was recorded, order by order."""
        return False

    def answer(self, prompt: Prompt) -> Reply:
        """The recorded reply, or a transport failure that no retry mends."""
        with self._lock:
            replies = self._recorded.get(prompt.request_sha256, ())
            if not replies:
                self.misses.append(prompt)
                reason = f"{NOT_RECORDED}: request {prompt.request_sha256[:12]}"
                return Reply(outcome=TransportFailure(reason), retry_after_s=None)
            turn = self._played.get(prompt.request_sha256, 0)
            self._played[prompt.request_sha256] = turn + 1
            return replies[min(turn, len(replies) - 1)]


def recorded_replies(record: Iterable[Ranked]) -> dict[str, tuple[Reply, ...]]:
    """Request hash → replies, over whole questions; failed transports are left out."""
    found: dict[str, tuple[Reply, ...]] = {}
    for ranked in record:
        for query in ranked.queries:
            if not isinstance(query.outcome, TransportFailure):
                key = query.prompt.request_sha256
                found[key] = (*found.get(key, ()), query.reply)
    return found
