"""The list of tags that people choose from: one a line in a file beside the run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from c2nav_engine.errors import UsageError

FILE = "tags.txt"

MOST_LETTERS = 60
"""[C] Of one tag."""

AT_FIRST = (
    "early transition",
    "late transition",
    "wrong object",
    "not visible",
    "controller",
    "ambiguous instruction",
)
"""[C] The list of a run whose list nobody has edited."""


def read_tags(run: Path) -> tuple[str, ...]:
    """The tags of a run, in the order of its list."""
    path = run / FILE
    if not path.is_file():
        return AT_FIRST
    lines = (line.strip() for line in path.read_text("utf-8").splitlines())
    return tuple(dict.fromkeys(line for line in lines if line))


def write_tags(run: Path, tags: Sequence[str]) -> None:
    """Replace the list; raises `UsageError` for a tag that is too long."""
    found = dict.fromkeys(" ".join(tag.split()) for tag in tags)
    found.pop("", None)
    long = next((tag for tag in found if len(tag) > MOST_LETTERS), None)
    if long is not None:
        message = f"expected tags of at most {MOST_LETTERS} letters, came {long!r}"
        raise UsageError(message)
    run.mkdir(parents=True, exist_ok=True)
    (run / FILE).write_text("".join(f"{tag}\n" for tag in found), encoding="utf-8")
