"""`c2nav question`: a recorded question, exactly as it was sent."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import tyro

from app.commands.options import JsonOpt
from app.commands.output import print_json
from c2nav_engine.contract.prompt import Prompt
from c2nav_engine.contract.render import text_of
from c2nav_engine.errors import UsageError
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.recorded import open_trace


def question(
    trace: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="TRACE")],
    at: Annotated[int, tyro.conf.arg(metavar="K", help="Decision number, from 0.")],
    pictures: Annotated[
        Path | None, tyro.conf.arg(metavar="DIR", help="Write the pictures there, as sent.")
    ] = None,
    json: JsonOpt = False,
) -> int:
    """Print every query of a decision: text, pictures by hash, labels, raw answer."""
    with open_trace(trace) as opened:
        decision = opened.decision(at)
    if not isinstance(decision.request, Ask):
        message = f"decision {at} of {trace.name} was settled without a question"
        raise UsageError(message)
    prompts = _prompts(decision)
    if pictures is not None:
        _write_pictures(prompts, pictures)
    if json:
        print_json({"decision": at, "queries": _queries(decision)})
        return 0
    for query in _queries(decision):
        sys.stdout.write(f"--- order {query['order']}, attempt {query['attempt']}\n")
        sys.stdout.write(f"{query['text']}\n--- answer\n{query['answer']}\n\n")
    return 0


def _prompts(decision: Exchange) -> list[Prompt]:
    return [query.prompt for query in decision.ranked.queries] if decision.ranked else []


def _queries(decision: Exchange) -> list[dict[str, object]]:
    queries = decision.ranked.queries if decision.ranked else ()
    return [
        {
            "order": query.prompt.order,
            "attempt": query.prompt.repair,
            "template": query.prompt.question.template,
            "request_sha256": query.prompt.request_sha256,
            "labels": dict(query.prompt.labels),
            "text": text_of(query.prompt),
            "answer": query.reply.text,
        }
        for query in queries
    ]


def _write_pictures(prompts: list[Prompt], folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for prompt in prompts:
        for part in prompt.parts:
            if not isinstance(part, str):
                (folder / f"{part.sha256}.jpg").write_bytes(part.jpeg)
