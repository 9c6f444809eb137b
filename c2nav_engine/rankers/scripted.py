"""Answers written in advance: for tests, demonstrations and benchmarks."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Mapping
from threading import Lock

from c2nav_engine.contract.outcome import Answered
from c2nav_engine.contract.prompt import Prompt, Reply
from c2nav_engine.contract.question import Slot
from c2nav_engine.errors import RankerStopped
from c2nav_engine.rankers.options import OptionReader, Options

Said = str | Answered | Reply
"""Raw text to be parsed, a finished outcome over keys, or a whole reply."""


class Scripted:
    """Plays answers from a callable, or from one list per slot.

    Args:
        script: `prompt -> answer`, or slot → answers in the order of asking. A list that runs
            out raises `RankerStopped`.
        asks_once: As a person would be asked.
        name: What records call it.
    """

    def __init__(
        self,
        script: Callable[[Prompt], Said] | Mapping[Slot, Iterable[Said]],
        *,
        asks_once: bool = False,
        name: str = "scripted",
    ) -> None:
        self._say = script if callable(script) else _from_lists(script)
        self._asks_once = asks_once
        self._name = name

    @property
    def name(self) -> str:
        """What records call it."""
        return self._name

    @property
    def asks_once(self) -> bool:
        """Whether it gets one presentation per question."""
        return self._asks_once

    def answer(self, prompt: Prompt) -> Reply:
        """The next answer of the script."""
        said = self._say(prompt)
        if isinstance(said, Reply):
            return said
        return Reply(text=said) if isinstance(said, str) else Reply(outcome=said)

    @classmethod
    def from_options(cls, options: Options) -> Scripted:
        """`answer=TEXT`: the same raw text to every question."""
        reader = OptionReader("scripted", options)
        text = reader.text("answer")
        reader.done()
        return cls(lambda prompt: text or " > ".join(label for label, _ in prompt.labels))


def _from_lists(script: Mapping[Slot, Iterable[Said]]) -> Callable[[Prompt], Said]:
    left = {slot: iter(answers) for slot, answers in script.items()}
    lock = Lock()

    def say(prompt: Prompt) -> Said:
        slot = prompt.question.slot
        with lock:
            for said in itertools.islice(left.get(slot, iter(())), 1):
                return said
        message = f"the script has no further answer to a {slot.value} question; add one"
        raise RankerStopped(message)

    return say
