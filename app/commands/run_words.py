"""What `c2nav run` says to people: how far it is, and what came out."""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.table import Table
from rich.text import Text

from c2nav_engine.experiments.batch import Progress as Tell
from c2nav_engine.experiments.batch import Standing
from c2nav_engine.experiments.columns import Row
from c2nav_engine.experiments.summary import summarise

MOST_ROWS = 40
"""Longer tables are left to the files."""
MOST_ERRORS = 5
"""Failed tasks that are told; the ledger holds all."""


class _Rate(ProgressColumn):
    """Episodes a minute."""

    def render(self, task: Task) -> Text:
        speed = task.finished_speed or task.speed
        return Text("" if speed is None else f"{60 * speed:.1f}/min")


@contextmanager
def progress_bar(*, quiet: bool) -> Generator[Tell]:
    """A bar with rate, time left, success so far, tokens and cost; on standard error."""
    columns = (
        TextColumn("episodes"),
        BarColumn(),
        MofNCompleteColumn(),
        _Rate(),
        TextColumn("{task.fields[so_far]}"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), disable=quiet) as progress:
        bar = progress.add_task("", total=None, so_far="")

        def tell(standing: Standing) -> None:
            progress.update(
                bar, completed=standing.done, total=standing.total, so_far=so_far(standing)
            )

        yield tell


def so_far(standing: Standing) -> str:
    """Success, failures, tokens and cost so far, as far as they are known."""
    if not standing.done:
        return ""
    parts = [f"SR {standing.successes / standing.done:.0%}"]
    if standing.failed:
        parts.append(f"{standing.failed} failed")
    if standing.tokens is not None:
        parts.append(f"{standing.tokens:,.0f} tokens")
    if standing.cost_usd is not None:
        parts.append(f"{standing.cost_usd:.2f} USD")
    return " · ".join(parts)


def tell_rows(rows: Sequence[Row]) -> None:
    """The table of episodes, then one line per variant."""
    console = Console()
    table = Table(box=None, header_style="bold")
    for name in ("episode", "variant", "outcome", "NE m", "OSR", "SR", "SPL", "nDTW", "steps"):
        table.add_column(
            name, justify="left" if name in {"episode", "variant", "outcome"} else "right"
        )
    shown = rows if len(rows) <= MOST_ROWS else ()
    for row in shown:
        table.add_row(
            str(row["episode_id"]),
            str(row["variant"]),
            str(row["outcome"]),
            *(_cell(row.get(name)) for name in ("ne_m", "os", "success", "spl", "ndtw", "steps")),
        )
    if shown:
        console.print(table)
    for group in summarise(rows)["groups"]:
        console.print(_group_line(group))


def error_lines(errors: Mapping[str, str]) -> list[str]:
    """The first failed tasks with the first line of why, and how many more there are."""
    lines = [f"{name}: {(text.splitlines() or [''])[0]}" for name, text in errors.items()]
    more = len(lines) - MOST_ERRORS
    return lines[:MOST_ERRORS] + ([f"… and {more} more"] if more > 0 else [])


def _group_line(group: Mapping[str, Any]) -> str:
    """One variant's rates with their intervals, for people: percent on the screen only."""

    def percent(name: str) -> str:
        entry = group[name]
        if entry is None:
            return "–"
        return f"{100 * entry['value']:.1f} % ({100 * entry['low']:.0f}–{100 * entry['high']:.0f})"

    error = group["ne_m"]
    parts = [
        f"NE {error['value']:.2f} m" if error else "NE –",
        f"OSR {percent('osr')}",
        f"SR {percent('sr')}",
        f"SPL {100 * group['spl']['value']:.1f} %" if group["spl"] else "SPL –",
    ]
    head = f"{group['variant']} · {group['ranker']} · {group['n']} episodes: "
    return head + " · ".join(parts)


def _cell(value: str | float | None) -> str:
    if value is None:
        return "–"
    return f"{value:.2f}" if isinstance(value, float) else str(value)
