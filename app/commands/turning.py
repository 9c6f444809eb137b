"""`c2nav turning`: which single answer would have led to success?"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console

from app.commands.options import JsonOpt, RankerOptions, ScenesOpt, key_values
from app.commands.output import print_json
from app.commands.sources import trace_files
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.rankers import RANKERS, seats_for
from c2nav_engine.experiments.turning.flips import Budget, flips_of
from c2nav_engine.experiments.turning.moments import Recording, recording_of
from c2nav_engine.experiments.turning.recoverable import last_recoverable
from c2nav_engine.experiments.turning.regrets import Regret, regrets_of
from c2nav_engine.experiments.turning.table import (
    Row,
    flip_row,
    read_table,
    recoverable_row,
    regret_row,
    verdict_of,
    write_table,
)
from c2nav_engine.runner.opening import SeatFor
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
    rows = read_table(out)
    console = Console(stderr=True, highlight=False)
    verdicts: dict[str, str] = {}
    for path in trace_files(what):
        trace = read_trace(path)
        if trace.footer.metrics.get("success") == 1:
            continue
        recording = recording_of(trace, scenes=scenes)
        seat_for = _seats(recording, ranker, key_values(ranker_opt))
        regrets = _first_parts(recording, rows, out)
        worst = [regret.decision for regret in sorted(regrets, key=_weight)[:suspects]]
        cost = _expected_queries(recording, worst, repeats)
        console.print(f"{path.name}: about {cost} queries for {len(worst)} decisions")
        tried = {(row["trace_sha256"], row["decision"], row["answer"]) for row in rows}
        budget = Budget(repeats, max_queries)
        for flip in flips_of(
            recording,
            worst,
            seat_for,
            budget=budget,
            known=lambda decision, answer, sha=trace.sha256, tried=tried: (
                (sha, decision, answer) in tried
            ),
        ):
            rows.append(flip_row(recording, flip))
            write_table(rows, out)
        mine = [row for row in rows if row["trace_sha256"] == trace.sha256]
        verdicts[path.name] = verdict_of(mine)
    _tell(verdicts, out, json=json)
    return 0


def _seats(recording: Recording, ranker: str, options: dict[str, str]) -> SeatFor:
    """The ranker that goes on: the one named, else the one that the recording names."""
    name = ranker or next((n for n in RANKERS if recording.header.ranker.startswith(n)), "")
    if not name or RANKERS[name].interactive:
        message = (
            f"expected a ranker to go on with, came a recording by {recording.header.ranker!r}; "
            "name one with --ranker"
        )
        raise UsageError(message)
    return seats_for(name, options or recording.header.ranker_options)


def _first_parts(recording: Recording, rows: list[Row], out: Path) -> list[Regret]:
    """(a) and (b), written once a trace."""
    regrets = regrets_of(recording)
    done = any(
        row["trace_sha256"] == recording.trace_sha256 and row["part"] == "recoverable"
        for row in rows
    )
    if not done:
        rows += [regret_row(recording, regret) for regret in regrets]
        rows.append(recoverable_row(recording, last_recoverable(recording)))
        write_table(rows, out)
    return regrets


def _weight(regret: Regret) -> tuple[float, int]:
    return regret.weight


def _expected_queries(recording: Recording, decisions: list[int], repeats: int) -> int:
    """Queries of the recording after each decision, for its control and two other answers."""
    total = 0
    for number in decisions:
        after = [e for e in recording.questions if (e.decision or 0) > number]
        total += sum(len(e.ranked.queries) for e in after if e.ranked)
    return total * repeats * 3


def _tell(verdicts: dict[str, str], out: Path, *, json: bool) -> None:
    if json:
        print_json({"table": str(out), "episodes": verdicts})
        return
    console = Console(highlight=False)
    for name, verdict in verdicts.items():
        console.print(f"{name}: {verdict}", markup=False)
    console.print(f"{len(verdicts)} failed episodes, {out}")
