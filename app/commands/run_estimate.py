"""`c2nav run --dry-run`: what a run would take, in words and as JSON."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

from rich.console import Console
from rich.table import Table

from app.commands.output import print_json
from c2nav_engine.errors import SceneError
from c2nav_engine.experiments.columns import read_rows
from c2nav_engine.experiments.dry_run import Estimate, Share, estimate
from c2nav_engine.experiments.spec import RunSpec
from c2nav_engine.experiments.working import source_of


def tell_estimate(spec: RunSpec, out: Path, *, workers: int, json: bool) -> int:
    """Print the estimate of a run; always 0, because nothing was run."""
    rows = read_rows(out) if (out / "episodes.parquet").is_file() else []
    found = estimate(spec, workers=workers, rows=rows)
    missing = missing_scenes(spec)
    if json:
        print_json(_plain(found, missing))
        return 0
    console = Console(highlight=False)
    console.print(_table(found))
    console.print(
        f"{found.tasks:,} episodes to run, {found.rows:,} rows · {_many(found.queries)} queries · "
        f"{_many(found.tokens_in)} tokens in, {_many(found.tokens_out)} out · "
        f"{_cost(found.cost_usd)}",
        markup=False,
    )
    console.print(
        f"about {duration(found.time_s)} with {found.workers} workers"
        + (f" and {found.lanes} queries at once in each" if found.lanes > 1 else "")
        + f" · {found.trace_gb:.1f} GB of traces",
        markup=False,
    )
    console.print(f"pictures go to {found.host or 'nobody: they stay on this machine'}")
    if missing:
        console.print(f"{len(missing)} scenes are not there yet, {missing[0]} for one")
    for note in found.notes:
        console.print(f"reckoned from: {note}", markup=False, style="dim")
    return 0


def missing_scenes(spec: RunSpec) -> list[str]:
    """Scene ids whose files are not to be found."""
    source = source_of(spec.setting)
    missing: list[str] = []
    for scene_id in dict.fromkeys(spec.scenes):
        try:
            source.scene_file(scene_id)
        except SceneError:
            missing.append(scene_id)
    return missing


def duration(seconds: float) -> str:
    """Two units at most: "3 h 20 min"."""
    minutes = round(seconds / 60.0)
    if minutes < 1:
        return f"{seconds:.0f} s"
    if minutes < 60:
        return f"{minutes} min"
    hours, rest = divmod(minutes, 60)
    return f"{hours} h {rest} min" if hours < 48 else f"{hours / 24.0:.1f} days"


def _table(found: Estimate) -> Table:
    table = Table(box=None, header_style="bold")
    table.add_column("variant")
    for head in ("episodes", "queries", "tokens in", "tokens out", "cores", "waiting", ""):
        table.add_column(head, justify="right", no_wrap=True)
    for share in found.shares:
        table.add_row(*_row(share))
    return table


def _row(share: Share) -> tuple[str, ...]:
    return (
        " = ".join(share.variants),
        f"{share.tasks:,}",
        _many(share.queries),
        _many(share.tokens_in),
        _many(share.tokens_out),
        duration(share.core_s),
        duration(share.wait_s),
        "measured here" if share.measured_here else "",
    )


def _many(value: float | None) -> str:
    if value is None:
        return "–"
    for size, unit in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if value >= 10 * size or (unit != "k" and value >= size):
            return f"{value / size:.1f} {unit}"
    return f"{value:,.0f}"


def _cost(cost_usd: float | None) -> str:
    return "no known price" if cost_usd is None else f"{cost_usd:,.2f} USD at list prices"


def _plain(found: Estimate, missing: list[str]) -> dict[str, object]:
    return {
        "dry_run": True,
        "tasks": found.tasks,
        "rows": found.rows,
        "queries": round(found.queries),
        "tokens_in": None if found.tokens_in is None else round(found.tokens_in),
        "tokens_out": None if found.tokens_out is None else round(found.tokens_out),
        "cost_usd": found.cost_usd,
        "time_s": round(found.time_s, 1),
        "workers": found.workers,
        "queries_at_once": found.workers * found.lanes,
        "trace_gb": round(found.trace_gb, 2),
        "hosts": [found.host] if found.host else [],
        "missing_scenes": missing,
        "variants": [asdict(share) for share in found.shares],
        "notes": list(found.notes),
    }
