"""Reading the answers of the three role inversions: degrees, progress, yes or no."""

from __future__ import annotations

import math
import re

from c2nav_engine.contract.outcome import Cardinal, Invalid
from c2nav_engine.contract.prompt import Prompt
from c2nav_engine.contract.question import Form, Slot

_NUMBER = re.compile(
    r"(?<![\w.])([+-]?\d+(?:\.\d+)?)(?:(?: ?(?:°|%|deg(?:rees?)?\b|per ?cent\b))|(?!\w))"
    r"(?: (?:to the )?(left|right)\b)?"
)


def read_number(folded: str, prompt: Prompt) -> Cardinal | Invalid:
    """The one number of an answer in degrees or progress, if it lies in the form's range.

    "30 degrees right" is −30; a sign and a side together are `Invalid`.
    """
    found = _NUMBER.findall(folded)
    if len(found) != 1:
        return Invalid("two answers" if found else "no number")
    digits, side = found[0]
    if side and (digits[0] in "+-" or prompt.form is not Form.DEGREES):
        return Invalid("a sign and a side")
    value = -float(digits) if side == "right" else float(digits)
    low, high = range_of(prompt)
    if not (math.isfinite(value) and low <= value <= high):
        return Invalid("out of range")
    return Cardinal(value + 0.0)


def read_verdict(folded: str) -> Cardinal | Invalid:
    """1.0 for yes and 0.0 for no, if the answer begins with one of them and holds not the other."""
    first = re.match(r"\W*(?:answer\W+)?(yes|no)\b", folded)
    words = set(re.findall(r"\b(?:yes|no)\b", folded))
    if first is None:
        return Invalid("neither yes nor no")
    if len(words) > 1:
        return Invalid("two answers")
    return Cardinal(1.0 if first.group(1) == "yes" else 0.0)


def range_of(prompt: Prompt) -> tuple[float, float]:
    """Bounds of a cardinal answer, both included."""
    if prompt.form is Form.PROGRESS:
        return (0.0, 100.0)
    return (-180.0, 180.0) if prompt.question.slot is Slot.GLANCE else (-90.0, 90.0)
