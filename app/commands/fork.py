"""`c2nav fork`: another answer at one decision of a trace, then on."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console

from app.commands.options import JsonOpt, RankerOptions, ScenesOpt, key_values
from app.commands.output import check_file, print_json
from c2nav_engine.contract.answers import parse
from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.contract.render import render
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.rankers import DEFAULT_RANKER, check_unattended, seats_for
from c2nav_engine.navigator.config import LoopConfig
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.episode_run import run_to_end
from c2nav_engine.runner.exchange import Exchange, Override
from c2nav_engine.runner.opening import OpenSpec, Workbench
from c2nav_engine.runner.recorded import read_trace
from c2nav_engine.runner.recording import TraceWriter
from c2nav_engine.runner.reshell import source_of_record
from c2nav_engine.runner.worlds import Worlds, WorldsConfig


def fork(
    trace: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="TRACE")],
    at: Annotated[int, tyro.conf.arg(metavar="K", help="Decision number, from 0.")],
    ranking: Annotated[
        str, tyro.conf.arg(help="By the labels as first shown, or by view names: 'B > A > C'.")
    ],
    out: Annotated[Path, tyro.conf.arg(metavar="TRACE")],
    ranker: str = DEFAULT_RANKER,
    ranker_opt: RankerOptions = (),
    scenes: ScenesOpt = None,
    json: JsonOpt = False,
) -> int:
    """Run a trace again up to a decision, answer it otherwise, and go on (needs the scene)."""
    check_unattended(ranker)
    check_file(out, trace)
    parent = read_trace(trace)
    decision = next((e for e in parent.exchanges if e.decision == at), None)
    override = Override(_ordering(decision, ranking, at), "command line", when_s=time.time())
    source = source_of_record(parent.header, scenes)
    bench = Workbench(
        source=source,
        worlds=Worlds(source, WorldsConfig(parent.header.profile)),
        profile=parent.header.profile,
        seat_for=seats_for(ranker, key_values(ranker_opt)),
        recorder_for=TraceWriter,
    )
    spec = OpenSpec(
        parent.header.episode.episode_id,
        parent.header.variant,
        parent.header.seed,
        run=parent.header.run,
        trace=out,
        config=LoopConfig.from_json(parent.header.config),
        parent_sha256=parent.sha256,
        fork_decision=at,
    )
    run = bench.fork(spec, parent.exchanges, override)
    footer = run_to_end(run)
    if json:
        print_json({"outcome": footer.outcome.value, "metrics": dict(footer.metrics)})
    else:
        before = parent.footer.metrics.get("ne_m")
        now = footer.metrics.get("ne_m")
        Console(highlight=False).print(
            f"{footer.outcome.value}, {_metres(now)} from the goal (parent: "
            f"{parent.footer.outcome.value}, {_metres(before)}); {out}"
        )
    return 0


def _ordering(decision: Exchange | None, ranking: str, at: int) -> Ordering:
    """The ranking as keys, read by the labels of the decision's first presentation."""
    if decision is None or not isinstance(decision.request, Ask):
        message = f"expected a decision that put a question, came {at}"
        raise UsageError(message)
    question = decision.request.question
    names = {key.casefold(): key for key in question.keys}
    words = [word.strip() for word in ranking.split(">")]
    if all(word.casefold() in names for word in words) and len(set(words)) == len(words):
        keys = [names[word.casefold()] for word in words]
        rest = tuple(key for key in question.keys if key not in keys)
        return Ordering((*((key,) for key in keys), *((rest,) if rest else ())))
    prompt = decision.ranked.queries[0].prompt if decision.ranked else render(question)
    outcome = parse(ranking, prompt)
    if not isinstance(outcome, Ordering):
        offered = ", ".join(f"{label} = {key}" for label, key in prompt.labels)
        message = f"expected a ranking over {offered}; came {ranking!r}"
        raise UsageError(message)
    return outcome


def _metres(value: float | None) -> str:
    return "–" if value is None else f"{value:.2f} m"
