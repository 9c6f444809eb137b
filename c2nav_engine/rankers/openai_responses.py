"""`openai-responses`: the responses interface, preferred for hosted reasoning models."""

from __future__ import annotations

from typing import final

from c2nav_engine.contract.outcome import Answered, Empty, Refused, TransportFailure, Truncated
from c2nav_engine.contract.prompt import Part
from c2nav_engine.contract.schemas import Schema
from c2nav_engine.rankers import json_reading as read
from c2nav_engine.rankers.images import data_url
from c2nav_engine.rankers.openai_served import ServedModel
from c2nav_engine.rankers.openai_settings import SAMPLING
from c2nav_engine.rankers.openai_transport import Json

_SAMPLING_FIELDS = ("temperature", "top_p")
"""What of a sampling profile this interface knows: it has no `top_k`."""


@final
class OpenAIResponses(ServedModel):
    """One stateless response per query; nothing is stored at the vendor."""

    INTERFACE = "openai-responses"
    PATH = "/responses"
    USAGE = ("input_tokens", "output_tokens")

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
            profile = SAMPLING[settings.sampling]
            body |= {name: profile[name] for name in _SAMPLING_FIELDS if name in profile}
        if settings.capabilities.effort and settings.effort:
            body["reasoning"] = {"effort": settings.effort}
        if settings.schema and schema is not None:
            named = {"type": "json_schema", "name": "answer", "strict": True, "schema": schema}
            body["text"] = {"format": named}
        return body

    def meaning(self, answer: Json) -> tuple[Answered | None, str]:
        """Failed, refused, cut off or empty by the status; else the text of its messages."""
        parts = [
            part
            for item in read.items(answer, "output")
            if read.text(item, "type") == "message"
            for part in read.items(item, "content")
        ]
        said = "".join(read.text(part, "text") for part in parts)
        refusal = "".join(read.text(part, "refusal") for part in parts)
        stopped_by = read.text(answer, "incomplete_details", "reason")
        if read.text(answer, "status") == "failed":
            reason = read.text(answer, "error", "message") or "the response failed"
            return TransportFailure(reason[:200]), ""
        if refusal or stopped_by == "content_filter":
            return Refused(), refusal or said
        if read.text(answer, "status") == "incomplete":
            # Reasoning may have eaten the budget; half an answer is none.
            return Truncated(), said
        return (None if said.strip() else Empty()), said

    def _part(self, part: Part) -> dict[str, object]:
        if isinstance(part, str):
            return {"type": "input_text", "text": part}
        return {
            "type": "input_image",
            "image_url": data_url(part, image_px=self._settings.image_px),
            "detail": self._settings.detail,
        }
