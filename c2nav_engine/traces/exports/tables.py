"""Traces as tables: one row a decision, or one row a low-level step."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pyarrow
import pyarrow.parquet

from c2nav_engine.errors import UsageError
from c2nav_engine.traces.moments import Moment, moments
from c2nav_engine.traces.pb.control_pb2 import Control
from c2nav_engine.traces.pb.decision_pb2 import Decision
from c2nav_engine.traces.reader import TraceFile
from c2nav_engine.traces.words import committed_words, prompt_words, winner_of

# pyarrow ships no types; this module is where the exported tables meet it.
pa: Any = pyarrow
pq: Any = pyarrow.parquet

Cell = str | int | float | bool | None | list[str]

_RUN = [
    ("trace_sha256", pa.string()),
    ("run", pa.string()),
    ("episode_id", pa.string()),
    ("variant", pa.string()),
    ("seed", pa.int64()),
]

_DECISIONS = pa.schema(
    [
        *_RUN,
        ("decision", pa.int64()),
        ("exchange", pa.int64()),
        ("step", pa.int64()),
        ("cycle", pa.int64()),
        ("leg", pa.int64()),
        ("slot", pa.string()),
        ("asked", pa.bool_()),
        ("form", pa.string()),
        ("orders", pa.string()),
        ("template", pa.string()),
        ("keys", pa.list_(pa.string())),
        ("offered", pa.list_(pa.string())),
        ("vetoes", pa.list_(pa.string())),
        ("presented", pa.list_(pa.string())),
        ("by", pa.string()),
        ("outcome", pa.string()),
        ("winner", pa.string()),
        ("committed", pa.string()),
        ("ranker", pa.string()),
        ("privileged", pa.bool_()),
        ("ranker_outcome", pa.string()),
        ("queries", pa.int64()),
        ("answers", pa.list_(pa.string())),
        ("models", pa.list_(pa.string())),
        ("prompt", pa.string()),
        ("pictures", pa.list_(pa.string())),
        ("latency_s", pa.float64()),
        ("tokens_in", pa.int64()),
        ("tokens_out", pa.int64()),
        ("travelled_m", pa.float64()),
        ("goal_distance_m", pa.float64()),
    ]
)

_STEPS = pa.schema(
    [
        *_RUN,
        ("step", pa.int64()),
        ("exchange", pa.int64()),
        ("action", pa.string()),
        ("purpose", pa.string()),
        ("moved_m", pa.float64()),
        ("collided", pa.bool_()),
        ("x_m", pa.float64()),
        ("y_m", pa.float64()),
        ("z_m", pa.float64()),
        ("yaw_rad", pa.float64()),
        ("goal_distance_m", pa.float64()),
    ]
)

TABLES = ("decisions", "steps")


def export_parquet(traces: Sequence[TraceFile], out: Path, *, table: str = "decisions") -> int:
    """Write one table over all these traces; returns its rows.

    `goal_distance_m` is what the shell measured last; no ranker saw it. Missing is null.
    """
    if table not in TABLES:
        message = f"expected a table among {', '.join(TABLES)}, came {table!r}"
        raise UsageError(message)
    decisions = table == "decisions"
    schema = _DECISIONS if decisions else _STEPS
    rows_of = decision_rows if decisions else step_rows
    rows = [row for trace in traces for row in rows_of(trace)]
    columns = [pa.array([row[each.name] for row in rows], each.type) for each in schema]
    pq.write_table(pa.Table.from_arrays(columns, schema=schema), out)
    return len(rows)


def decision_rows(trace: TraceFile) -> Iterator[dict[str, Cell]]:
    """One row a decision, asked or not."""
    run = _run(trace)
    distance_m: float | None = None
    for moment in moments(trace):
        distance_m = _last_distance_m(moment, distance_m)
        if isinstance(moment.message, Decision):
            yield {**run, **_decision(moment.message), "goal_distance_m": distance_m}


def step_rows(trace: TraceFile) -> Iterator[dict[str, Cell]]:
    """One row a low-level action; poses are true ones where the shell knew them."""
    run = _run(trace)
    for moment in moments(trace):
        if isinstance(moment.message, Control) and moment.message.HasField("move"):
            yield from ({**run, **row} for row in _steps(moment, moment.message))


def _run(trace: TraceFile) -> dict[str, Cell]:
    facts = trace.facts
    return {
        "trace_sha256": trace.sha256,
        "run": facts["run"],
        "episode_id": facts["episode"],
        "variant": facts["variant"],
        "seed": int(facts["seed"]),
    }


def _last_distance_m(moment: Moment, before_m: float | None) -> float | None:
    distances = moment.goal_distances_m()
    return distances[-1][1] if distances else before_m


def _decision(decision: Decision) -> dict[str, Cell]:
    facts, question, ranked = decision.facts, decision.question, decision.ranked
    asked = decision.HasField("question")
    queries = ranked.queries
    return {
        "decision": decision.decision,
        "exchange": decision.exchange,
        "step": decision.step,
        "cycle": facts.cycle,
        "leg": facts.leg,
        "slot": decision.slot,
        "asked": asked,
        "form": question.form if asked else None,
        "orders": question.orders if asked else None,
        "template": question.template if asked else None,
        "keys": [each.key for each in facts.candidates],
        "offered": [each.key for each in facts.candidates if each.feasible],
        "vetoes": [each.veto for each in facts.candidates if not each.feasible],
        "presented": [each.key for each in queries[0].labels] if queries else [],
        "by": decision.by,
        "outcome": decision.committed.kind if asked else None,
        "winner": winner_of(decision) or None,
        "committed": committed_words(decision),
        "ranker": ranked.ranker or None,
        "privileged": ranked.privileged,
        "ranker_outcome": ranked.outcome.kind or None,
        "queries": len(queries),
        "answers": [each.text for each in queries],
        "models": sorted({each.model for each in queries if each.model}),
        "prompt": prompt_words(decision) or None,
        "pictures": [each.sha256 for each in decision.pictures],
        "latency_s": sum(each.wall.latency_s for each in queries),
        "tokens_in": sum(each.wall.tokens_in for each in queries),
        "tokens_out": sum(each.wall.tokens_out for each in queries),
        "travelled_m": facts.travelled_m,
    }


def _steps(moment: Moment, control: Control) -> Iterator[dict[str, Cell]]:
    distances_m = dict(moment.goal_distances_m())
    for (step, pose), executed in zip(moment.poses(), control.move.steps, strict=False):
        x_m, y_m, z_m = pose.position_m
        yield {
            "step": step,
            "exchange": moment.exchange,
            "action": executed.action,
            "purpose": control.move.purpose,
            "moved_m": executed.moved_m,
            "collided": executed.collided,
            "x_m": x_m,
            "y_m": y_m,
            "z_m": z_m,
            "yaw_rad": pose.yaw_rad,
            "goal_distance_m": distances_m.get(step),
        }
