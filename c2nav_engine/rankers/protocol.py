"""The one protocol between the loop and anything that compares."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol, runtime_checkable

from c2nav_engine.contract.prompt import Prompt, Ranked, Reply
from c2nav_engine.contract.question import Question
from c2nav_engine.rankers.tally import Telling


@runtime_checkable
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


@runtime_checkable
class BatchAdapter(Protocol):
    """An adapter that answers several prompts at less cost than one by one."""

    def answer_all(self, prompts: Sequence[Prompt]) -> list[Reply]:
        """One reply per prompt, in order."""
        ...


@runtime_checkable
class Startable(Protocol):
    """An adapter that can try itself out before the first question."""

    def start(self) -> tuple[str, ...]:
        """Warnings; raises `RankerStopped` when no query makes sense."""
        ...


@runtime_checkable
class Fingerprinted(Protocol):
    """An adapter whose settings shape its answers."""

    @property
    def fingerprint(self) -> str:
        """Every such setting (model, sampling, picture size) as text; never a key."""
        ...


@runtime_checkable
class Told(Protocol):
    """An adapter whose record says how it was asked, whatever was left to its defaults."""

    @property
    def options(self) -> Mapping[str, str]:
        """Options that make the same adapter again; never a key."""
        ...


@runtime_checkable
class Saying(Protocol):
    """An adapter with a language model behind it that also takes plain text."""

    def say(self, text: str) -> Reply:
        """One language-only completion."""
        ...


@runtime_checkable
class Closable(Protocol):
    """An adapter that holds connections or a model."""

    def close(self) -> None:
        """Release them."""
        ...


@runtime_checkable
class Ranker(Protocol):
    """`rank(question) -> Ranked`: an adapter inside the wrapper that owns the protocol."""

    @property
    def name(self) -> str:
        """What records call it."""
        ...

    def rank(self, question: Question) -> Ranked:
        """Ask in every order the question wants, parse, repair once, aggregate."""
        ...


@runtime_checkable
class Counting(Ranker, Protocol):
    """A ranker that tells how far a question is while it waits for answers."""

    def rank_telling(self, question: Question, told: Telling) -> Ranked:
        """As `rank`; `told` is called from the threads that ask."""
        ...
