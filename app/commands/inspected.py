"""The inspector that `inspect` serves: what was named, opened."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from starlette.applications import Starlette

from app.commands.run_folders import pages_of, with_later_traces
from app.commands.sources import opened_source, opened_traces
from app.gateway.serving import inspector
from app.session.first_page import FirstPage
from c2nav_engine.experiments.spec import Setting


@contextmanager
def inspected(
    traces: Sequence[Path],
    setting: Setting,
    first_page: FirstPage,
    *,
    root: Path | None,
    beside: Sequence[Path],
    connectivity: Path | None,
    blind: bool,
) -> Generator[Starlette]:
    """The inspector for as long as the context lasts.

    Args:
        traces: What to show; none for live episodes of the setting's source.
        setting: What is asked, by whom, and where scenes lie.
        first_page: What the first page waits for.
        root: The folder of runs that the traces lie in, if one was named.
        beside: Re-evaluations whose answers stand beside the recorded ones.
        connectivity: Folder of the scans' connectivity graphs, for the map.
        blind: Start with answers covered.

    Raises:
        C2NavError: Something that was named cannot be read.
    """
    opened = (
        opened_traces(traces, setting, beside=beside, connectivity=connectivity)
        if traces
        else opened_source(setting, connectivity=connectivity)
    )
    opened = replace(opened, blind=blind)
    runs = None
    if root is not None:
        opened = with_later_traces(opened, root, setting, connectivity=connectivity)
        runs = pages_of(root, Path(setting.scenes) if setting.scenes else None)
    with inspector(opened, first_page, runs=runs, beside=beside) as app:
        yield app
