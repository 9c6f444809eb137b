"""Reads answers: people from reviews, models from traces and re-evaluations."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
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

Names = dict[tuple[str, int], str]
"""Trace digest and decision → the name of the question."""


def read_answers(what: Sequence[Path]) -> Answers:
    """Answers of run folders, files of reviews (`.jsonl`) and re-evaluations (`.parquet`).

    Raises:
        UsageError: Something is neither, or holds no answer.
    """
    names: Names = {}
    # Re-evaluations come last: what they ask about is named by the runs and reviews.
    found = [
        _of_run(path, names) if path.is_dir() else _of_file(path, names)
        for path in sorted(what, key=lambda path: path.suffix == ".parquet")
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


def _of_run(run: Path, names: Names) -> Answers:
    traces = sorted((run / "traces").glob("*.mcap"))
    return merged([*(of_trace(path, names) for path in traces), of_people(run, names)])


def of_trace(path: Path, names: Names) -> Answers:
    """What a model answered in a finished trace; adds to `names`."""
    given: list[Answer] = []
    showings: list[Showing] = []
    places: dict[str, tuple[Place, ...]] = {}
    with open_trace(path) as trace:
        for exchange in trace.decisions():
            if _asked(exchange):
                answer, shown = _of_model(exchange, trace)
                given.append(answer)
                showings += shown
                number = exchange.decision or 0
                names[trace.sha256, number] = answer.question
                here = (*places.get(answer.question, ()), Place(path, number))
                places[answer.question] = here
    return Answers(tuple(given), tuple(showings), places)


def of_people(run: Path, names: Names) -> Answers:
    """What people said about a run, under their pseudonyms; adds to `names`."""
    if not (run / FILE).is_file():
        return Answers((), ())
    with store_of(run) as store:
        return of_events(shared_events(store), names)


def _of_file(path: Path, names: Names) -> Answers:
    if path.suffix not in (".jsonl", ".parquet") or not path.is_file():
        message = (
            "expected a run folder, a file of reviews (.jsonl) or a re-evaluation (.parquet), "
            f"came {path}"
        )
        raise UsageError(message)
    if path.suffix == ".parquet":
        from c2nav_engine.experiments.reeval_table import read_table

        return _of_reevaluation(read_table(path), names)
    return of_events(read_lines(path.read_text("utf-8").splitlines(), where=str(path)), names)


def _of_reevaluation(rows: Sequence[Mapping[str, Any]], names: Names) -> Answers:
    """Both rankers of every row; the same ranker asked again is called so."""
    given: list[Answer] = []
    showings: list[Showing] = []
    for row in sorted(rows, key=lambda row: int(row["order"])):
        if row["form"] not in ORDINAL_FORMS:
            continue
        place = (row["trace_sha256"], row["decision"])
        question = names.get(place, f"{place[0]}/{place[1]}")
        episode = f"{row['scene_id']}/{row['episode_id']}"
        recorded, ranker = row["recorded_ranker"], row["ranker"]
        rater = _recorded_rater(ranker)
        if ranker == recorded:
            rater = replace(rater, name=f"{ranker}, again")
        shown = tuple(row["keys"])
        facts = (question, episode, row["slot"], tuple(sorted(shown)))
        tiers = tuple(tuple(tier) for tier in row["ranking"] or ())
        # Only the recorded winner is known here: the rest of that ranking stands in its trace.
        winner = ((row["recorded_winner"],),) if row["recorded_winner"] else ()
        answer = Answer(rater, *facts, tiers)
        given += [answer, Answer(_recorded_rater(recorded), *facts, winner)]
        showings.append(Showing(rater, row["slot"], Shown(episode, question, shown, answer.winner)))
    return Answers(tuple(given), tuple(showings))


def _recorded_rater(ranker: str) -> Rater:
    known = RANKERS.get(ranker)
    return Rater(
        ranker,
        human=ranker.startswith("human"),
        privileged=known is not None and known.privileged,
    )


def of_events(events: Iterable[Event], names: Names) -> Answers:
    """What people said blind in studies; answers of the second showing count for order alone."""
    given: list[Answer] = []
    showings: list[Showing] = []
    for event in standing(events):
        extra = event.extra
        if event.kind is not Kind.RANKING or not event.blind or "question" not in extra:
            continue
        rater = Rater(event.author, human=True)
        names[event.trace_sha256, event.decision] = extra["question"]
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
    rater = _recorded_rater(ranked.ranker)
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
