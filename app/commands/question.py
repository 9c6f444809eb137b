"""`c2nav question`: a recorded question, exactly as it was sent."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import tyro

from app.commands.options import JsonOpt
from app.commands.output import check_folder, print_json
from c2nav_engine.contract.outcome import Answered
from c2nav_engine.contract.prompt import Prompt, Query
from c2nav_engine.contract.render import render, text_of
from c2nav_engine.errors import UsageError
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.recorded import open_trace
from c2nav_engine.traces.words import outcome_words


def question(
    trace: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="TRACE")],
    at: Annotated[int, tyro.conf.arg(metavar="K", help="Decision number, from 0.")],
    pictures: Annotated[
        Path | None, tyro.conf.arg(metavar="DIR", help="Write the pictures there, as sent.")
    ] = None,
    json: JsonOpt = False,
) -> int:
    """Print every query of a decision: text, pictures by hash, labels, raw answer."""
    if pictures is not None:
        check_folder(pictures)
    with open_trace(trace) as opened:
        decision = opened.decision(at)
    if not isinstance(decision.request, Ask):
        message = f"decision {at} of {trace.name} was settled without a question"
        raise UsageError(message)
    shown = _shown(decision.request, decision)
    if pictures is not None:
        _write_pictures([prompt for prompt, _ in shown], pictures)
    if json:
        committed = _committed(decision)
        print_json({"decision": at, "queries": [_facts(*each) for each in shown], **committed})
        return 0
    for prompt, query in shown:
        sys.stdout.write(f"--- order {prompt.order}, attempt {prompt.repair}\n{text_of(prompt)}\n")
        if query is not None:
            said = f"{query.reply.text}\n" if query.reply.text else ""
            sys.stdout.write(f"--- answer\n{said}read as: {outcome_words(query.outcome)}\n\n")
    for name, words in _committed(decision).items():
        sys.stdout.write(f"--- {name}: {words}\n")
    return 0


def _shown(ask: Ask, decision: Exchange) -> list[tuple[Prompt, Query | None]]:
    """Each prompt with its query; to a person alone the question was put in its first order."""
    if decision.ranked is None:
        return [(render(ask.question), None)]
    return [(query.prompt, query) for query in decision.ranked.queries]


def _committed(decision: Exchange) -> dict[str, str]:
    """What the loop was sent, and who said so."""
    outcome = decision.response
    words = outcome_words(outcome) if isinstance(outcome, Answered) else ""
    who = decision.ranked.ranker if decision.ranked is not None else ""
    return {"committed": words, "by": decision.override.who if decision.override else who}


def _facts(prompt: Prompt, query: Query | None) -> dict[str, object]:
    return {
        "order": prompt.order,
        "attempt": prompt.repair,
        "template": prompt.question.template,
        "request_sha256": prompt.request_sha256,
        "labels": dict(prompt.labels),
        "text": text_of(prompt),
        "answer": query.reply.text if query is not None else None,
        "outcome": outcome_words(query.outcome) if query is not None else None,
    }


def _write_pictures(prompts: list[Prompt], folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for prompt in prompts:
        for part in prompt.parts:
            if not isinstance(part, str):
                (folder / f"{part.sha256}.jpg").write_bytes(part.jpeg)
