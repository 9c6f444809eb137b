"""`c2nav replay`: drive the engine with what was recorded and name the first difference."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console

from app.commands.options import JsonOpt, ScenesOpt
from app.commands.output import print_json
from c2nav_engine.runner.recorded import Trace, read_trace
from c2nav_engine.runner.replaying import replay as drive
from c2nav_engine.runner.reshell import shell_of

TraceArg = Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="TRACE")]


def replay(trace: TraceArg, scenes: ScenesOpt = None, json: JsonOpt = False) -> int:
    """Replay a trace; with --scenes its pictures are rendered again and compared too."""
    read = read_trace(trace)
    shell = shell_of(read.header, scenes=scenes) if scenes is not None else None
    divergence = drive(read.header, read.exchanges, read.footer, shell=shell)
    if json:
        print_json(_facts(read, str(divergence or ""), rendered=shell is not None))
    elif divergence is not None:
        Console(stderr=True).print(str(divergence), markup=False, highlight=False)
    else:
        how = "with the scene" if shell is not None else "without the scene"
        Console().print(f"reproduced {how}: {_count(read)} decisions", highlight=False)
    return 0 if divergence is None else 1


def _count(trace: Trace) -> int:
    return sum(exchange.decision is not None for exchange in trace.exchanges)


def _facts(trace: Trace, divergence: str, *, rendered: bool) -> dict[str, object]:
    return {
        "trace_sha256": trace.sha256,
        "decisions": _count(trace),
        "reproduced": not divergence,
        "divergence": divergence,
        "rendered": rendered,
    }
