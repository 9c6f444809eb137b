"""`c2nav reeval`: recorded questions, asked again of any ranker in any order."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from app.commands.options import JsonOpt, RankerOptions, key_values
from app.commands.output import check_file, print_json
from app.commands.what import trace_files
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.asking import asking_from
from c2nav_engine.experiments.rankers import RANKERS, ranker_for
from c2nav_engine.experiments.reeval import OrderSet, count_queries, reevaluate
from c2nav_engine.experiments.reeval_summary import SlotSummary, summarise
from c2nav_engine.experiments.reeval_table import FACTS, Record, record_of, write_table
from c2nav_engine.experiments.statistics.intervals import Interval


def reeval(
    traces: Annotated[
        tuple[Path, ...],
        tyro.conf.Positional,
        tyro.conf.arg(metavar="TRACE…", help="Finished traces, or run folders."),
    ],
    ranker: Annotated[str, tyro.conf.arg(help="Who is asked.")],
    out: Annotated[Path, tyro.conf.arg(metavar="FILE.parquet", help="One row a presentation.")],
    ranker_opt: RankerOptions = (),
    orders: Annotated[
        Literal["1", "2", "all"],
        tyro.conf.arg(help="Recorded order; with its reverse; or every permutation of up to four."),
    ] = "1",
    json: JsonOpt = False,
) -> int:
    """Ask recorded questions again: decision-level, open-loop, without an answer cache."""
    paths = trace_files([str(path) for path in traces])
    if not paths:
        message = "expected traces or run folders, came none that holds a trace"
        raise UsageError(message)
    check_file(out, *paths)
    options = key_values(ranker_opt)
    if "cache" in options:
        message = "expected no answer cache, came the option cache; questions are asked anew here"
        raise UsageError(message)
    asking, _ = asking_from(options)
    answering = ranker_for(ranker, options)
    order_set = OrderSet(orders)
    at_once = asking.concurrency if RANKERS[ranker].remote else 1
    records: list[Record] = []
    try:
        total = count_queries(paths, order_set)
        results = reevaluate(paths, answering, order_set, at_once=at_once)
        with closing(results), _progress(quiet=json) as progress:
            bar = progress.add_task("", total=total)
            for result in results:
                records.append(record_of(result, answering.name))
                progress.advance(bar)
    finally:
        # Interrupted or stopped: what was answered is kept.
        if records:
            write_table(records, out)
        answering.close()
    _tell(records, out, json=json)
    return 0


def _progress(*, quiet: bool) -> Progress:
    columns = (
        TextColumn("presentations"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    return Progress(*columns, console=Console(stderr=True), disable=quiet)


def _tell(records: Sequence[Record], out: Path, *, json: bool) -> None:
    summaries = summarise(records)
    if json:
        slots = [_plain(summary) for summary in summaries]
        print_json({"out": str(out), "rows": len(records), "what": FACTS["what"], "slots": slots})
        return
    console = Console(highlight=False)
    table = Table(box=None, header_style="bold")
    table.add_column("slot")
    for head in (
        "questions",
        "asked",
        "elected",
        "as recorded",
        "chance",
        "position",
        "letter",
        "first",
        "letter A",
    ):
        table.add_column(head, justify="right")
    for summary in summaries:
        table.add_row(*_row(summary))
    console.print(table)
    console.print(f"{len(records)} rows in {out}: {FACTS['what']}", markup=False)


def _row(summary: SlotSummary) -> tuple[str, ...]:
    same = summary.same_winner
    return (
        summary.slot,
        str(summary.decisions),
        str(summary.asked),
        _percent(summary.elected),
        _percent(same.agreement if same else None),
        f"{100 * same.chance:.0f} %" if same else "–",
        _percent(summary.position),
        _percent(summary.letter),
        _percent(summary.first, signed=True),
        _percent(summary.first_letter, signed=True),
    )


def _percent(interval: Interval | None, *, signed: bool = False) -> str:
    if interval is None or not interval.n or math.isnan(interval.estimate):
        return "–"
    value = f"{100 * interval.estimate:+.0f}" if signed else f"{100 * interval.estimate:.0f}"
    return f"{value} % ({100 * interval.low:.0f} to {100 * interval.high:.0f})"


def _plain(summary: SlotSummary) -> dict[str, Any]:
    same = summary.same_winner
    return {
        "slot": summary.slot,
        "questions": summary.decisions,
        "presentations": summary.asked,
        "elected": _stated(summary.elected),
        "same_winner": _stated(same.agreement if same else None),
        "chance": same.chance if same else None,
        "position_consistency": _stated(summary.position),
        "letter_consistency": _stated(summary.letter),
        "first_excess": _stated(summary.first),
        "letter_a_excess": _stated(summary.first_letter),
    }


def _stated(interval: Interval | None) -> dict[str, float | int] | None:
    if interval is None or not interval.n:
        return None
    return {
        "value": interval.estimate,
        "low": interval.low,
        "high": interval.high,
        "n": interval.n,
    }
