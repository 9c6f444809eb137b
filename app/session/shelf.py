"""The books of reviews of everything that is open, and which answers have been on the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from app.session.book import Book
from app.session.branches import Branch
from app.session.judging import Seat, judgements_of
from app.session.snapshot import Judgement, Reviews
from app.session.story import Story
from c2nav_engine.errors import C2NavError

OpenBook = Callable[[str, str], Book]
"""(entry, digest of its trace or "") → its reviews."""


class Shelf:
    """One book a branch; used from the worker's thread alone."""

    def __init__(self, open_book: OpenBook | None) -> None:
        """Remember how books are opened; without it nothing can be reviewed."""
        self._open = open_book
        self._books: dict[str, Book] = {}
        self._shown: dict[str, int] = {}

    def clear(self) -> None:
        """Another entry is opened."""
        self._books.clear()
        self._shown.clear()

    def put(self, branch: Branch, entry_id: str) -> str:
        """Open the book of a new branch; returns why that could not be done, or ""."""
        if self._open is None or branch.branch_id in self._books:
            return ""
        # What was answered before a fork was seen in the branch that it left.
        self._shown[branch.branch_id] = branch.fork_decision + 1
        try:
            self._books[branch.branch_id] = self._open(entry_id, branch.trace_sha256)
        except C2NavError as error:
            return str(error)
        return ""

    def bind(self, branch_id: str, trace_sha256: str) -> None:
        """A branch has become a trace."""
        if branch_id in self._books:
            self._books[branch_id].bind(trace_sha256)

    def reviews(self, branch_id: str, story: Story) -> Reviews:
        """What everybody says of a branch."""
        return judgements_of(self._books.get(branch_id), story.track)

    def tags(self, branch_id: str) -> tuple[str, ...]:
        """The list of tags to choose from."""
        book = self._books.get(branch_id)
        return () if book is None else book.tags()

    def keep_tags(self, branch_id: str, tags: Sequence[str]) -> None:
        """Replace that list."""
        if branch_id in self._books:
            self._books[branch_id].keep_tags(tags)

    def note_shown(self, branch_id: str, decisions: int) -> None:
        """The answers of this many decisions, from 0, have been on the page."""
        self._shown[branch_id] = max(decisions, self._shown.get(branch_id, 0))

    def seat(self, branch_id: str, story: Story, *, decision: int, who: str) -> Seat | None:
        """Where somebody judges a decision; None where nothing can be reviewed."""
        book = self._books.get(branch_id)
        if book is None:
            return None
        shown = max(self._shown.get(branch_id, 0), book.seen_before(who))
        now = judgements_of(book, story.track).get((who, decision), Judgement())
        return Seat(book, decision, who, decision < shown, now, story.track)

    def book(self, branch_id: str) -> Book | None:
        """The book of a branch."""
        return self._books.get(branch_id)
