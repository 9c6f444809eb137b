"""Options of the two OpenAI-style adapters; the key itself is never one of them."""

from __future__ import annotations

import os
from dataclasses import dataclass

from c2nav_engine.errors import UsageError
from c2nav_engine.rankers.capabilities import PRESETS, Capabilities, capabilities_of
from c2nav_engine.rankers.options import OptionReader, Options

SAMPLING: dict[str, dict[str, float | int]] = {
    "greedy": {"temperature": 0.0},
    "qwen": {"temperature": 0.7, "top_p": 0.8, "top_k": 20},
}
"""Named sampling profiles; "qwen" is the vendor's evaluation setting."""

EFFORTS = ("", "none", "minimal", "low", "medium", "high", "xhigh")
DETAILS = ("auto", "low", "high")


@dataclass(frozen=True, slots=True)
class ServerSettings:
    """How to reach and ask one model.

    Attributes:
        base_url: Root of the API, "/v1" included.
        model: Model id.
        key_env: Name of the environment variable with the key; "" to send a placeholder.
        capabilities: What the model takes.
        sampling: Name of a profile in `SAMPLING`.
        effort: Reasoning effort, "" for none.
        detail: Image detail.
        image_px: Longest side after scaling down, a multiple of 32; 0 sends the recorded bytes.
        schema: Whether to ask the server to enforce the answer's JSON schema.
        answer_tokens: Bound on the answer's length.
        timeout_s: Longest wait for one answer.
        probe: Whether to try the server out before the first question.
    """

    base_url: str
    model: str
    key_env: str
    capabilities: Capabilities
    sampling: str = "greedy"
    effort: str = ""
    detail: str = "auto"
    image_px: int = 0
    schema: bool = True
    answer_tokens: int = 200
    timeout_s: float = 120.0
    probe: bool = True

    def key(self) -> str:
        """The key from the environment; raises `UsageError` naming an unset variable."""
        if not self.key_env:
            return "none"
        key = os.environ.get(self.key_env, "")
        if not key:
            message = f"expected a key in the environment variable {self.key_env}, which is not set"
            raise UsageError(f"{message}. Export it, or give another name as key_env")
        return key

    def as_options(self) -> dict[str, str]:
        """Every setting as the option that gives it, for the record."""
        kept = {name: str(getattr(self, name)) for name in _OPTIONS}
        return {name: text for name, text in kept.items() if text}


_OPTIONS = (
    "base_url",
    "model",
    "key_env",
    "sampling",
    "effort",
    "detail",
    "image_px",
    "schema",
    "answer_tokens",
    "timeout_s",
)


def settings_from(ranker: str, options: Options) -> ServerSettings:
    """Settings out of `KEY=VALUE` options; a preset's name as `ranker` fills in the rest."""
    preset = PRESETS.get(ranker)
    reader = OptionReader(ranker, options)
    model = reader.text("model", preset.model if preset else "")
    base_url = reader.text("base_url", preset.base_url if preset else "")
    if not (model and base_url):
        message = f"expected the options base_url and model for {ranker}, came {dict(options)}"
        raise UsageError(f"{message}. Example: base_url=http://127.0.0.1:8000/v1 model=NAME")
    known = capabilities_of(model)
    settings = ServerSettings(
        base_url=base_url,
        model=model,
        key_env=reader.text("key_env", preset.key_env if preset else ""),
        capabilities=known,
        sampling=reader.choice("sampling", "greedy", among=tuple(SAMPLING)),
        effort=reader.choice("effort", preset.effort if preset else "", among=EFFORTS),
        detail=reader.choice("detail", "auto", among=DETAILS),
        image_px=_multiple_of_32(reader.integer("image_px", 0)),
        schema=reader.flag("schema", default=known.schema),
        answer_tokens=reader.integer("answer_tokens", known.answer_tokens),
        timeout_s=reader.number("timeout_s", 120.0),
        probe=reader.flag("probe", default=True),
    )
    reader.done()
    return settings


def _multiple_of_32(image_px: int) -> int:
    if image_px < 0 or image_px % 32:
        message = f"expected image_px to be 0 or a multiple of 32 (model patches), came {image_px}"
        raise UsageError(message)
    return image_px
