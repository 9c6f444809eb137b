"""In which orders a question's alternatives are shown, and under which labels.

The seeded shuffle is the recorded order (index 0). `Orders.BOTH` adds its reverse, and
`Orders.CYCLIC` all its rotations, so that every alternative stands once in every position.
"""

from __future__ import annotations

import functools
import string

import numpy as np

from c2nav_engine.contract.outcome import Key
from c2nav_engine.contract.question import Form, Orders, Question
from c2nav_engine.errors import InternalError

ORDINAL_FORMS = frozenset({Form.ORDINAL, Form.ACTION})
"""Forms whose answer is an order; every other form is a role inversion and is asked once."""


def seeded_order(question: Question) -> tuple[Key, ...]:
    """The question's keys, shuffled by its own seed."""
    keys = question.keys
    if not 2 <= len(keys) <= len(string.ascii_uppercase) or len(set(keys)) != len(keys):
        message = f"expected 2 to 26 distinct alternatives to compare, came {keys}"
        raise InternalError(message)
    return _shuffled(keys, question.shuffle_seed)


@functools.lru_cache(maxsize=4096)
def _shuffled(keys: tuple[Key, ...], seed: int) -> tuple[Key, ...]:
    """Kept, because every view of a recording asks for the letters of all its questions."""
    shuffled: list[int] = np.random.default_rng(seed).permutation(len(keys)).tolist()
    return tuple(keys[index] for index in shuffled)


def presentations(question: Question, *, once: bool = False) -> tuple[tuple[Key, ...], ...]:
    """Every order in which the question is put, the recorded one first.

    Args:
        question: What is asked.
        once: Present it once whatever it wants (a person).
    """
    first = seeded_order(question)
    if once or question.form not in ORDINAL_FORMS or question.orders is Orders.ONCE:
        return (first,)
    if question.orders is Orders.BOTH:
        return (first, first[::-1])
    return tuple(first[turn:] + first[:turn] for turn in range(len(first)))


def labelled(shown: tuple[Key, ...]) -> tuple[tuple[str, Key], ...]:
    """Label → key in presentation order: A stands first."""
    return tuple(zip(string.ascii_uppercase, shown, strict=False))
