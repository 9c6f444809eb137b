"""What both OpenAI-style interfaces share: one user message out, one reply in."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar, TypeVar

from c2nav_engine.contract.outcome import Answered
from c2nav_engine.contract.prompt import Part, Prompt, Reply
from c2nav_engine.contract.schemas import Schema, answer_schema
from c2nav_engine.rankers import json_reading as read
from c2nav_engine.rankers.openai_settings import ServerSettings, settings_from
from c2nav_engine.rankers.openai_transport import Json, Transport
from c2nav_engine.rankers.options import Options
from c2nav_engine.rankers.probe import probe

T = TypeVar("T", bound="ServedModel")


class ServedModel(ABC):
    """A model behind a server; an interface adds how a request and an answer are written.

    Attributes:
        INTERFACE: Name of the ranker without a preset.
        PATH: Where requests go, below the base URL.
        USAGE: Fields of `usage` that count tokens, in and out.

    Args:
        settings: Server, model and how to ask.
        name: What records call the adapter: the interface, or a preset.
    """

    INTERFACE: ClassVar[str]
    PATH: ClassVar[str]
    USAGE: ClassVar[tuple[str, str]]

    def __init__(self, settings: ServerSettings, *, name: str = "") -> None:
        self._settings = settings
        self._name = name or self.INTERFACE
        self._transport = Transport(settings)

    @classmethod
    def from_options(cls: type[T], options: Options, *, name: str = "") -> T:
        """Options of `openai_settings.settings_from`; `name` may be a preset's."""
        name = name or cls.INTERFACE
        return cls(settings_from(name, options), name=name)

    @property
    def name(self) -> str:
        """Adapter and model id."""
        return f"{self._name}:{self._settings.model}"

    @property
    def asks_once(self) -> bool:
        """A model is asked in every order the question wants."""
        return False

    @property
    def fingerprint(self) -> str:
        """The settings, which name the key's variable but never hold the key."""
        return repr(self._settings)

    @property
    def options(self) -> dict[str, str]:
        """The settings as options, defaults and a preset's choices included."""
        return self._settings.as_options()

    def start(self) -> tuple[str, ...]:
        """Try the server out; returns warnings."""
        return probe(self.send) if self._settings.probe else ()

    def answer(self, prompt: Prompt) -> Reply:
        """One query."""
        return self.send(prompt.parts, answer_schema(prompt))

    def say(self, text: str) -> Reply:
        """A language-only completion, for the route parser."""
        return self.send((text,), None)

    def send(self, parts: tuple[Part, ...], schema: Schema | None) -> Reply:
        """Any words and pictures, with the schema of the wanted answer where there is one."""
        answer = self._transport.post(self.PATH, self.body(parts, schema))
        return answer if isinstance(answer, Reply) else self._reply(answer)

    def close(self) -> None:
        """Close the connections."""
        self._transport.close()

    @abstractmethod
    def body(self, parts: tuple[Part, ...], schema: Schema | None) -> Json:
        """The request as it goes out."""

    @abstractmethod
    def meaning(self, answer: Json) -> tuple[Answered | None, str]:
        """What an answer already says by itself, None when its text is to be parsed; the text."""

    def _reply(self, answer: Json) -> Reply:
        outcome, said = self.meaning(answer)
        tokens_in, tokens_out = (read.count(answer, "usage", field) for field in self.USAGE)
        return Reply(
            outcome=outcome,
            text=said,
            tokens_in=tokens_in,
            tokens_out=tokens_out,
            cost_usd=self._settings.capabilities.cost_usd(tokens_in, tokens_out),
            model=read.text(answer, "model"),
        )
