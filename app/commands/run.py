"""`c2nav run`: episodes × variants × seeds into a run folder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import tyro
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.table import Table

from app.commands.options import (
    EpisodesOpt,
    JsonOpt,
    RankerOptions,
    ScenesOpt,
    SourceArg,
    ids,
    key_values,
    whole_numbers,
    words,
)
from app.commands.output import print_json
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.batch import run_batch
from c2nav_engine.experiments.columns import Row
from c2nav_engine.experiments.local import LocalExecutor
from c2nav_engine.experiments.rankers import DEFAULT_RANKER, RANKERS
from c2nav_engine.experiments.spec import RunSpec, Setting
from c2nav_engine.experiments.summary import summarise
from c2nav_engine.experiments.working import Finished, source_of
from c2nav_engine.navigator.variants import preset

MOST_ROWS = 40
"""Longer tables are left to the files."""


def run(
    source: SourceArg,
    out: Annotated[Path, tyro.conf.arg(metavar="RUN", help="Folder for traces and tables.")],
    scenes: ScenesOpt = None,
    variants: Annotated[str, tyro.conf.arg(metavar="NAMES", help="Comma-separated.")] = "full",
    ranker: str = DEFAULT_RANKER,
    ranker_opt: RankerOptions = (),
    episodes: EpisodesOpt = "",
    seeds: Annotated[str, tyro.conf.arg(metavar="N,N", help="Run seeds.")] = "0",
    profile: Annotated[str, tyro.conf.arg(help="Embodiment profile.")] = "vlnce",
    headings: Annotated[Path | None, tyro.conf.arg(metavar="FILE")] = None,
    ground_truth: Annotated[Path | None, tyro.conf.arg(metavar="FILE")] = None,
    workers: Annotated[int, tyro.conf.arg(help="Processes.")] = 1,
    odometry_noise: Annotated[
        float, tyro.conf.arg(help="Deviation of steps and turns, as a fraction of them.")
    ] = 0.0,
    depth_noise: Annotated[
        float, tyro.conf.arg(help="Deviation of depths, as a fraction of them.")
    ] = 0.0,
    sliding: Annotated[bool, tyro.conf.arg(help="Whether blocked moves slide.")] = True,
    resume: Annotated[bool, tyro.conf.arg(help="Finish what is missing.")] = False,
    json: JsonOpt = False,
) -> int:
    """Run episodes and write traces, `episodes.csv` and `summary.json`."""
    setting = Setting(
        source=source if source == "builtin" else str(Path(source).resolve()),
        scenes=str(scenes.resolve()) if scenes else "",
        headings=str(headings.resolve()) if headings else "",
        ground_truth=str(ground_truth.resolve()) if ground_truth else "",
        profile=profile,
        ranker=ranker,
        ranker_options=key_values(ranker_opt),
        odometry_noise=odometry_noise,
        depth_noise=depth_noise,
        sliding=sliding,
    )
    spec = spec_of(setting, variants=variants, episodes=episodes, seeds=seeds)
    rows = _run(spec, out, LocalExecutor(workers), resume=resume, quiet=json)
    if json:
        print_json({"run": str(out), **summarise(rows)})
    else:
        _tell(rows)
    return 1 if any(row["outcome"] == "error" for row in rows) else 0


def spec_of(setting: Setting, *, variants: str, episodes: str, seeds: str) -> RunSpec:
    """The run that the words of a command line describe; raises `InputError`."""
    setting.check()
    if RANKERS[setting.ranker].interactive:
        message = f"the ranker {setting.ranker} needs the inspector; use `c2nav inspect`"
        raise UsageError(message)
    names = words(variants)
    for name in names:
        preset(name)
    source = source_of(setting)
    chosen = source.chosen(ids(episodes))
    source.require_scenes(chosen)
    return RunSpec(
        setting=setting,
        episodes=tuple(episode.episode_id for episode in chosen),
        variants=names,
        seeds=whole_numbers(seeds, "seeds"),
    )


def _run(
    spec: RunSpec, out: Path, executor: LocalExecutor, *, resume: bool, quiet: bool
) -> list[Row]:
    columns = (
        TextColumn("episodes"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[so_far]}"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), disable=quiet) as progress:
        bar = progress.add_task("", total=None, so_far="")
        successes: list[int] = []

        def tell(finished: Finished, done: int, total: int) -> None:
            successes.append(int(finished.row.get("success") or 0))
            share = sum(successes) / len(successes)
            progress.update(bar, completed=done, total=total, so_far=f"SR {share:.0%}")

        return run_batch(spec, out, executor, resume=resume, progress=tell)


def _tell(rows: Sequence[Row]) -> None:
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
