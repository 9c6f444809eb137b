"""A person as a ranker: the question is handed to an interface and its answer waited for."""

from __future__ import annotations

from threading import Condition

from c2nav_engine.contract.outcome import Abstention, Answered
from c2nav_engine.contract.prompt import Prompt, Reply
from c2nav_engine.errors import RankerStopped

PASSED = "the person passed"
"""Reason of the abstention when a person declines to rank."""


class HandOver:
    """Where a question waits for a person; safe between the asking and the interface's threads.

    The asking thread blocks in `ask`; any other thread reads `pending`, and calls `submit` or
    `cancel`.
    """

    def __init__(self) -> None:
        self._changed = Condition()
        self._pending: Prompt | None = None
        self._answer: Answered | None = None
        self._cancelled = False

    @property
    def pending(self) -> Prompt | None:
        """The prompt that waits for a person, if one does."""
        with self._changed:
            return self._pending

    def ask(self, prompt: Prompt) -> Answered:
        """Offer a prompt and wait; raises `RankerStopped` once cancelled."""
        with self._changed:
            self._pending, self._answer = prompt, None
            self._changed.notify_all()
            self._changed.wait_for(lambda: self._cancelled or self._answer is not None)
            self._pending = None
            if self._answer is None:
                raise RankerStopped("the person closed the session before answering")
            return self._answer

    def submit(self, outcome: Answered, *, request_sha256: str) -> bool:
        """Answer the pending prompt; False when another one, or none, is pending."""
        with self._changed:
            if self._pending is None or self._pending.request_sha256 != request_sha256:
                return False
            self._answer = outcome
            self._changed.notify_all()
            return True

    def skip(self, *, request_sha256: str) -> bool:
        """Decline to rank: an abstention."""
        return self.submit(Abstention(PASSED), request_sha256=request_sha256)

    def cancel(self) -> None:
        """Release whoever waits now or later."""
        with self._changed:
            self._cancelled = True
            self._changed.notify_all()

    def wait_pending(self, timeout_s: float) -> Prompt | None:
        """The pending prompt as soon as there is one, or None after the timeout."""
        with self._changed:
            self._changed.wait_for(lambda: self._pending is not None, timeout_s)
            return self._pending


class Human:
    """An adapter over a hand-over; a person is asked once, whatever the question's orders.

    Args:
        desk: Where questions wait.
        who: Name or pseudonym for the record.
    """

    def __init__(self, desk: HandOver, *, who: str = "") -> None:
        self._desk = desk
        self._who = who

    @property
    def name(self) -> str:
        """What records call the person."""
        return f"human:{self._who}" if self._who else "human"

    @property
    def asks_once(self) -> bool:
        """One presentation per question."""
        return True

    def answer(self, prompt: Prompt) -> Reply:
        """Wait for the person."""
        return Reply(outcome=self._desk.ask(prompt))
