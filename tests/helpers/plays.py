"""The play of `stage` as traces: a recording, and a fork of it."""

from __future__ import annotations

import functools
from dataclasses import replace
from pathlib import Path
from typing import Any

from app.session.opened import ForkAt
from app.session.story import Story, story_of
from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.runner.exchange import Override
from c2nav_engine.runner.recorded import Trace
from tests.helpers.stage import PlayRun, finished_run, fork_of

ROOT_SHA = "a" * 64
FORK_SHA = "b" * 64


def as_trace(run: PlayRun, sha256: str, **header: Any) -> Trace:
    """A finished run as if it had been read from disk."""
    assert run.footer is not None
    return Trace(
        header=replace(run.header, **header),
        exchanges=tuple(run.exchanges),
        footer=run.footer,
        sha256=sha256,
        complete=True,
        path=Path(f"{sha256[:4]}.mcap"),
    )


@functools.cache
def recording(**header: Any) -> Trace:
    """The play to its end."""
    return as_trace(finished_run(), ROOT_SHA, **header)


@functools.cache
def fork(decision: int = 6) -> Trace:
    """Another answer at a Seeing decision, then on."""
    parent = recording()
    override = Override(Ordering.of("left", "front"), "person 1")
    run = fork_of(ForkAt(parent.header, parent.exchanges, decision, override))
    while run.pending is not None:
        run.advance()
    return as_trace(run, FORK_SHA, parent_sha256=ROOT_SHA, fork_decision=decision)


def story(trace: Trace) -> Story:
    """A trace, read."""
    return story_of(trace.header, trace.exchanges, pending=None, footer=trace.footer)
