"""Who answered what, in one shape: people from reviews, models from traces."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from app.reviews.events import Event, Kind
from app.reviews.questions import question_id
from app.reviews.state import standing
from app.reviews.store import FILE, read_lines, shared_events, store_of
from c2nav_engine.contract.outcome import Answered, Key, Ordering, Tie
from c2nav_engine.contract.presentation import ORDINAL_FORMS
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.statistics.orders import Shown
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.recorded import OpenTrace, open_trace


@dataclass(frozen=True, slots=True)
class Rater:
    """A person or a model.

    Attributes:
        name: Pseudonym, or the ranker's name.
        human: Whether it is a person.
    """

    name: str
    human: bool


@dataclass(frozen=True, slots=True)
class Answer:
    """One answer of one rater to one question.

    Attributes:
        rater: Who.
        question: Names what was asked, whatever the order shown; equal over runs.
        episode: Scene and episode.
        slot: Decision slot.
        keys: What was offered, sorted.
        tiers: Keys from best to worst; () when nothing was ranked.
    """

    rater: Rater
    question: str
    episode: str
    slot: str
    keys: tuple[Key, ...]
    tiers: tuple[tuple[Key, ...], ...]

    @property
    def winner(self) -> Key | None:
        """The single best, if there is one."""
        return self.tiers[0][0] if self.tiers and len(self.tiers[0]) == 1 else None


@dataclass(frozen=True, slots=True)
class Showing:
    """One presentation and what was elected: the material of order effects."""

    rater: Rater
    slot: str
    shown: Shown


@dataclass(frozen=True, slots=True)
class Answers:
    """Everything that was read.

    Attributes:
        given: One answer a rater and question: the first one where several were given.
        showings: Every presentation.
    """

    given: tuple[Answer, ...]
    showings: tuple[Showing, ...]


def read_answers(what: Sequence[Path]) -> Answers:
    """Answers of run folders and files of reviews (`.jsonl`).

    Raises:
        UsageError: Something is neither, or holds no answer.
    """
    given: list[Answer] = []
    showings: list[Showing] = []
    for path in what:
        found = _of_run(path) if path.is_dir() else _of_file(path)
        given += found.given
        showings += found.showings
    if not given:
        message = f"expected answers in {', '.join(map(str, what)) or 'runs or files'}, found none"
        raise UsageError(message)
    return Answers(_first_given(given), tuple(showings))


def _first_given(given: Iterable[Answer]) -> tuple[Answer, ...]:
    first: dict[tuple[Rater, str], Answer] = {}
    for answer in given:
        first.setdefault((answer.rater, answer.question), answer)
    return tuple(first.values())


def _of_run(run: Path) -> Answers:
    given: list[Answer] = []
    showings: list[Showing] = []
    for path in sorted((run / "traces").glob("*.mcap")):
        with open_trace(path) as trace:
            for exchange in trace.decisions():
                if _asked(exchange):
                    answer, shown = _of_model(exchange, trace)
                    given.append(answer)
                    showings += shown
    if (run / FILE).is_file():
        with store_of(run) as store:
            people = of_events(shared_events(store))
        given += people.given
        showings += people.showings
    return Answers(tuple(given), tuple(showings))


def _of_file(path: Path) -> Answers:
    if path.suffix != ".jsonl" or not path.is_file():
        message = f"expected a run folder or a file of reviews (.jsonl), came {path}"
        raise UsageError(message)
    return of_events(read_lines(path.read_text("utf-8").splitlines(), where=str(path)))


def of_events(events: Iterable[Event]) -> Answers:
    """What people said blind in studies; answers of the second showing count for order alone."""
    given: list[Answer] = []
    showings: list[Showing] = []
    for event in standing(events):
        extra = event.extra
        if event.kind is not Kind.RANKING or not event.blind or "question" not in extra:
            continue
        rater = Rater(event.author, human=True)
        shown = tuple(extra["shown"].split())
        tiers = _tiers(event.said)
        answer = Answer(
            rater,
            extra["question"],
            extra["episode"],
            extra["slot"],
            tuple(sorted(shown)),
            tiers,
        )
        if extra.get("again") != "yes":
            given.append(answer)
        showings.append(
            Showing(
                rater,
                extra["slot"],
                Shown(extra["episode"], extra["question"], shown, answer.winner),
            )
        )
    return Answers(tuple(given), tuple(showings))


def _asked(exchange: Exchange) -> bool:
    return (
        isinstance(exchange.request, Ask)
        and exchange.request.question.form in ORDINAL_FORMS
        and exchange.ranked is not None
    )


def _of_model(exchange: Exchange, trace: OpenTrace) -> tuple[Answer, list[Showing]]:
    assert isinstance(exchange.request, Ask)
    assert exchange.ranked is not None
    question, ranked = exchange.request.question, exchange.ranked
    episode = f"{trace.header.episode.scene_id}/{trace.header.episode.episode_id}"
    rater = Rater(ranked.ranker, human=ranked.ranker.startswith("human"))
    name = question_id(question)
    answer = Answer(
        rater,
        name,
        episode,
        question.slot.value,
        tuple(sorted(question.keys)),
        _tiers(ranked.outcome),
    )
    # A repair asks the same presentation again: what counts is where it ended.
    last = {query.prompt.order: query for query in ranked.queries}
    showings = [
        Showing(
            rater,
            question.slot.value,
            Shown(
                episode,
                name,
                tuple(key for _, key in query.prompt.labels),
                query.outcome.winner if isinstance(query.outcome, Ordering) else None,
            ),
        )
        for query in last.values()
    ]
    return answer, showings


def _tiers(outcome: Answered | None) -> tuple[tuple[Key, ...], ...]:
    return outcome.tiers if isinstance(outcome, Ordering | Tie) else ()
