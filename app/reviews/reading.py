"""Reads answers: people from reviews, models from traces and re-evaluations.

What a person ranks in the inspector names a trace and a decision only; what was asked there is
read from the trace. Whoever ranked after seeing the model's answer becomes a rater apart.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from app.reviews.answers import Answer, Answers, Place, Rater, Showing
from app.reviews.events import Event, Kind
from app.reviews.questions import question_id
from app.reviews.state import standing
from app.reviews.store import FILE, read_lines, shared_events, store_of
from c2nav_engine.contract.outcome import Answered, Key, Ordering, Tie
from c2nav_engine.contract.presentation import ORDINAL_FORMS
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.rankers import RANKERS
from c2nav_engine.experiments.statistics.orders import Shown
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.recorded import OpenTrace, open_trace


@dataclass(frozen=True, slots=True)
class Asked:
    """What was asked at one decision, as an answer names it.

    Attributes:
        question: Names what was asked, whatever the order shown.
        episode: Scene and episode.
        slot: Decision slot.
        keys: What was offered, sorted.
    """

    question: str
    episode: str
    slot: str
    keys: tuple[Key, ...]

    def answer(self, rater: Rater, tiers: tuple[tuple[Key, ...], ...]) -> Answer:
        """Somebody's answer to it."""
        return Answer(rater, self.question, self.episode, self.slot, self.keys, tiers)

    def showing(self, rater: Rater, shown: tuple[Key, ...], winner: Key | None) -> Showing:
        """It was shown in this order, and that was elected."""
        return Showing(rater, self.slot, Shown(self.episode, self.question, shown, winner))


_FILES = (".jsonl", ".parquet")

Questions = dict[tuple[str, int], Asked]
"""Trace digest and decision → what was asked there, as far as traces or studies told."""


def read_answers(what: Sequence[Path]) -> Answers:
    """Answers of run folders, files of reviews (`.jsonl`) and re-evaluations (`.parquet`).

    Raises:
        UsageError: Something is neither, or holds no answer.
    """
    known: Questions = {}
    # Reviews speak of what runs asked, re-evaluations of either.
    found = [
        _of_run(path, known) if path.is_dir() else _of_file(path, known)
        for path in sorted(what, key=lambda path: (not path.is_dir(), path.suffix != _FILES[0]))
    ]
    together = merged(found)
    if not together.given:
        message = f"expected answers in {', '.join(map(str, what)) or 'runs or files'}, found none"
        raise UsageError(message)
    return together


def merged(found: Iterable[Answers]) -> Answers:
    """Answers of several sources; of several to one question by one rater the first counts."""
    parts = tuple(found)
    places: dict[str, tuple[Place, ...]] = {}
    for part in parts:
        for question, here in part.places.items():
            places[question] = (*places.get(question, ()), *here)
    return Answers(
        _first_given(answer for part in parts for answer in part.given),
        tuple(showing for part in parts for showing in part.showings),
        places,
    )


def _first_given(given: Iterable[Answer]) -> tuple[Answer, ...]:
    first: dict[tuple[Rater, str], Answer] = {}
    for answer in given:
        first.setdefault((answer.rater, answer.question), answer)
    return tuple(first.values())


def _of_run(run: Path, known: Questions) -> Answers:
    traces = sorted((run / "traces").glob("*.mcap")) or sorted(run.glob("*.mcap"))
    return merged([*(of_trace(path, known) for path in traces), of_people(run, known)])


def of_trace(path: Path, known: Questions) -> Answers:
    """What a model answered in a finished trace; adds to `known`."""
    given: list[Answer] = []
    showings: list[Showing] = []
    places: dict[str, tuple[Place, ...]] = {}
    with open_trace(path) as trace:
        for exchange in trace.decisions():
            if _was_asked(exchange):
                asked, answer, shown = _of_model(exchange, trace)
                given.append(answer)
                showings += shown
                number = exchange.decision or 0
                known[trace.sha256, number] = asked
                places[asked.question] = (*places.get(asked.question, ()), Place(path, number))
    return Answers(tuple(given), tuple(showings), places)


def of_people(run: Path, known: Questions) -> Answers:
    """What people said about a run, under their pseudonyms; adds to `known`."""
    if not (run / FILE).is_file():
        return Answers((), ())
    with store_of(run) as store:
        return of_events(shared_events(store), known)


def _of_file(path: Path, known: Questions) -> Answers:
    if path.suffix not in _FILES or not path.is_file():
        message = (
            "expected a run folder, a file of reviews (.jsonl) or a re-evaluation (.parquet), "
            f"came {path}"
        )
        raise UsageError(message)
    if path.suffix == ".parquet":
        return of_reevaluation(path, known)
    return of_events(read_lines(path.read_text("utf-8").splitlines(), where=str(path)), known)


