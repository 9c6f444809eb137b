"""The one protocol between the loop and anything that compares."""

from __future__ import annotations

from typing import Protocol

from c2nav_engine.contract.prompt import Prompt, Ranked, Reply
from c2nav_engine.contract.question import Question


class Adapter(Protocol):
    """Carries one prompt to something that answers; knows nothing of orders or fallbacks."""

    @property
    def name(self) -> str:
        """What records call it, with the model id where there is one."""
        ...

    @property
    def asks_once(self) -> bool:
        """True for a person: one presentation whatever the question's orders."""
        ...

    def answer(self, prompt: Prompt) -> Reply:
        """One query; raises `RankerStopped` or `RankerUnavailable`, never for a bad answer."""
        ...


class Ranker(Protocol):
    """`rank(question) -> Ranked`: an adapter inside the wrapper that owns the protocol."""

    @property
    def name(self) -> str:
        """What records call it."""
        ...

    def rank(self, question: Question) -> Ranked:
        """Ask in every order the question wants, parse, repair once, aggregate."""
        ...
