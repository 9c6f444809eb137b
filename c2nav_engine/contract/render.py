"""A question and an order become the exact parts of one query.

Words and pictures alternate; a picture follows its label directly ("View A (ahead):"), because
models bind a picture to the words right before it. Text parts carry their own newlines.
"""

from __future__ import annotations

import hashlib
import json
import re

from c2nav_engine.contract import template as templates
from c2nav_engine.contract import wording
from c2nav_engine.contract.outcome import Key
from c2nav_engine.contract.presentation import labelled, presentations
from c2nav_engine.contract.prompt import Part, Prompt
from c2nav_engine.contract.question import Alternative, Question

_PLACEHOLDER = re.compile(r"\{(\w+)\}")


def render(question: Question, order: int = 0, *, repair: int = 0) -> Prompt:
    """One presentation of the question.

    Args:
        question: What is asked.
        order: Index among `presentations(question)`.
        repair: 1 adds the template's one-line format reminder.
    """
    labels = labelled(presentations(question)[order])
    return render_as(question, labels, order=order, repair=repair)


def render_as(
    question: Question, labels: tuple[tuple[str, Key], ...], *, order: int = 0, repair: int = 0
) -> Prompt:
    """As `render`, under any labels in any order (audits vary label and position apart)."""
    template = templates.load(question.template)
    text = f"{template.body}\n\n{{reminder}}" if repair else template.body
    fillings = _fillings(question, labels)
    fillings["reminder"] = [_put_labels(template.reminder, labels)]
    parts = _joined(_filled(text, fillings))
    return Prompt(
        question=question,
        parts=parts,
        labels=labels,
        form=question.form,
        repair=repair,
        order=order,
        template_sha256=template.sha256,
        request_sha256=_digest(parts, labels, facts=(question.form.value, order, repair)),
    )


def text_of(prompt: Prompt) -> str:
    """All the words that go out, with each picture named by the start of its hash."""
    return "".join(
        part if isinstance(part, str) else f"[picture {part.sha256[:12]}]" for part in prompt.parts
    )


def _fillings(question: Question, labels: tuple[tuple[str, Key], ...]) -> dict[str, list[Part]]:
    by_key = {alternative.key: alternative for alternative in question.alternatives}
    context: list[Part] = []
    for words, picture in question.context:
        context += ["\n" if context else "", f"{wording.context_words(words)}\n", picture]
    alternatives: list[Part] = []
    for label, key in labels:
        alternatives += ["\n" if alternatives else "", *_alternative(label, by_key[key])]
    return {
        "instruction": [wording.instruction_span(question.instruction)],
        "leg": [wording.leg_span(question.legs[question.leg])],
        "sketch": [wording.sketch_block(question.sketch)],
        "context": context,
        "alternatives": alternatives,
        "labels": [_labels(labels)],
    }


def _alternative(label: str, alternative: Alternative) -> list[Part]:
    if alternative.picture is None:
        return [f"{label}. {alternative.text}"]
    words = ", ".join(word for word in (alternative.text, alternative.caption) if word)
    heading = f"View {label} ({words}):\n" if words else f"View {label}:\n"
    return [heading, alternative.picture]


def _labels(labels: tuple[tuple[str, Key], ...]) -> str:
    return ", ".join(label for label, _ in labels)


def _put_labels(reminder: str, labels: tuple[tuple[str, Key], ...]) -> str:
    return reminder.replace("{labels}", _labels(labels))


def _filled(text: str, fillings: dict[str, list[Part]]) -> list[Part]:
    """The template's pieces with the placeholders' parts, in one pass.

    Braces in an instruction are never placeholders, and an empty one leaves no hole.
    """
    for name, filling in fillings.items():
        if not any(filling):
            text = text.replace(f"{{{name}}}\n\n", "")
    parts: list[Part] = []
    for index, piece in enumerate(_PLACEHOLDER.split(text)):
        parts += fillings[piece] if index % 2 else [piece]
    return parts


def _joined(parts: list[Part]) -> tuple[Part, ...]:
    """Neighbouring texts as one."""
    joined: list[Part] = []
    for part in filter(None, parts):
        if joined and isinstance(part, str) and isinstance(joined[-1], str):
            joined[-1] += part
        else:
            joined.append(part)
    return tuple(joined)


def _digest(
    parts: tuple[Part, ...],
    labels: tuple[tuple[str, Key], ...],
    *,
    facts: tuple[str, int, int],
) -> str:
    content = [part if isinstance(part, str) else {"jpeg": part.sha256} for part in parts]
    payload = json.dumps([content, labels, facts], ensure_ascii=False, separators=(",", ":"))
    return hashlib.sha256(payload.encode("utf-8")).hexdigest()
