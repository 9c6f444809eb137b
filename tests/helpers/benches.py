"""A place to open episodes at: real worlds, real traces, any ranker."""

from __future__ import annotations

from pathlib import Path

from c2nav_engine.episodes.profile import VLNCE, Profile
from c2nav_engine.experiments.rankers import seats_for
from c2nav_engine.runner.opening import Workbench
from c2nav_engine.runner.recording import TraceWriter
from c2nav_engine.runner.source import Source, open_source
from c2nav_engine.runner.worlds import Worlds, WorldsConfig


def workbench(
    source: Source | None = None,
    *,
    ranker: str = "random",
    profile: Profile = VLNCE,
    cache: Path | None = None,
) -> Workbench:
    """The built-in houses unless told otherwise, traces written where an opening names a file."""
    source = source or open_source("builtin")
    return Workbench(
        source=source,
        worlds=Worlds(source, WorldsConfig(profile, cache=cache)),
        profile=profile,
        seat_for=seats_for(ranker),
        recorder_for=TraceWriter,
    )
