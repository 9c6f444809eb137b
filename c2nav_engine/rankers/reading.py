"""What a reply means: parsed when it is text, checked against the question when it is finished."""

from __future__ import annotations

from c2nav_engine.contract.answers import parse
from c2nav_engine.contract.answers_number import range_of
from c2nav_engine.contract.outcome import Answered, Cardinal, Invalid, Ordering, Tie
from c2nav_engine.contract.presentation import ORDINAL_FORMS
from c2nav_engine.contract.prompt import Prompt, Reply
from c2nav_engine.contract.question import Form


def read(prompt: Prompt, reply: Reply) -> Answered:
    """The outcome of one query; nothing an adapter claims selects an alternative unchecked."""
    if reply.outcome is None:
        return parse(reply.text, prompt)
    outcome = reply.outcome
    if isinstance(outcome, Cardinal):
        return outcome if _in_range(prompt, outcome.value) else Invalid("out of range")
    if isinstance(outcome, Ordering | Tie):
        return _over_offered(prompt, outcome)
    return outcome


def _over_offered(prompt: Prompt, outcome: Ordering | Tie) -> Answered:
    keys = [key for tier in outcome.tiers for key in tier]
    if prompt.form not in ORDINAL_FORMS:
        return Invalid("an ordering where none was asked for")
    if sorted(keys) != sorted(key for _, key in prompt.labels):
        return Invalid("other alternatives than offered")
    return outcome


def _in_range(prompt: Prompt, value: float) -> bool:
    if prompt.form in ORDINAL_FORMS:
        return False
    if prompt.form is Form.YES_NO:
        return value in {0.0, 1.0}
    low, high = range_of(prompt)
    return low <= value <= high
