"""Which parser makes the legs: the English one, or a ranker's language model once per text.

The same parse serves all variants, rankers and seeds of a run, so a model's answers are kept in
the run folder: whoever comes first writes them, everybody else reads.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable
from pathlib import Path

from c2nav_engine.contract.route import RouteLadder, parse_english
from c2nav_engine.contract.route_model import Complete, parse_with_model
from c2nav_engine.errors import UsageError

PARSERS = ("english", "model")
"""Names of the route parsers; the first is the default."""

Parse = Callable[[str], RouteLadder]


def parser_named(name: str) -> str:
    """The name itself; raises `UsageError` for one that does not exist."""
    if name not in PARSERS:
        message = f"expected a route parser ({', '.join(PARSERS)}), came {name!r}"
        raise UsageError(message)
    return name


def parse_for(name: str, complete: Callable[[], Complete], kept_in: Path) -> Parse:
    """The parser of that name.

    Args:
        name: One of `PARSERS`.
        complete: Makes the completion through the ranker's server; called for `model` alone.
        kept_in: Folder for the model's parses.
    """
    if parser_named(name) == "english":
        return parse_english
    completion = complete()

    def parse(instruction: str) -> RouteLadder:
        path = kept_in / f"{hashlib.sha256(instruction.encode()).hexdigest()[:32]}.json"
        if not path.is_file():
            _keep(parse_with_model(instruction, completion), path)
        return _kept(path)

    return parse


def _keep(ladder: RouteLadder, path: Path) -> None:
    """Write a parse unless another worker was first: all of a run share one."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.{os.getpid()}")
    facts = {"legs": ladder.legs, "parser": ladder.parser, "spans": ladder.spans}
    part.write_text(json.dumps(facts), encoding="utf-8")
    try:
        os.link(part, path)
    except FileExistsError:
        pass
    finally:
        part.unlink()


def _kept(path: Path) -> RouteLadder:
    facts = json.loads(path.read_text(encoding="utf-8"))
    return RouteLadder(
        tuple(facts["legs"]), facts["parser"], tuple((a, b) for a, b in facts["spans"])
    )
