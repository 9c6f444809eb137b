"""A seeded uniform answer to every query: the baseline that looks at nothing."""

from __future__ import annotations

import hashlib

import numpy as np

from c2nav_engine.contract.answers_number import range_of
from c2nav_engine.contract.outcome import Answered, Cardinal, Ordering
from c2nav_engine.contract.presentation import ORDINAL_FORMS
from c2nav_engine.contract.prompt import Prompt, Reply
from c2nav_engine.contract.question import Form
from c2nav_engine.rankers.options import OptionReader, Options


class RandomOrder:
    """Uniform over all orders, keyed by (seed, question, presentation).

    Each presentation is drawn apart, as a model that guesses would answer it: the two orders of a
    pair agree half the time. Pictures do not enter the key, so renderers do not change it.

    Args:
        seed: Seed of the run.
    """

    def __init__(self, seed: int = 0) -> None:
        self._seed = seed

    @property
    def name(self) -> str:
        """What records call it."""
        return "random"

    @property
    def asks_once(self) -> bool:
        """It is asked like a model."""
        return False

    def answer(self, prompt: Prompt) -> Reply:
        """A uniform draw in the wanted form."""
        return Reply(outcome=_draw(prompt, np.random.default_rng(self._key(prompt))))

    def _key(self, prompt: Prompt) -> int:
        question = prompt.question
        facts = (
            self._seed,
            question.slot.value,
            question.form.value,
            question.shuffle_seed,
            question.instruction,
            question.leg,
            prompt.order,
            prompt.repair,
        )
        return int.from_bytes(hashlib.sha256(repr(facts).encode()).digest()[:8], "big")

    @classmethod
    def from_options(cls, options: Options) -> RandomOrder:
        """`seed=N`."""
        reader = OptionReader("random", options)
        ranker = cls(reader.integer("seed", 0))
        reader.done()
        return ranker


def _draw(prompt: Prompt, generator: np.random.Generator) -> Answered:
    if prompt.form in ORDINAL_FORMS:
        # Canonical order, not the shown one: the draw does not depend on the presentation's own.
        keys = prompt.question.keys
        order: list[int] = generator.permutation(len(keys)).tolist()
        return Ordering.of(*(keys[index] for index in order))
    if prompt.form is Form.YES_NO:
        return Cardinal(float(generator.integers(2)))
    return Cardinal(float(generator.uniform(*range_of(prompt))))
