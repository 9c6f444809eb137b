"""One presentation of a question: the exact parts that go out, and how to read what comes back."""

from __future__ import annotations

from dataclasses import dataclass

from c2nav_engine.contract.outcome import Answered, Key
from c2nav_engine.contract.question import Form, Picture, Question

Part = str | Picture


@dataclass(frozen=True, slots=True)
class Prompt:
    """What one query sends.

    Attributes:
        question: What is being asked; adapters for models use `parts` and `labels` alone.
        parts: Text and pictures in order; text parts are joined verbatim.
        labels: Label → key, in presentation order ("A" first).
        form: The wanted answer form.
        repair: 0 for the first attempt, 1 when the format reminder was added.
        order: Index of this presentation among the question's (0 is the recorded one).
        template_sha256: Hash of the template file.
        request_sha256: Hash over parts, labels, form, order and repair: the replay and cache key.
    """

    question: Question
    parts: tuple[Part, ...]
    labels: tuple[tuple[str, Key], ...]
    form: Form
    repair: int
    order: int
    template_sha256: str
    request_sha256: str


@dataclass(frozen=True, slots=True)
class Reply:
    """What one query brought back, before or after parsing.

    Attributes:
        outcome: A finished outcome when the adapter knows it (a person's ranking, a refusal, a
            transport failure); None when `text` is to be parsed.
        text: The raw answer.
        latency_s: Wall time of the query.
        tokens_in: Prompt tokens where known.
        tokens_out: Completion tokens where known.
        cost_usd: Price where known.
        model: Model id as served, where known.
        cached: Whether the answer came from the answer cache.
        retry_after_s: For a transport failure: how long the other side asks to be left alone;
            None when asking again cannot help.
    """

    outcome: Answered | None = None
    text: str = ""
    latency_s: float = 0.0
    tokens_in: int | None = None
    tokens_out: int | None = None
    cost_usd: float | None = None
    model: str = ""
    cached: bool = False
    retry_after_s: float | None = 0.0


@dataclass(frozen=True, slots=True)
class Query:
    """One finished query: what was sent, what came, what it meant."""

    prompt: Prompt
    reply: Reply
    outcome: Answered


@dataclass(frozen=True, slots=True)
class Ranked:
    """A question's full record: the aggregated outcome over every query it took."""

    outcome: Answered
    queries: tuple[Query, ...]
    ranker: str
    privileged: bool = False