def of_reevaluation(path: Path, known: Questions) -> Answers:
    """Both rankers of every row; the same ranker asked again is called so."""
    from c2nav_engine.experiments.reeval_table import read_table

    given: list[Answer] = []
    showings: list[Showing] = []
    for row in sorted(read_table(path), key=lambda row: int(row["order"])):
        if row["form"] not in ORDINAL_FORMS:
            continue
        asked, shown = _asked_again(row, known), tuple(row["keys"])
        recorded, ranker = row["recorded_ranker"], row["ranker"]
        rater = _recorded_rater(ranker)
        if ranker == recorded:
            rater = replace(rater, name=f"{ranker}, again")
        # Only the recorded winner is known here: the rest of that ranking stands in its trace.
        winner = ((row["recorded_winner"],),) if row["recorded_winner"] else ()
        answer = asked.answer(rater, tuple(tuple(tier) for tier in row["ranking"] or ()))
        given += [answer, asked.answer(_recorded_rater(recorded), winner)]
        showings.append(asked.showing(rater, shown, answer.winner))
    return Answers(tuple(given), tuple(showings))


def _asked_again(row: Mapping[str, Any], known: Questions) -> Asked:
    """What a row asked; its own words where no trace of it was read."""
    place = (row["trace_sha256"], row["decision"])
    episode = f"{row['scene_id']}/{row['episode_id']}"
    own = Asked(f"{place[0]}/{place[1]}", episode, row["slot"], tuple(sorted(row["keys"])))
    return known.get(place, own)


def _recorded_rater(ranker: str) -> Rater:
    known = RANKERS.get(ranker)
    return Rater(
        ranker,
        human=ranker.startswith("human"),
        privileged=known is not None and known.privileged,
    )


def of_events(events: Iterable[Event], known: Questions) -> Answers:
    """People's own rankings, of studies first; adds to `known`.

    A study's second showing of an item counts for order alone. Rankings in the inspector count for
    agreement alone, because views stand there where they lie and in no order, and only where the
    question is known.
    """
    said = [event for event in standing(events) if event.kind is Kind.RANKING]
    given: list[Answer] = []
    showings: list[Showing] = []
    for event in said:
        if "question" in event.extra:
            asked = _asked_in_study(event)
            known[event.trace_sha256, event.decision] = asked
            answer = asked.answer(_person(event), _tiers(event.said))
            if event.extra.get("again") != "yes":
                given.append(answer)
            shown = tuple(event.extra["shown"].split())
            showings.append(asked.showing(answer.rater, shown, answer.winner))
    for event in said:
        asked = known.get((event.trace_sha256, event.decision))
        if "question" not in event.extra and asked is not None:
            answer = asked.answer(_person(event), _tiers(event.said))
            given.append(replace(answer, beside_map=True))
    return Answers(tuple(given), tuple(showings))


def _person(event: Event) -> Rater:
    if event.blind and not event.model_seen:
        return Rater(event.author, human=True)
    return Rater(f"{event.author}, answer seen", human=True, seen=True)


def _asked_in_study(event: Event) -> Asked:
    extra = event.extra
    keys = tuple(sorted(extra["shown"].split()))
    return Asked(extra["question"], extra["episode"], extra["slot"], keys)


def _was_asked(exchange: Exchange) -> bool:
    return (
        isinstance(exchange.request, Ask)
        and exchange.request.question.form in ORDINAL_FORMS
        and exchange.ranked is not None
    )


def _of_model(exchange: Exchange, trace: OpenTrace) -> tuple[Asked, Answer, list[Showing]]:
    assert isinstance(exchange.request, Ask)
    assert exchange.ranked is not None
    question, ranked = exchange.request.question, exchange.ranked
    episode = f"{trace.header.episode.scene_id}/{trace.header.episode.episode_id}"
    keys = tuple(sorted(question.keys))
    asked = Asked(question_id(question), episode, question.slot.value, keys)
    rater = _recorded_rater(ranked.ranker)
    # A repair asks the same presentation again: what counts is where it ended.
    last = {query.prompt.order: query for query in ranked.queries}
    showings = [
        asked.showing(
            rater,
            tuple(key for _, key in query.prompt.labels),
            query.outcome.winner if isinstance(query.outcome, Ordering) else None,
        )
        for query in last.values()
    ]
    return asked, asked.answer(rater, _tiers(ranked.outcome)), showings


def _tiers(outcome: Answered | None) -> tuple[tuple[Key, ...], ...]:
    return outcome.tiers if isinstance(outcome, Ordering | Tie) else ()
