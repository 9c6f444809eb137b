"""Measured means of an episode by variant: what a dry run reckons with.

`expected.json` is data: `python -m benchmarks.expected RUN` measures it from a finished run and
says in it how. Nothing in it comes from the paper.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from pydantic import TypeAdapter

EXPECTED_FILE = Path(__file__).with_name("expected.json")

CHARS_PER_TOKEN = 4.0
"""English words in today's tokenizers [C]."""


@dataclass(frozen=True, slots=True)
class Shown:
    """Pictures of one size in a query.

    Attributes:
        width_px: Columns as sent.
        height_px: Rows.
        count: Mean number in a query.
    """

    width_px: int
    height_px: int
    count: float


@dataclass(frozen=True, slots=True)
class SlotMeans:
    """A mean query of one decision slot.

    Attributes:
        text_chars: Characters of its words.
        answer_chars: Characters of a valid answer.
        pictures: By size.
    """

    text_chars: float
    answer_chars: float
    pictures: Sequence[Shown]


@dataclass(frozen=True, slots=True)
class VariantMeans:
    """A mean episode of one variant.

    Attributes:
        episodes: Episodes behind it.
        steps: Low-level actions.
        decisions: Decisions, asked or not.
        queries: Queries by slot.
        core_s: Seconds of one core for simulation, rendering and recording.
        trace_mb: Size of its trace.
    """

    episodes: int
    steps: float
    decisions: float
    queries: Mapping[str, float]
    core_s: float
    trace_mb: float


@dataclass(frozen=True, slots=True)
class ModelMeans:
    """What a query costs at a kind of ranker.

    Attributes:
        latency_s: Wait for one answer.
        core_s: Seconds of one core in this process for one query.
        tokens_out: Tokens of an answer, reasoning included; None to reckon from its characters.
        how: Where these figures come from.
    """

    latency_s: float
    core_s: float
    tokens_out: float | None
    how: str


@dataclass(frozen=True, slots=True)
class Expected:
    """The whole table.

    Attributes:
        how: How it was measured.
        variants: By preset.
        slots: By decision slot.
        models: By capability name of the model, or by ranker.
    """

    how: str
    variants: Mapping[str, VariantMeans]
    slots: Mapping[str, SlotMeans]
    models: Mapping[str, ModelMeans]


@lru_cache(maxsize=1)
def expected() -> Expected:
    """The table that ships with the package."""
    facts = json.loads(EXPECTED_FILE.read_text(encoding="utf-8"))
    return TypeAdapter(Expected).validate_python(facts)


def picture_tokens(width_px: int, height_px: int, *, least: int) -> int:
    """Tokens of a picture in patches of 32 pixels after rounding, as Qwen3-VL counts them."""
    patches = max(1, round(width_px / 32)) * max(1, round(height_px / 32))
    return max(least, patches)
