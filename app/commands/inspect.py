"""`c2nav inspect`: the inspector on a source, on traces, or on a folder of one or more runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console

from app.commands.options import (
    ConnectivityOpt,
    GroundTruthOpt,
    HeadingsOpt,
    RankerOptions,
    ScenesOpt,
    connectivity_folder,
    key_values,
)
from app.commands.run_folders import folder_of_runs, pages_of, traces_under, with_later_traces
from app.commands.sources import opened_source, opened_traces, trace_files
from app.gateway.alone import listen
from app.gateway.runs import serve_runs
from app.gateway.serving import Address, serve, tunnel_line
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.rankers import DEFAULT_RANKER
from c2nav_engine.experiments.spec import Setting


def inspect(
    what: Annotated[
        tuple[str, ...],
        tyro.conf.Positional,
        tyro.conf.arg(metavar="SOURCE|TRACE…|RUN|RUNS", help="`builtin` by default."),
    ] = ("builtin",),
    scenes: ScenesOpt = None,
    with_: Annotated[
        tuple[Path, ...],
        tyro.conf.UseAppendAction,
        tyro.conf.arg(
            name="with",
            metavar="REEVAL.parquet",
            help="Answers of `c2nav reeval` beside the recorded ones; repeat for more.",
        ),
    ] = (),
    blind: Annotated[
        bool, tyro.conf.arg(help="Start with answers covered; V shows one, and that is kept.")
    ] = False,
    ranker: str = DEFAULT_RANKER,
    ranker_opt: RankerOptions = (),
    profile: str = "vlnce",
    headings: HeadingsOpt = None,
    ground_truth: GroundTruthOpt = None,
    connectivity: ConnectivityOpt = None,
    host: Annotated[str, tyro.conf.arg(help="Address to bind.")] = "127.0.0.1",
    port: Annotated[int, tyro.conf.arg(help="Port to bind; 0 takes a free one.")] = 8080,
    no_browser: Annotated[bool, tyro.conf.arg(help="Do not open a browser.")] = False,
) -> int:
    """Open the inspector; it stands at the first pending decision."""
    root = folder_of_runs(what)
    traces = trace_files(what) if root is None else traces_under(root)
    setting = Setting(
        source="builtin" if traces or root else what[0],
        scenes=str(scenes) if scenes else "",
        headings=str(headings) if headings else "",
        ground_truth=str(ground_truth) if ground_truth else "",
        profile=profile,
        ranker=ranker,
        ranker_options=key_values(ranker_opt),
    )
    setting.check()
    if with_ and not traces:
        message = f"expected traces or a run folder beside --with, came {' '.join(what)}"
        raise UsageError(message)
    if (headings or ground_truth) and (traces or root):
        message = "expected --headings and --ground-truth beside a source: recordings keep theirs"
        raise UsageError(message)
    graphs = connectivity_folder(connectivity, scenes)
    listener = listen(host, port)
    if root is not None and not traces:
        # Nothing can be stepped yet, but how far the run is can be told.
        serve_runs(
            pages_of(root, scenes),
            listener,
            host=host,
            ready=_tell_pages,
            over=lambda: bool(traces_under(root)),
        )
        traces = traces_under(root)
        if not traces:
            return 0
    opened = (
        opened_traces(traces, setting, beside=with_, connectivity=graphs)
        if traces
        else opened_source(setting, connectivity=graphs)
    )
    opened = replace(opened, blind=blind)
    runs = None
    if root is not None:
        opened = with_later_traces(opened, root, setting, connectivity=graphs)
        runs = pages_of(root, scenes)
    ready = _tell if runs is None else _tell_run
    serve(
        opened,
        listener,
        host=host,
        no_browser=no_browser,
        ready=ready,
        runs=runs,
        beside=with_,
    )
    return 0


def _tell_pages(url: str) -> None:
    words = "no trace is finished yet; the inspector follows at the first"
    Console(highlight=False).print(f"run at {url}run; {words}", markup=False, soft_wrap=True)


def _tell_run(address: Address) -> None:
    Console(highlight=False).print(f"run at {address.url}run", markup=False)
    _tell(address)


def _tell(address: Address) -> None:
    console = Console(highlight=False)
    console.print(f"inspector at {address.url}")
    tunnel = tunnel_line(address)
    if tunnel:
        console.print(f"from another machine: {tunnel}", markup=False)
