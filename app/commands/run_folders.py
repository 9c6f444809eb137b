"""What `inspect` makes of a folder: the pages about its runs, and traces that come later."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from app.commands.sources import opened_traces
from app.commands.surroundings import surroundings_of
from app.gateway.runs import RunPages
from app.pages.library import Library
from app.session.book import Book
from app.session.opened import Choice, Opened, Opening
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.spec import Setting


def pages_of(root: Path, scenes: Path | None) -> RunPages:
    """The pages about a folder; maps of an export stand on the floor where the scene is there."""
    return RunPages(
        Library(root, scenes), plan_of=lambda story: surroundings_of(story, scenes).plan
    )


def with_later_traces(
    opened: Opened, root: Path, setting: Setting, *, connectivity: Path | None = None
) -> Opened:
    """The same, opening also what was finished since: a run may still be going on.

    Only traces below the folder can be asked for.
    """
    known = {entry.entry_id for entry in opened.entries}

    def alone(entry: str) -> Opened:
        path = Path(entry)
        if path.suffix != ".mcap" or not path.resolve().is_relative_to(root.resolve()):
            message = f"expected a trace below {root}, came {entry!r}"
            raise UsageError(message)
        return opened_traces((path,), setting, connectivity=connectivity)

    def owner(entry: str) -> Opened:
        return opened if entry in known else alone(entry)

    def open_any(choice: Choice) -> Opening:
        return owner(choice.entry_id).open(choice)

    def book_of(entry: str, sha256: str) -> Book:
        opens = owner(entry).book
        assert opens is not None  # recorded traces always have one
        return opens(entry, sha256)

    return replace(opened, open=open_any, book=book_of)
