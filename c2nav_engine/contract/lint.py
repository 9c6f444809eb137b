"""The paper's claim as a check: the words that we write are nonmetric.

Templates, labels, texts of alternatives and the sketch hold no digit, unit, degree, percentage
or coordinate. What people wrote (the instruction and its legs) is quoted verbatim in marked spans
and skipped: 47 of 1,839 validation-unseen instructions contain such numbers themselves.
"""

from __future__ import annotations

import re

from c2nav_engine.contract import wording
from c2nav_engine.contract.prompt import Prompt
from c2nav_engine.contract.question import Form

EXEMPT = frozenset({Form.DEGREES, Form.PROGRESS})
"""Inversions that ask for a number by name; `YES_NO` asks for none and is held to the rule."""

_METRIC = {
    "digit": re.compile(r"\d+(?:[.,]\d+)?"),
    "unit": re.compile(
        r"\b(?:centi|milli|kilo)?met(?:er|re)s?\b|\b(?:cm|mm|km|feet|foot|ft|inch(?:es)?|yards?)\b",
        re.IGNORECASE,
    ),
    "angle": re.compile(r"\b(?:degrees?|deg|radians?)\b|°", re.IGNORECASE),
    "percentage": re.compile(r"\bper ?cent(?:ages?)?\b|%", re.IGNORECASE),
    "coordinate": re.compile(r"\b(?:coordinates?|pixels?|distances?|confidence)\b", re.IGNORECASE),
}


def lint(prompt: Prompt) -> list[str]:
    """What is metric in our words of this prompt; empty when the contract holds."""
    if prompt.form in EXEMPT:
        return []
    return metric_words(our_words(prompt))


def our_words(prompt: Prompt) -> str:
    """The prompt's text without the verbatim spans of the instruction and its legs."""
    question = prompt.question
    text = "".join(part for part in prompt.parts if isinstance(part, str))
    spans = [wording.instruction_span(question.instruction), *map(wording.leg_span, question.legs)]
    for span in spans:
        text = text.replace(span, "…")
    return text


def metric_words(text: str) -> list[str]:
    """One sentence per metric expression found in the text."""
    return [
        f"{kind} {found.group()!r} in our words"
        for kind, pattern in _METRIC.items()
        for found in pattern.finditer(text)
    ]
