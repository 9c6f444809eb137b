"""`c2nav turning`: which single answer would have led to success?"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console

from app.commands.options import JsonOpt, RankerOptions, ScenesOpt, key_values
from app.commands.output import check_file, print_json
from app.commands.what import trace_files
from app.session.wording import plural
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.turning.flips import (
    Budget,
    Trial,
    expected_queries,
    flips_of,
    trials_of,
)
from c2nav_engine.experiments.turning.moments import Recording, recording_of
from c2nav_engine.experiments.turning.recoverable import last_recoverable
from c2nav_engine.experiments.turning.regrets import regrets_of
from c2nav_engine.experiments.turning.same_ranker import Continuing, continuing
from c2nav_engine.experiments.turning.summary import verdict_of
from c2nav_engine.experiments.turning.table import (
    FLIP,
    RECOVERABLE,
    Row,
    flip_row,
    flips_in,
    goes_on,
    read_table,
    recoverable_row,
    regret_rows,
    write_table,
)
from c2nav_engine.runner.recorded import read_trace


def turning(
    what: Annotated[tuple[str, ...], tyro.conf.Positional, tyro.conf.arg(metavar="TRACE…|RUN")],
    out: Annotated[Path, tyro.conf.arg(metavar="FILE.parquet")],
    scenes: ScenesOpt = None,
    ranker: Annotated[
        str, tyro.conf.arg(help="Who goes on; by default the recording's own ranker.")
    ] = "",
    ranker_opt: RankerOptions = (),
    suspects: Annotated[int, tyro.conf.arg(help="Decisions to change, worst first.")] = 5,
    repeats: Annotated[int, tyro.conf.arg(help="Runs of each changed and control decision.")] = 3,
    max_queries: Annotated[int | None, tyro.conf.arg(help="Queries to spend an episode.")] = None,
    json: JsonOpt = False,
) -> int:
    """Fork the worst decisions of failed episodes into their other answers; resumes its table."""
    _check(suspects, repeats)
    paths = trace_files(what)
    check_file(out, *paths)
    rows = read_table(out)
    console = Console(stderr=True, highlight=False)
    options = key_values(ranker_opt)
    verdicts: dict[str, str] = {}
    for path in paths:
        trace = read_trace(path)
        if trace.footer.metrics.get("success") == 1:
            continue
        on = continuing(trace.header, ranker, options)
        recording = recording_of(trace, scenes=scenes)
        rows, trials = _measured(recording, rows, suspects)
        write_table(rows, out)
        left = _left(rows, recording, trials, (on, repeats, out))
        cost = expected_queries(recording, left, repeats=repeats)
        decisions = len({trial.decision for trial in left})
        console.print(
            f"{path.name}: {plural(len(left), 'answer')} to try at {plural(decisions, 'decision')}"
            f", about {plural(cost, 'query')}",
            markup=False,
        )
        budget = Budget(repeats, max_queries)
        for flip in flips_of(recording, left, on.seat_for, budget=budget):
            rows.append(flip_row(recording, flip, on))
            write_table(rows, out)
        verdicts[path.name] = verdict_of(_of(rows, recording))
    _tell(verdicts, out, json=json)
    return 0


def _check(suspects: int, repeats: int) -> None:
    if suspects < 0 or repeats < 1:
        message = (
            f"expected 0 or more suspects and 1 or more repeats, came {suspects} and {repeats}"
        )
        raise UsageError(message)


def _measured(
    recording: Recording, rows: list[Row], suspects: int
) -> tuple[list[Row], list[Trial]]:
    """Rows with (a) as of this call and (b) measured once, and what (c) is to try."""
    regrets = regrets_of(recording)
    trials = trials_of(recording, regrets, suspects=suspects)
    mine = _of(rows, recording)
    known = [row for row in mine if row["part"] == RECOVERABLE]
    found = known or [recoverable_row(recording, last_recoverable(recording))]
    others = [row for row in rows if row["trace_sha256"] != recording.trace_sha256]
    tried = [row for row in mine if row["part"] == FLIP]
    return [*others, *regret_rows(recording, regrets, trials), *found, *tried], trials


def _left(
    rows: list[Row], recording: Recording, trials: list[Trial], how: tuple[Continuing, int, Path]
) -> list[Trial]:
    """Trials that no earlier call made; raises `UsageError` where one made them otherwise."""
    on, repeats, out = how
    mine = flips_in(rows, recording.trace_sha256)
    alike = flips_in(rows, recording.trace_sha256, goes_on=goes_on(on), repeats=repeats)
    if len(mine) != len(alike):
        message = (
            f"expected earlier rows of {goes_on(on)} with {repeats} repeats in {out}, came others "
            "for the same trace; name another --out"
        )
        raise UsageError(message)
    tried = {(flip.decision, flip.answer) for flip in alike}
    return [trial for trial in trials if (trial.decision, trial.answer) not in tried]


def _of(rows: list[Row], recording: Recording) -> list[Row]:
    return [row for row in rows if row["trace_sha256"] == recording.trace_sha256]


def _tell(verdicts: dict[str, str], out: Path, *, json: bool) -> None:
    if json:
        print_json({"table": str(out), "episodes": verdicts})
        return
    console = Console(highlight=False)
    for name, verdict in verdicts.items():
        console.print(f"{name}: {verdict}", markup=False)
    console.print(f"{plural(len(verdicts), 'failed episode')}, {out}", markup=False)
