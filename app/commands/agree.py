"""`c2nav agree`: agreement and order effects between people and rankers."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console
from rich.table import Table

from app.commands.options import JsonOpt
from app.commands.output import print_json
from app.reviews.agreement import Agreement, OrderEffects, agreements, order_effects
from app.reviews.agreement_grids import agreement_grid, order_grid
from app.reviews.reading import read_answers
from c2nav_engine.experiments.report.grids import Grid
from c2nav_engine.experiments.statistics.intervals import Interval


def agree(
    what: Annotated[
        tuple[Path, ...],
        tyro.conf.Positional,
        tyro.conf.arg(
            metavar="FILE|RUN…", help="Run folders, reviews (.jsonl), re-evaluations (.parquet)."
        ),
    ],
    seed: Annotated[int, tyro.conf.arg(help="Of the bootstrap over episodes.")] = 0,
    json: JsonOpt = False,
) -> int:
    """Human–human, human–model and model–model agreement; rates as fractions of one in JSON."""
    answers = read_answers(what)
    pairs = agreements(answers, seed=seed)
    orders = order_effects(answers, seed=seed)
    if json:
        print_json(
            {
                "answers": len(answers.given),
                "beside_map": answers.beside_map,
                "agreement": [_agreement_json(row) for row in pairs],
                "orders": [_orders_json(row) for row in orders],
            }
        )
        return 0
    console = Console(highlight=False)
    for grid in (agreement_grid(pairs), order_grid(orders)):
        console.print(_table(grid))
        for note in grid.notes:
            console.print(note, markup=False, style="dim")
    return 0


def _agreement_json(row: Agreement) -> dict[str, object]:
    return {
        "kind": row.kind,
        "a": row.a,
        "b": row.b,
        "slot": row.slot,
        "questions": row.questions,
        "episodes": row.episodes,
        "top1": _interval_json(row.top1),
        "chance": row.chance,
        "tau": _interval_json(row.tau),
        "alpha": _interval_json(row.alpha),
        "confusion": [{"a": a, "b": b, "n": n} for (a, b), n in row.confusion.items()],
    }


def _orders_json(row: OrderEffects) -> dict[str, object]:
    return {
        "rater": row.rater.name,
        "human": row.rater.human,
        "seen": row.rater.seen,
        "slot": row.slot,
        "position_consistency": _interval_json(row.consistency),
        "repetition_stability": _interval_json(row.stability),
        "first_excess": _interval_json(row.first),
        "last_excess": _interval_json(row.last),
        "chance": row.chance,
    }


def _interval_json(interval: Interval | None) -> dict[str, object] | None:
    if interval is None or interval.n == 0 or math.isnan(interval.estimate):
        return None
    return {
        "estimate": interval.estimate,
        "low": interval.low,
        "high": interval.high,
        "n": interval.n,
    }


def _table(grid: Grid) -> Table:
    table = Table(*grid.heads)
    for row in grid.rows:
        table.add_row(*row.cells)
    return table
