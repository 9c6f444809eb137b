"""`openai-chat`: any server that speaks the chat completions interface (vLLM, SGLang, hosted)."""

from __future__ import annotations

from c2nav_engine.contract.outcome import Empty, Refused, Truncated
from c2nav_engine.contract.prompt import Part, Prompt, Reply
from c2nav_engine.contract.schemas import Schema, answer_schema
from c2nav_engine.rankers import json_reading as read
from c2nav_engine.rankers.images import data_url
from c2nav_engine.rankers.openai_settings import SAMPLING, ServerSettings, settings_from
from c2nav_engine.rankers.openai_transport import Json, Transport
from c2nav_engine.rankers.options import Options
from c2nav_engine.rankers.probe import probe


class OpenAIChat:
    """One user message per query: words and pictures in the prompt's order.

    Args:
        settings: Server, model and how to ask.
        name: What records call the adapter.
    """

    def __init__(self, settings: ServerSettings, *, name: str = "openai-chat") -> None:
        self._settings = settings
        self._name = name
        self._transport = Transport(settings)

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

    def answer(self, prompt: Prompt) -> Reply:
        """One completion."""
        return self.send(prompt.parts, answer_schema(prompt))

    def send(self, parts: tuple[Part, ...], schema: Schema | None) -> Reply:
        """Any words and pictures, with the schema of the wanted answer where there is one."""
        answer = self._transport.post("/chat/completions", self.body(parts, schema))
        return answer if isinstance(answer, Reply) else self._reply(answer)

    def body(self, parts: tuple[Part, ...], schema: Schema | None) -> Json:
        """The request as it goes out."""
        settings = self._settings
        takes = settings.capabilities
        body: dict[str, object] = {
            "model": settings.model,
            "messages": [{"role": "user", "content": [self._part(part) for part in parts]}],
            takes.limit_field: settings.answer_tokens,
            "stream": False,
        }
        if takes.temperature:
            body |= SAMPLING[settings.sampling]
        if takes.effort and settings.effort:
            body["reasoning_effort"] = settings.effort
        if settings.schema and schema is not None:
            named = {"name": "answer", "strict": True, "schema": schema}
            body["response_format"] = {"type": "json_schema", "json_schema": named}
        return body

    def say(self, text: str) -> Reply:
        """A language-only completion, for the route parser."""
        return self.send((text,), None)

    def start(self) -> tuple[str, ...]:
        """Try the server out; returns warnings."""
        return probe(self.send) if self._settings.probe else ()

    def close(self) -> None:
        """Close the connections."""
        self._transport.close()

    @classmethod
    def from_options(cls, options: Options, *, name: str = "openai-chat") -> OpenAIChat:
        """Options of `openai_settings.settings_from`; `name` may be a preset's."""
        return cls(settings_from(name, options), name=name)

    def _part(self, part: Part) -> dict[str, object]:
        if isinstance(part, str):
            return {"type": "text", "text": part}
        image: dict[str, object] = {"url": data_url(part, image_px=self._settings.image_px)}
        if self._settings.capabilities.detail or self._settings.detail != "auto":
            image["detail"] = self._settings.detail
        return {"type": "image_url", "image_url": image}

    def _reply(self, answer: Json) -> Reply:
        choice = ("choices", 0)
        finish = read.text(answer, *choice, "finish_reason")
        said = read.text(answer, *choice, "message", "content")
        refusal = read.text(answer, *choice, "message", "refusal")
        tokens = (
            read.count(answer, "usage", "prompt_tokens"),
            read.count(answer, "usage", "completion_tokens"),
        )
        outcome = None
        if refusal or finish == "content_filter":
            outcome, said = Refused(), refusal or said
        elif finish == "length":
            # Cut short, "A > B" may have been on its way to anything: nothing of it is used.
            outcome = Truncated()
        elif not said.strip():
            outcome = Empty()
        return Reply(
            outcome=outcome,
            text=said,
            tokens_in=tokens[0],
            tokens_out=tokens[1],
            cost_usd=self._settings.capabilities.cost_usd(*tokens),
            model=read.text(answer, "model"),
        )
