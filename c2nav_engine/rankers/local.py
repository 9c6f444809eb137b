"""`local`: a Qwen3-VL in this process, without a server.

It ranks by scoring the labels: one forward pass, the log-probabilities of the label tokens as the
first token of the answer, sorted. Every model gives a valid order this way, and the same bytes
give the same order. The scores stay here; only the order leaves. Inversions, and `mode=generate`,
decode greedily among the listed answers instead.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from threading import Lock
from typing import Any

from c2nav_engine.contract.answers_number import range_of
from c2nav_engine.contract.prompt import Prompt, Reply
from c2nav_engine.contract.question import Form
from c2nav_engine.contract.schemas import choices
from c2nav_engine.errors import UsageError
from c2nav_engine.rankers.local_model import LocalModel, LocalSettings
from c2nav_engine.rankers.options import OptionReader, Options

SCORE, GENERATE = "score", "generate"


class Local:
    """An adapter around one loaded model; prompts of equal length go through it together.

    Args:
        model: The loaded model.
        name: What records call it.
        mode: "score" or "generate".
    """

    def __init__(self, model: LocalModel, *, name: str = "local", mode: str = SCORE) -> None:
        self._model = model
        self._name = name
        self._mode = mode
        self._lock = Lock()

    @property
    def name(self) -> str:
        """Adapter, model, and how it answers."""
        return f"{self._name}:{self._mode}"

    @property
    def asks_once(self) -> bool:
        """A model is asked in every order the question wants."""
        return False

    @property
    def fingerprint(self) -> str:
        """Model, device and picture size."""
        return repr(self._model.settings)

    @property
    def options(self) -> dict[str, str]:
        """The settings as options; `device` is the one that was chosen."""
        settings = self._model.settings
        return {
            "model": settings.model,
            "device": self._model.device,
            "mode": self._mode,
            "image_px": str(settings.image_px),
        }

    def answer(self, prompt: Prompt) -> Reply:
        """One query."""
        return self.answer_all([prompt])[0]

    def answer_all(self, prompts: Sequence[Prompt]) -> list[Reply]:
        """All presentations of a question in as few passes as their lengths allow."""
        with self._lock:
            prepared = [self._model.prepare(prompt.parts) for prompt in prompts]
            texts = self._texts(prompts, prepared)
        return [
            Reply(text=text, tokens_in=self._model.length(inputs), model=self._name)
            for text, inputs in zip(texts, prepared, strict=True)
        ]

    @classmethod
    def from_options(cls, options: Options) -> Local:
        """`model=FOLDER_OR_ID`, `device=auto|cpu|cuda`, `mode=score|generate`, `image_px=N`."""
        reader = OptionReader("local", options)
        settings = LocalSettings(
            model=reader.text("model"),
            device=reader.text("device", "auto"),
            image_px=reader.integer("image_px", 0),
        )
        mode = reader.choice("mode", SCORE, among=(SCORE, GENERATE))
        reader.done()
        if not settings.model:
            message = "expected the option model for local (a folder or a hub id), came none"
            raise UsageError(f"{message}. Example: model=Qwen/Qwen3-VL-4B-Instruct")
        return cls(LocalModel(settings), name=f"local:{settings.model}", mode=mode)

    def _texts(self, prompts: Sequence[Prompt], prepared: Sequence[Any]) -> list[str]:
        scored = [index for index, prompt in enumerate(prompts) if self._scores(prompt)]
        texts = [""] * len(prompts)
        length = [self._model.length(inputs) for inputs in prepared]
        by_length = itertools.groupby(sorted(scored, key=length.__getitem__), length.__getitem__)
        for _, group in by_length:
            batch = list(group)
            ranked = self._by_score([prompts[i] for i in batch], [prepared[i] for i in batch])
            for index, text in zip(batch, ranked, strict=True):
                texts[index] = text
        for index, prompt in enumerate(prompts):
            if not self._scores(prompt):
                listed = choices(prompt) or _numbers(prompt)
                texts[index] = self._model.constrained(prepared[index], listed)
        return texts

    def _scores(self, prompt: Prompt) -> bool:
        return prompt.form is Form.ORDINAL and (self._mode == SCORE or not choices(prompt))

    def _by_score(self, prompts: Sequence[Prompt], prepared: Sequence[Any]) -> list[str]:
        tokens = [[self._model.first_token(label) for label, _ in one.labels] for one in prompts]
        texts: list[str] = []
        for prompt, scores in zip(prompts, self._model.label_scores(prepared, tokens), strict=True):
            order = sorted(zip(scores, prompt.labels, strict=True), key=lambda pair: -pair[0])
            texts.append(" > ".join(label for _, (label, _) in order))
        return texts


def _numbers(prompt: Prompt) -> list[str]:
    low, high = range_of(prompt)
    return [str(value) for value in range(int(low), int(high) + 1)]
