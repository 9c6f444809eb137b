"""What each known model takes and enforces: one table, which the start-up probe checks.

Sources: vendors' documentation as of November 2026. An unlisted model is `generic`: it is sent
only what every OpenAI-style server understands.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Capabilities:
    """One row of the table.

    Attributes:
        name: Row name for records.
        temperature: Whether sampling parameters may be sent.
        schema: Whether a JSON schema as `response_format` (or `text.format`) is enforced.
        effort: Whether a reasoning effort may be sent.
        detail: Whether an image detail may be sent.
        limit_field: Chat field that bounds the answer's length.
        answer_tokens: Default bound; reasoning counts into it where there is any.
        usd_per_million_in: List price of prompt tokens; None where it has none.
        usd_per_million_out: List price of completion tokens.
    """

    name: str
    temperature: bool = True
    schema: bool = True
    effort: bool = False
    detail: bool = False
    limit_field: str = "max_tokens"
    answer_tokens: int = 200
    usd_per_million_in: float | None = None
    usd_per_million_out: float | None = None

    def cost_usd(self, tokens_in: int | None, tokens_out: int | None) -> float | None:
        """List price of one query, where price and tokens are known."""
        prices = (self.usd_per_million_in, self.usd_per_million_out)
        if None in {*prices, tokens_in, tokens_out}:
            return None
        per_in, per_out = (price or 0.0 for price in prices)
        return ((tokens_in or 0) * per_in + (tokens_out or 0) * per_out) / 1e6


@dataclass(frozen=True, slots=True)
class Preset:
    """A model by a short name.

    Attributes:
        ranker: The adapter that reaches it: "openai-chat" or "openai-responses".
        model: Model id as served; dated where the vendor dates it.
        base_url: Where its server usually listens.
        key_env: Variable that usually holds the key; "" where none is needed.
        effort: Reasoning effort; "" to send none.
    """

    ranker: str
    model: str
    base_url: str
    key_env: str = ""
    effort: str = ""


GENERIC = Capabilities("generic")
QWEN3_VL = Capabilities("qwen3-vl")
"""vLLM and SGLang enforce `response_format` with a JSON schema."""
GPT_5_5 = Capabilities(
    "gpt-5.5",
    temperature=False,
    effort=True,
    detail=True,
    limit_field="max_completion_tokens",
    answer_tokens=2000,
    usd_per_million_in=5.0,
    usd_per_million_out=30.0,
)

_LOCAL_VLLM = "http://127.0.0.1:8000/v1"

PRESETS: dict[str, Preset] = {
    "qwen3-vl-4b": Preset("openai-chat", "Qwen/Qwen3-VL-4B-Instruct", _LOCAL_VLLM),
    "qwen3-vl-8b": Preset("openai-chat", "Qwen/Qwen3-VL-8B-Instruct", _LOCAL_VLLM),
    "qwen3-vl-32b": Preset("openai-chat", "Qwen/Qwen3-VL-32B-Instruct", _LOCAL_VLLM),
    "gpt-5.5": Preset(
        "openai-responses",
        "gpt-5.5-2026-04-23",
        "https://api.openai.com/v1",
        key_env="OPENAI_API_KEY",
        effort="low",
    ),
}
"""Presets by name; each takes the options of its adapter on top."""


def capabilities_of(model: str) -> Capabilities:
    """The row of a model id; `generic` when it is not listed."""
    folded = model.casefold()
    if folded.startswith("gpt-5"):
        return GPT_5_5
    return QWEN3_VL if "qwen3-vl" in folded else GENERIC
