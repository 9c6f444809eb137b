"""`c2nav trace info|check|recover|export`: reading, judging, saving and converting traces."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console

from app.commands.exporting import export
from app.commands.options import JsonOpt
from app.commands.output import check_file, print_json
from c2nav_engine.errors import UsageError
from c2nav_engine.runner.recorded import open_trace
from c2nav_engine.traces.check import check as faults_of
from c2nav_engine.traces.recover import recover as salvage

MOST_FAULTS = 20
"""Faults of one trace that are told to a person."""

TracesArg = Annotated[tuple[Path, ...], tyro.conf.Positional, tyro.conf.arg(metavar="TRACE…")]


def info(traces: TracesArg, json: JsonOpt = False) -> int:
    """What traces hold: episode, variant, ranker, outcome, topics, size."""
    _some(traces)
    found: list[dict[str, object]] = []
    for path in traces:
        with open_trace(path) as trace:
            found.append(
                {
                    "trace": str(path),
                    "sha256": trace.sha256,
                    "bytes": trace.file.size_bytes,
                    "decisions": trace.decision_count,
                    **dict(trace.file.facts),
                }
            )
    if json:
        print_json({"traces": found})
        return 0
    console = Console(highlight=False)
    for facts in found:
        for name, value in facts.items():
            if value != "":
                console.print(f"{name:16} {value}", markup=False, soft_wrap=True)
        console.print()
    return 0


def check(traces: TracesArg, json: JsonOpt = False) -> int:
    """Verify checksums, numbering, pictures and schema of traces."""
    _some(traces)
    found = {str(path): [str(fault) for fault in faults_of(path)] for path in traces}
    if json:
        print_json({"faults": found})
    else:
        console = Console(highlight=False)
        for path, faults in found.items():
            verdict = "holds" if not faults else f"{len(faults)} faults"
            console.print(f"{path}: {verdict}", markup=False, soft_wrap=True)
            for line in first_of(faults):
                console.print(f"  {line}", markup=False, soft_wrap=True)
    return 1 if any(found.values()) else 0


def _some(traces: Sequence[Path]) -> None:
    if not traces:
        message = "expected one or more traces, came none; name the files"
        raise UsageError(message)


def first_of(faults: Sequence[str]) -> list[str]:
    """The first faults, and how many more there are; --json has all."""
    more = len(faults) - MOST_FAULTS
    return [*faults[:MOST_FAULTS], *([f"… and {more} more"] if more > 0 else [])]


def recover(
    trace: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="TRACE")],
    out: Annotated[Path, tyro.conf.arg(metavar="TRACE", help="Where the intact part goes.")],
    json: JsonOpt = False,
) -> int:
    """Save what is intact of an unfinished or damaged trace."""
    check_file(out, trace)
    saved = salvage(trace, out)
    if json:
        print_json({"trace": str(out), "saved": str(saved)})
    else:
        Console(highlight=False).print(f"{out}: {saved}", markup=False, soft_wrap=True)
    return 0


trace = {"info": info, "check": check, "recover": recover, "export": export}
"""Subcommands of `c2nav trace`."""
