"""The file of a re-evaluation: one row a presentation, read by `inspect --with` and `agree`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pyarrow
import pyarrow.parquet

from c2nav_engine.contract.outcome import (
    Abstention,
    Answered,
    Cardinal,
    Invalid,
    Ordering,
    Tie,
    TransportFailure,
)
from c2nav_engine.contract.prompt import Query
from c2nav_engine.errors import InputError
from c2nav_engine.experiments.reeval import Reanswered
from c2nav_engine.traces.contract_messages import outcome_message

# pyarrow ships no types; this module is where the re-evaluation meets it.
_pa: Any = pyarrow
_parquet: Any = pyarrow.parquet

Record = Mapping[str, Any]

SCHEMA_VERSION = 1
FACTS = {
    "c2nav": "re-evaluation",
    "schema": str(SCHEMA_VERSION),
    "what": "decision-level and open-loop: recorded questions asked again; no answer moved a robot",
}
"""Metadata of the file."""

COLUMNS: Mapping[str, Any] = {
    "trace_sha256": _pa.string(),
    "trace": _pa.string(),
    "run": _pa.string(),
    "episode_id": _pa.string(),
    "scene_id": _pa.string(),
    "variant": _pa.string(),
    "seed": _pa.int64(),
    "decision": _pa.int64(),
    "slot": _pa.string(),
    "form": _pa.string(),
    "options": _pa.int64(),
    "recorded_ranker": _pa.string(),
    "recorded_outcome": _pa.string(),
    "recorded_winner": _pa.string(),
    "ranker": _pa.string(),
    "open_loop": _pa.bool_(),
    "order": _pa.int64(),
    "labelling": _pa.string(),
    "labels": _pa.list_(_pa.string()),
    "keys": _pa.list_(_pa.string()),
    "answer": _pa.string(),
    "outcome": _pa.string(),
    "reason": _pa.string(),
    "winner": _pa.string(),
    "ranking": _pa.list_(_pa.list_(_pa.string())),
    "value": _pa.float64(),
    "queries": _pa.int64(),
    "repaired": _pa.bool_(),
    "latency_s": _pa.float64(),
    "tokens_in": _pa.int64(),
    "tokens_out": _pa.int64(),
    "cost_usd": _pa.float64(),
    "model": _pa.string(),
    "request_sha256": _pa.string(),
}
"""Name → type, in file order; docs/experiments.md says what each holds. Missing is null."""


def record_of(result: Reanswered, ranker: str) -> Record:
    """One row."""
    recorded, presentation = result.recorded, result.presentation
    question = recorded.ask.question
    last = result.queries[-1] if result.queries else None
    return {
        "trace_sha256": recorded.trace_sha256,
        "trace": recorded.trace.name,
        "run": recorded.run,
        "episode_id": recorded.episode_id,
        "scene_id": recorded.scene_id,
        "variant": recorded.variant,
        "seed": recorded.seed,
        "decision": recorded.decision,
        "slot": question.slot.value,
        "form": question.form.value,
        "options": len(question.alternatives),
        "recorded_ranker": recorded.ranker,
        "recorded_outcome": outcome_message(recorded.answer).kind,
        "recorded_winner": winner_of(recorded.answer),
        "ranker": ranker,
        "open_loop": True,
        "order": presentation.order,
        "labelling": presentation.labelling.value,
        "labels": [label for label, _ in presentation.labels],
        "keys": [key for _, key in presentation.labels],
        **_outcome(result.outcome),
        **_spent(result.queries),
        "answer": "" if last is None else last.reply.text,
        "model": "" if last is None else last.reply.model,
        "request_sha256": "" if last is None else last.prompt.request_sha256,
    }


def winner_of(outcome: Answered) -> str | None:
    """The elected key; None when nothing was elected."""
    return outcome.winner if isinstance(outcome, Ordering) else None


def write_table(records: Sequence[Record], path: Path) -> None:
    """Write the file whole or not at all."""
    schema = _pa.schema(list(COLUMNS.items()), metadata=FACTS)
    table = _pa.Table.from_pylist([dict(record) for record in records], schema=schema)
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.part")
    _parquet.write_table(table, part)
    part.replace(path)


def read_table(path: Path) -> list[dict[str, Any]]:
    """The rows of a re-evaluation; raises `InputError` for any other file."""
    try:
        table = _parquet.read_table(path)
    except (OSError, _pa.ArrowInvalid) as error:
        message = f"expected a re-evaluation (Parquet) at {path}, came: {error}"
        raise InputError(message) from error
    facts: dict[bytes, bytes] = table.schema.metadata or {}
    if facts.get(b"c2nav") != FACTS["c2nav"].encode():
        message = f"expected a re-evaluation at {path}; make one with `c2nav reeval TRACE…`"
        raise InputError(message)
    return table.to_pylist()


def _outcome(outcome: Answered) -> Record:
    reason = outcome.reason if isinstance(outcome, Abstention | Invalid | TransportFailure) else ""
    tiers = outcome.tiers if isinstance(outcome, Ordering | Tie) else ()
    return {
        "outcome": outcome_message(outcome).kind,
        "reason": reason,
        "winner": winner_of(outcome),
        "ranking": [list(tier) for tier in tiers],
        "value": outcome.value if isinstance(outcome, Cardinal) else None,
    }


def _spent(queries: Sequence[Query]) -> Record:
    return {
        "queries": len(queries),
        "repaired": any(query.prompt.repair for query in queries),
        "latency_s": sum(query.reply.latency_s for query in queries),
        "tokens_in": _total([query.reply.tokens_in for query in queries]),
        "tokens_out": _total([query.reply.tokens_out for query in queries]),
        "cost_usd": _total([query.reply.cost_usd for query in queries]),
    }


def _total(values: Sequence[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return sum(known) if known else None
