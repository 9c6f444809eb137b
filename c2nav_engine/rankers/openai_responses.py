"""`openai-responses`: the responses interface, preferred for hosted reasoning models."""

from __future__ import annotations

from c2nav_engine.contract.outcome import Empty, Refused, TransportFailure, Truncated
from c2nav_engine.contract.prompt import Part, Prompt, Reply
from c2nav_engine.contract.schemas import Schema, answer_schema
from c2nav_engine.rankers import json_reading as read
from c2nav_engine.rankers.images import data_url
from c2nav_engine.rankers.openai_settings import SAMPLING, ServerSettings, settings_from
from c2nav_engine.rankers.openai_transport import Json, Transport
from c2nav_engine.rankers.options import Options
from c2nav_engine.rankers.probe import probe


class OpenAIResponses:
    """One stateless response per query; nothing is stored at the vendor.

    Args:
        settings: Server, model and how to ask.
        name: What records call the adapter.
    """

    def __init__(self, settings: ServerSettings, *, name: str = "openai-responses") -> None:
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
        """One response."""
        return self.send(prompt.parts, answer_schema(prompt))

    def send(self, parts: tuple[Part, ...], schema: Schema | None) -> Reply:
        """Any words and pictures, with the schema of the wanted answer where there is one."""
        answer = self._transport.post("/responses", self.body(parts, schema))
        return answer if isinstance(answer, Reply) else self._reply(answer)

    def body(self, parts: tuple[Part, ...], schema: Schema | None) -> Json:
        """The request as it goes out."""
        settings = self._settings
        body: dict[str, object] = {
            "model": settings.model,
            "input": [{"role": "user", "content": [self._part(part) for part in parts]}],
            "max_output_tokens": settings.answer_tokens,
            "store": False,
            "stream": False,
        }
        if settings.capabilities.temperature:
            body["temperature"] = SAMPLING[settings.sampling]["temperature"]
        if settings.capabilities.effort and settings.effort:
            body["reasoning"] = {"effort": settings.effort}
        if settings.schema and schema is not None:
            named = {"type": "json_schema", "name": "answer", "strict": True, "schema": schema}
            body["text"] = {"format": named}
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
    def from_options(cls, options: Options, *, name: str = "openai-responses") -> OpenAIResponses:
        """Options of `openai_settings.settings_from`; `name` may be a preset's."""
        return cls(settings_from(name, options), name=name)

    def _part(self, part: Part) -> dict[str, object]:
        if isinstance(part, str):
            return {"type": "input_text", "text": part}
        return {
            "type": "input_image",
            "image_url": data_url(part, image_px=self._settings.image_px),
            "detail": self._settings.detail,
        }

    def _reply(self, answer: Json) -> Reply:
        parts = [
            part
            for item in read.items(answer, "output")
            if read.text(item, "type") == "message"
            for part in read.items(item, "content")
        ]
        said = "".join(read.text(part, "text") for part in parts)
        refusal = "".join(read.text(part, "refusal") for part in parts)
        stopped_by = read.text(answer, "incomplete_details", "reason")
        tokens = (
            read.count(answer, "usage", "input_tokens"),
            read.count(answer, "usage", "output_tokens"),
        )
        outcome = None
        if read.text(answer, "status") == "failed":
            reason = read.text(answer, "error", "message") or "the response failed"
            outcome, said = TransportFailure(reason[:200]), ""
        elif refusal or stopped_by == "content_filter":
            outcome, said = Refused(), refusal or said
        elif read.text(answer, "status") == "incomplete":
            # Reasoning may have eaten the budget; half an answer is none.
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
