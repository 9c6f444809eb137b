"""Agreement and order effects as plain grids, for the terminal and for a report's human study."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from app.reviews.agreement import KINDS, Agreement, OrderEffects, agreements, order_effects
from app.reviews.reading import read_answers
from app.reviews.store import FILE
from c2nav_engine.experiments.report.content import Annex
from c2nav_engine.experiments.report.grids import NONE, Grid, GridRow
from c2nav_engine.experiments.statistics.intervals import Interval

INTERVALS = "Intervals: 95 %, whole episodes drawn again. α stands for single slots only."


def human_study(runs: Sequence[Path], *, seed: int = 0) -> Annex | None:
    """What people said about these runs beside the models; None where nobody was asked.

    Args:
        runs: Run folders.
        seed: Of the bootstrap over episodes.
    """
    if not any((run / FILE).is_file() for run in runs):
        return None
    answers = read_answers(runs)
    if not answers.people:
        return None
    pairs = [row for row in agreements(answers, seed=seed) if row.kind in KINDS[:2]]
    orders = [row for row in order_effects(answers, seed=seed) if row.rater.name in answers.people]
    questions = {each.question for each in answers.given}
    notes = [
        f"{len(answers.people)} people on {len(questions)} recorded questions. They saw what the "
        "model was sent. Agreement is not accuracy: nobody here is told the right answer."
    ]
    if answers.beside_map:
        notes.append(
            f"{answers.beside_map} of their rankings were made blind in the inspector, where the "
            "map stands beside the question."
        )
    return Annex("Human study", tuple(notes), (agreement_grid(pairs), order_grid(orders)))


def agreement_grid(rows: Sequence[Agreement]) -> Grid:
    """One row a pair of raters, or all pairs of a kind, and slot."""
    return Grid(
        "human-study-agreement",
        "Agreement between raters",
        ("Kind", "Pair", "Slot", "n", "Top-1 %", "Chance %", "Mean τ", "α"),
        tuple(
            GridRow(
                (
                    row.kind,
                    f"{row.a} · {row.b}" if row.a else "all",
                    row.slot,
                    str(row.questions),
                    _words(row.top1, percent=True),
                    NONE if row.chance is None else f"{100 * row.chance:.0f}",
                    _words(row.tau),
                    _words(row.alpha),
                ),
                block=KINDS.index(row.kind),
            )
            for row in rows
        ),
        text_columns=3,
        notes=(INTERVALS,),
    )


def order_grid(rows: Sequence[OrderEffects]) -> Grid:
    """One row a rater and slot."""
    return Grid(
        "human-study-orders",
        "Effects of the order shown",
        ("Rater", "Slot", "One winner in every order %", "Again alike %", "First", "Last"),
        tuple(
            GridRow(
                (
                    row.rater.name,
                    row.slot,
                    _words(row.consistency, percent=True),
                    _words(row.stability, percent=True),
                    _words(row.first),
                    _words(row.last),
                )
            )
            for row in rows
        ),
        text_columns=2,
        notes=("First, last: how much more often than 1/m that place wins.",),
    )


def _words(interval: Interval | None, *, percent: bool = False) -> str:
    if interval is None or interval.n == 0:
        return NONE
    scale, digits = (100, 0) if percent else (1, 2)
    middle, low, high = (
        f"{scale * value:.{digits}f}" for value in (interval.estimate, interval.low, interval.high)
    )
    return f"{middle} ({low} … {high})"
