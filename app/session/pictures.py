"""Every picture of the open branches by its digest: what `/api/image` serves."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from c2nav_engine.contract.question import Picture, Question
from c2nav_engine.navigator.requests import Ask, Facts, Note, Request, Seen, SketchState, Unasked
from c2nav_engine.runner.exchange import Exchange


class Album:
    """Digest → bytes; grows with the branches and keeps no second copy of any picture."""

    def __init__(self) -> None:
        self._pictures: dict[str, Picture] = {}
        self._read: dict[str, int] = {}

    def __len__(self) -> int:
        return len(self._pictures)

    def get(self, sha256: str) -> Picture | None:
        """The picture with that digest."""
        return self._pictures.get(sha256)

    def take(
        self, branch_id: str, exchanges: tuple[Exchange, ...], pending: Request | None
    ) -> None:
        """Add what a branch has that was not read yet."""
        done = self._read.get(branch_id, 0)
        for exchange in exchanges[done:]:
            self._add(_of_exchange(exchange))
        self._read[branch_id] = len(exchanges)
        if pending is not None:
            self._add(_of_request(pending))

    def clear(self) -> None:
        """Forget everything: another episode was opened."""
        self._pictures.clear()
        self._read.clear()

    def _add(self, pictures: Iterable[Picture | None]) -> None:
        for picture in pictures:
            if picture is not None:
                self._pictures.setdefault(picture.sha256, picture)


def _of_exchange(exchange: Exchange) -> Iterator[Picture | None]:
    yield from _of_request(exchange.request)
    if isinstance(exchange.response, Seen):
        yield from (view.picture for view in exchange.response.views)
        yield from exchange.response.sectors
        yield exchange.response.thumbnail


def _of_request(request: Request) -> Iterator[Picture | None]:
    if isinstance(request, Ask):
        yield from _of_question(request.question)
        yield from _of_facts(request.facts)
    elif isinstance(request, Note) and isinstance(request.record, Unasked):
        yield from _of_facts(request.record.facts)
    elif isinstance(request, Note) and isinstance(request.record, SketchState):
        yield request.record.entry.thumbnail


def _of_question(question: Question) -> Iterator[Picture | None]:
    yield from (alternative.picture for alternative in question.alternatives)
    yield from (picture for _, picture in question.context)


def _of_facts(facts: Facts) -> Iterator[Picture | None]:
    yield from (candidate.picture for candidate in facts.candidates)
