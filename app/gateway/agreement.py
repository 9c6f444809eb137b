"""`/agreement`: people and models beside each other, for the runs that are open."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Annotated

from fastapi import APIRouter, FastAPI, Query
from fastapi.responses import HTMLResponse, Response
from pydantic import BaseModel

from app.gateway.agreement_desk import AgreementDesk
from app.pages.agreement import (
    SHADES,
    Bar,
    Cell,
    Confusion,
    Difference,
    PairRow,
    Privileged,
    RaterRow,
    Shown,
    agreement_page,
    differences_page,
    nobody_page,
    reading_page,
)
from app.pages.page import link
from app.reviews.agreement import (
    ALL,
    Agreement,
    OrderEffects,
    Pair,
    kind_of,
    pairs_of,
)
from app.reviews.answers import Answers, Rater
from app.reviews.truth import BestElected, best_elected, judging_of
from app.session.opened import Opened
from app.session.wording import key_words, ranking, slot_words
from c2nav_engine.contract.question import Slot
from c2nav_engine.errors import C2NavError
from c2nav_engine.experiments.statistics.intervals import Interval

PATIENCE_S = 1.5
"""How long a page may take to read traces before it says how far that is [C]."""

_GROUPS = {
    "human-human": "People among themselves",
    "human-model": "People and models",
    "model-model": "Models among themselves",
    "seen": "◇ People who had seen the model's answer",
    "privileged": "◆ Against a ranker that knows the truth",
}


class Asked(BaseModel):
    """What an address of the page asks for.

    Attributes:
        slot: Decision slot, or all.
        kind: Kind of the chosen pair.
        a: Its first rater; "" for all pairs of the kind.
        b: Its second rater.
        said_a: Winner of the first one: the decisions of that cell are asked for.
        said_b: Winner of the second one.
        best: Whether to hold everybody against the geodesically best alternative.
    """

    slot: str = ALL
    kind: str = ""
    a: str = ""
    b: str = ""
    said_a: str = ""
    said_b: str = ""
    best: bool = False


def agreement_routes(desk: AgreementDesk, menu: Sequence[str]) -> APIRouter:
    """The page, and the decisions behind its cells; `menu` names the pages served with it."""
    router = APIRouter(include_in_schema=False)

    @router.get("/agreement")
    def agreement(asked: Annotated[Asked, Query()]) -> Response:
        runs = tuple(run.name for run in desk.runs)
        reading = desk.reading(PATIENCE_S)
        if reading.done < reading.total:
            return HTMLResponse(reading_page(reading, runs=runs, menu=menu))
        if not desk.answers().given:
            return HTMLResponse(nobody_page(runs, menu=menu))
        if asked.said_a and asked.said_b:
            said_a, said_b = key_words(asked.said_a), key_words(asked.said_b)
            title = f"{_slot(asked.slot)}: {said_a} against {said_b}"
            back = link("agreement", kind=asked.kind, a=asked.a, b=asked.b)
            found = _behind(desk, asked)
            page = differences_page(title, found, runs=runs, back=back, menu=menu)
            return HTMLResponse(page)
        return HTMLResponse(agreement_page(_shown(desk, asked), menu=menu))

    return router


def has_agreement(opened: Opened) -> bool:
    """Whether answers are compared: where the inspector is open on the traces of runs."""
    entries = [entry.entry_id for entry in opened.entries]
    return bool(entries) and all(entry.endswith(".mcap") for entry in entries)


def mount_agreement(
    app: FastAPI, opened: Opened, *, menu: Sequence[str], beside: Sequence[Path] = ()
) -> None:
    """Add the page to the inspector where there are answers to compare; see `AgreementDesk`."""
    if has_agreement(opened):
        app.include_router(agreement_routes(AgreementDesk(opened, beside), menu))


# ---------------------------------------------------------------- what the page shows


def _shown(desk: AgreementDesk, asked: Asked) -> Shown:
    answers = desk.answers()
    agreement, orders = desk.rows()
    slots = sorted({answer.slot for answer in answers.given})
    slot = asked.slot if asked.slot in slots else ALL
    here = _of_slot(agreement, slot)
    chosen = _chosen(here, (asked.kind, asked.a, asked.b))
    raters = {answer.rater for answer in answers.given}
    truth, privileged = _privileged(desk, answers, wanted=asked.best)
    return Shown(
        runs=tuple(run.name for run in desk.runs),
        people=len(answers.people),
        beside_map=answers.beside_map,
        rankers=sum(not rater.human for rater in raters),
        questions=len({answer.question for answer in answers.given}),
        slots=((ALL, "All slots"), *((name, _slot(name)) for name in slots)),
        slot=slot,
        group=_GROUPS.get(chosen[0], ""),
        kind=chosen[0],
        pair=chosen[1:],
        pairs=tuple(_pair_row(row, chosen) for row in here),
        raters=tuple(_rater_row(row, truth) for row in orders if row.slot == slot),
        confusions=tuple(
            _confusion(row)
            for row in agreement
            if (row.kind, row.a, row.b) == chosen
            and row.slot != ALL
            and slot in (ALL, row.slot)
            and row.confusion
        ),
        privileged=privileged,
    )


def _of_slot(rows: Sequence[Agreement], slot: str) -> list[Agreement]:
    """One row a pair; one that was asked about a single slot has no other row for all of them."""
    several = {(row.kind, row.a, row.b) for row in rows if row.slot == ALL}
    return [
        row
        for row in rows
        if row.slot == slot or (slot == ALL and (row.kind, row.a, row.b) not in several)
    ]


def _chosen(rows: Sequence[Agreement], pair: tuple[str, str, str]) -> tuple[str, str, str]:
    """The pair that was asked for where there is one, else people against a model first."""
    names = [(row.kind, row.a, row.b) for row in rows]
    mixed = [name for name in names if name[0] == "human-model"]
    return pair if pair in names else next(iter(mixed or names), ("", "", ""))


def _privileged(
    desk: AgreementDesk, answers: Answers, *, wanted: bool
) -> tuple[list[BestElected], Privileged]:
    judging = judging_of(desk.runs)
    state = Privileged(False, judging.answered, judging.places)
    if not (wanted and judging.complete):
        return [], state
    try:
        truth = best_elected(answers, desk.best())
    except C2NavError as error:
        return [], Privileged(False, judging.answered, judging.places, str(error))
    if not truth:
        problem = "no floor or no goal at hand; open the run with --scenes DIR"
        return [], Privileged(False, judging.answered, judging.places, problem)
    return truth, Privileged(True, judging.answered, judging.places)


def _pair_row(row: Agreement, chosen: tuple[str, str, str]) -> PairRow:
    return PairRow(
        group=_GROUPS[row.kind],
        kind=row.kind,
        a=row.a,
        b=row.b,
        questions=row.questions,
        episodes=row.episodes,
        top1=_rate(row.top1, row.chance, drawn=row.episodes > 1),
        tau=_signed(row.tau, drawn=row.episodes > 1),
        alpha=_signed(row.alpha, drawn=row.episodes > 1),
        chosen=(row.kind, row.a, row.b) == chosen,
    )


def _rater_row(row: OrderEffects, truth: Iterable[BestElected]) -> RaterRow:
    best = next((one for one in truth if (one.rater, one.slot) == (row.rater, row.slot)), None)
    return RaterRow(
        name=row.rater.name,
        what=_what(row.rater),
        consistency=_rate(row.consistency),
        stability=_rate(row.stability),
        first=_signed(row.first),
        last=_signed(row.last),
        best=None if best is None else _rate(best.share, best.chance),
    )


def _what(rater: Rater) -> str:
    if rater.privileged:
        return "◆ knows the truth"
    if rater.seen:
        return "◇ person"
    return "person" if rater.human else ""


def _rate(
    interval: Interval | None, chance: float | None = None, *, drawn: bool = True
) -> Bar | None:
    """A share of one, in percent; its ends are left out where nothing could be `drawn` again."""
    if interval is None or interval.n == 0 or math.isnan(interval.estimate):
        return None
    words = f"{100 * interval.estimate:.0f}"
    if drawn:
        words += f" ({100 * interval.low:.0f}–{100 * interval.high:.0f})"
    beside = "" if chance is None else f"chance {100 * chance:.0f}"
    return Bar(words, interval.low, interval.estimate, interval.high, chance, beside)


def _signed(interval: Interval | None, *, drawn: bool = True) -> Bar | None:
    """A figure from −1 to 1, held against 0; its ends as in `_rate`."""
    if interval is None or interval.n == 0 or math.isnan(interval.estimate):
        return None
    middle, low, high = (
        # Adding 0.0 turns a rounded −0.0 into 0.0.
        f"{round(value, 2) + 0.0:.2f}".replace("-", "−")
        for value in (interval.estimate, interval.low, interval.high)
    )
    ends = ((1 + value) / 2 for value in (interval.low, interval.estimate, interval.high))
    return Bar(f"{middle} ({low} … {high})" if drawn else middle, *ends, mark=0.5)


def _confusion(row: Agreement) -> Confusion:
    counts: Mapping[tuple[str, str], int] = Counter(row.confusion)
    roles = sorted({role for pair in counts for role in pair})
    most = max(counts.values())
    return Confusion(
        slot=row.slot,
        words=_slot(row.slot),
        columns=tuple(map(key_words, roles)),
        rows=tuple(
            (
                key_words(a),
                tuple(
                    Cell(a, b, counts[a, b], math.ceil((SHADES - 1) * counts[a, b] / most))
                    for b in roles
                ),
            )
            for a in roles
        ),
    )


def _slot(name: str) -> str:
    slot = next((slot for slot in Slot if slot.value == name), None)
    return name if slot is None else slot_words(slot)


# ---------------------------------------------------------------- the decisions behind a cell


def _behind(desk: AgreementDesk, asked: Asked) -> list[Difference]:
    answers = desk.answers()
    said = (asked.said_a, asked.said_b)

    def meant(pair: tuple[Rater, Rater]) -> bool:
        named = (pair[0].name, pair[1].name) == (asked.a, asked.b)
        return kind_of(*pair) == asked.kind and (named or not asked.a)

    return [
        _difference(desk, answers, pair)
        for raters, pairs in pairs_of(answers).items()
        if meant(raters)
        for pair in pairs
        if asked.slot in (ALL, pair.a.slot) and (pair.a.winner, pair.b.winner) == said
    ]


def _difference(desk: AgreementDesk, answers: Answers, pair: Pair) -> Difference:
    places = answers.places.get(pair.a.question, ())
    # The trace of the ranker in question is among them; any of them asks the same.
    place = next((one for one in places if desk.entry_of(one.trace)), None)
    words = {key: key_words(key) for key in pair.a.keys}
    return Difference(
        episode=pair.a.episode,
        slot=_slot(pair.a.slot),
        a=pair.a.rater.name,
        said_a=ranking(pair.a.tiers, words),
        b=pair.b.rater.name,
        said_b=ranking(pair.b.tiers, words),
        entry="" if place is None else desk.entry_of(place.trace),
        decision=-1 if place is None else place.decision,
    )
