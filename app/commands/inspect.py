"""`c2nav inspect`: the inspector on a source, on traces, or on a folder of one or more runs."""

from __future__ import annotations

import socket
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro
from rich.console import Console

from app.commands.heaps import share_heaps
from app.commands.importing import uncollected
from app.commands.options import (
    ConnectivityOpt,
    GroundTruthOpt,
    HeadingsOpt,
    RankerOptions,
    ScenesOpt,
    connectivity_folder,
    key_values,
)
from app.commands.what import folder_of_runs, trace_files, traces_under
from app.gateway.alone import listen
from app.gateway.front import Address, serve, tunnel_line
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.rankers import DEFAULT_RANKER
from c2nav_engine.experiments.spec import Setting

if TYPE_CHECKING:
    from starlette.applications import Starlette

    from app.session.first_page import FirstPage


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
    share_heaps()
    listener = listen(host, port)
    if root is not None and not traces:
        traces = _first_traces(root, scenes, listener, host=host)
        if not traces:
            return 0

    def load(first_page: FirstPage) -> AbstractContextManager[Starlette]:
        # Most of the start: a browser reads the page meanwhile.
        with uncollected():
            from app.commands.inspected import inspected

        return inspected(
            traces,
            setting,
            first_page,
            root=root,
            beside=with_,
            connectivity=graphs,
            blind=blind,
        )

    serve(
        load,
        listener,
        host=host,
        ready=_tell if root is None else _tell_run,
        first="" if root is None else "run",
        no_browser=no_browser,
    )
    return 0


def _first_traces(
    root: Path, scenes: Path | None, listener: socket.socket, *, host: str
) -> tuple[Path, ...]:
    """Serve what can be told of a run until a trace is finished; () where nobody waited so long."""
    from app.commands.run_folders import pages_of
    from app.gateway.runs import serve_runs

    serve_runs(
        pages_of(root, scenes),
        listener,
        host=host,
        ready=_tell_pages,
        over=lambda: bool(traces_under(root)),
    )
    return traces_under(root)


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
