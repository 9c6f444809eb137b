"""What a person is shown: the recorded prompt, byte for byte, or reshuffled when it comes again."""

from __future__ import annotations

import hashlib
import json

import numpy as np

from app.reviews.queues import Place
from app.reviews.study import Study
from c2nav_engine.contract.outcome import Key
from c2nav_engine.contract.presentation import labelled
from c2nav_engine.contract.prompt import Prompt
from c2nav_engine.contract.question import Question
from c2nav_engine.contract.render import render_as
from c2nav_engine.errors import TraceError, UsageError
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.recorded import open_trace


def prompt_at(study: Study, place: Place) -> Prompt:
    """The prompt of a place.

    The first time it is the recorded first query as it went out; the second time the same words
    and pictures with the alternatives in another order.

    Raises:
        UsageError: The trace is not the one that was frozen, or holds no pictures.
    """
    item = study.items[place.item]
    path = study.trace(place.item)
    with open_trace(path) as trace:
        if trace.sha256 != item.trace_sha256:
            message = (
                f"expected trace {item.trace_sha256[:12]} at {path}, came {trace.sha256[:12]}; "
                "put back the file that the study was made from"
            )
            raise UsageError(message)
        exchange = trace.decision(item.decision)
    if not isinstance(exchange.request, Ask) or not exchange.ranked:
        message = f"expected a question as decision {item.decision} of {path}"
        raise TraceError(message)
    prompt = exchange.ranked.queries[0].prompt
    if place.again:
        shown = tuple(key for _, key in prompt.labels)
        prompt = render_as(prompt.question, labelled(reshuffled(shown, seed=study.seed)))
    if any(not isinstance(part, str) and not part.jpeg for part in prompt.parts):
        message = f"expected the pictures of decision {item.decision} in {path}; it was redacted"
        raise UsageError(message)
    return prompt


def reshuffled(shown: tuple[Key, ...], *, seed: int) -> tuple[Key, ...]:
    """Another order in which every alternative stands elsewhere where that is possible."""
    generator = np.random.default_rng([seed, *"/".join(shown).encode()])
    turn = int(generator.integers(1, len(shown)))
    return shown[turn:] + shown[:turn]


def question_id(question: Question) -> str:
    """Names what is asked, whatever the order in which it is shown: equal over runs."""
    content = [
        question.slot.value,
        question.form.value,
        question.instruction,
        question.legs,
        question.leg,
        question.sketch,
        [[words, picture.sha256] for words, picture in question.context],
        sorted(
            [one.key, one.text, one.caption, one.picture.sha256 if one.picture else ""]
            for one in question.alternatives
        ),
    ]
    return hashlib.sha256(json.dumps(content, ensure_ascii=False).encode()).hexdigest()


def shown_sha256(prompt: Prompt) -> str:
    """Digest of exactly what a person sees: words, picture bytes and labels in their order."""
    seen = [part if isinstance(part, str) else {"jpeg": part.sha256} for part in prompt.parts]
    content = [seen, [label for label, _ in prompt.labels]]
    return hashlib.sha256(json.dumps(content, ensure_ascii=False).encode()).hexdigest()
