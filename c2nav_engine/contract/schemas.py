"""The JSON schema that a server may enforce on an answer; the parser checks it again regardless.

A schema alone can still answer ["A", "C", "A"], and strict modes reject `uniqueItems`: up to four
alternatives are therefore an enumeration of permutations, which cannot repeat a label.
"""

from __future__ import annotations

import itertools

from c2nav_engine.contract.prompt import Prompt
from c2nav_engine.contract.question import Form

ENUMERATED = 4
"""Most alternatives whose permutations are listed (24 strings)."""

Schema = dict[str, object]


def answer_schema(prompt: Prompt) -> Schema:
    """An object schema with the one field that the parser reads."""
    name, value = _field(prompt)
    return {
        "type": "object",
        "properties": {name: value},
        "required": [name],
        "additionalProperties": False,
    }


def choices(prompt: Prompt) -> tuple[str, ...]:
    """Every plain answer that the form allows, where they can be listed; () otherwise."""
    labels = [label for label, _ in prompt.labels]
    if prompt.form is Form.ACTION:
        return tuple(labels)
    if prompt.form is Form.YES_NO:
        return ("yes", "no")
    if prompt.form is Form.ORDINAL and len(labels) <= ENUMERATED:
        return tuple(" > ".join(order) for order in itertools.permutations(labels))
    return ()


def _field(prompt: Prompt) -> tuple[str, Schema]:
    listed = choices(prompt)
    if listed:
        name = "ranking" if prompt.form is Form.ORDINAL else "answer"
        return name, {"type": "string", "enum": list(listed)}
    if prompt.form is Form.ORDINAL:
        labels = [label for label, _ in prompt.labels]
        items: Schema = {"type": "string", "enum": labels}
        return "ranking", {
            "type": "array",
            "items": items,
            "minItems": len(labels),
            "maxItems": len(labels),
        }
    return ("degrees" if prompt.form is Form.DEGREES else "progress"), {"type": "number"}
