"""`openai-chat`: any server that speaks the chat completions interface (vLLM, SGLang, hosted)."""

from __future__ import annotations

from typing import final

from c2nav_engine.contract.outcome import Answered, Empty, Refused, Truncated
from c2nav_engine.contract.prompt import Part
from c2nav_engine.contract.schemas import Schema
from c2nav_engine.rankers import json_reading as read
from c2nav_engine.rankers.images import data_url
from c2nav_engine.rankers.openai_served import ServedModel
from c2nav_engine.rankers.openai_settings import SAMPLING
from c2nav_engine.rankers.openai_transport import Json


@final
class OpenAIChat(ServedModel):
    """One completion per query: words and pictures in the prompt's order."""

    INTERFACE = "openai-chat"
    PATH = "/chat/completions"
    USAGE = ("prompt_tokens", "completion_tokens")

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

    def meaning(self, answer: Json) -> tuple[Answered | None, str]:
        """Refused, cut off or empty by the finish reason; else the message's text."""
        choice = ("choices", 0)
        finish = read.text(answer, *choice, "finish_reason")
        said = read.text(answer, *choice, "message", "content")
        refusal = read.text(answer, *choice, "message", "refusal")
        if refusal or finish == "content_filter":
            return Refused(), refusal or said
        if finish == "length":
            # Cut short, "A > B" may have been on its way to anything: nothing of it is used.
            return Truncated(), said
        return (None if said.strip() else Empty()), said

    def _part(self, part: Part) -> dict[str, object]:
        if isinstance(part, str):
            return {"type": "text", "text": part}
        image: dict[str, object] = {"url": data_url(part, image_px=self._settings.image_px)}
        if self._settings.capabilities.detail or self._settings.detail != "auto":
            image["detail"] = self._settings.detail
        return {"type": "image_url", "image_url": image}
