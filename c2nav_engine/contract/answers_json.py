"""The JSON half of reading answers: one object, alone or in a fence, with one answer field."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from typing import cast

ANSWER_FIELDS = ("ranking", "answer", "order", "winner", "degrees", "progress")
"""Fields that may hold the answer; exactly one must be there."""

_IGNORED = frozenset({"reason", "reasoning", "explanation"})
_FENCE = re.compile(r"```(?:json|text)?\s*(.*?)\s*```", re.DOTALL)


class Unusable(ValueError):
    """A structured answer that names no single answer; the message says why."""


@dataclass(frozen=True, slots=True)
class Field:
    """The text to read on.

    Attributes:
        text: The answer field's value as text, or the whole answer when it is no object.
        structured: Whether it came out of an object, so that no prose is expected around it.
    """

    text: str
    structured: bool


def field_of(text: str) -> Field:
    """The answer field of the one JSON object in the text, or the text itself.

    Raises:
        Unusable: For an object without a usable answer field, or more than one fence.
    """
    fences = _FENCE.findall(text)
    if len(fences) > 1:
        raise Unusable("two answers")
    body = fences[0] if fences else text
    if not body.startswith("{"):
        # A fence without an object may still hold a plain chain; the prose rules decide.
        return Field(_FENCE.sub(r" \1 ", text).strip(), structured=False)
    if fences and re.search(r"[>{}]|\b[A-Z]\b(?! [a-z])", _FENCE.sub("", text)):
        raise Unusable("two answers")
    return Field(_value(_object(body)), structured=True)


def _object(body: str) -> list[tuple[str, object]]:
    try:
        # Pairs, not a dict: of two equal fields neither may win silently.
        pairs = json.loads(body, object_pairs_hook=list)
    except (ValueError, RecursionError):
        raise Unusable("broken JSON") from None
    return cast("list[tuple[str, object]]", pairs)


def _value(pairs: list[tuple[str, object]]) -> str:
    answers = [(name, value) for name, value in pairs if name.casefold() not in _IGNORED]
    if len(answers) > 1:
        raise Unusable("two answers")
    if not answers or answers[0][0].casefold() not in ANSWER_FIELDS:
        raise Unusable("no answer field")
    value = answers[0][1]
    if isinstance(value, list):
        return ", ".join(map(_scalar, cast("list[object]", value)))
    return _scalar(value)


def _scalar(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, str | int | float):
        return str(value)
    raise Unusable("no answer field")
