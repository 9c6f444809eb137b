"""The rows of `c2nav turning`: one file for all three parts, resumable, and what it says in all."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pyarrow
import pyarrow.parquet

from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.turning.flips import TURNING, UNSTABLE, Flip
from c2nav_engine.experiments.turning.moments import Recording
from c2nav_engine.experiments.turning.recoverable import Recoverable
from c2nav_engine.experiments.turning.regrets import Regret

# pyarrow ships no types; rows are checked by the schema below.
_pa: Any = pyarrow
_parquet: Any = pyarrow.parquet

Row = dict[str, str | int | float | bool | None]

COLUMNS: Mapping[str, Any] = {
    "trace_sha256": _pa.string(),
    "episode_id": _pa.string(),
    "variant": _pa.string(),
    "ranker": _pa.string(),
    "part": _pa.string(),
    "privileged": _pa.bool_(),
    "decision": _pa.int64(),
    "slot": _pa.string(),
    "committed": _pa.string(),
    "target": _pa.string(),
    "answer": _pa.string(),
    "regret_m": _pa.float64(),
    "words": _pa.string(),
    "changed": _pa.int64(),
    "control": _pa.int64(),
    "repeats": _pa.int64(),
    "queries": _pa.int64(),
    "verdict": _pa.string(),
}
"""Name → type; `part` is regret, recoverable or flip, and fills its own columns."""


def regret_row(recording: Recording, regret: Regret) -> Row:
    """A row of part (a)."""
    return _row(
        recording,
        part="regret",
        privileged=True,
        decision=regret.decision,
        slot=regret.slot.value,
        committed=regret.committed,
        target=regret.target,
        regret_m=regret.regret_m,
        words=regret.words,
    )


def recoverable_row(recording: Recording, found: Recoverable) -> Row:
    """The row of part (b)."""
    return _row(recording, part="recoverable", privileged=True, decision=found.decision)


def flip_row(recording: Recording, flip: Flip) -> Row:
    """A row of part (c)."""
    return _row(
        recording,
        part="flip",
        privileged=recording.header.privileged,
        decision=flip.decision,
        slot=flip.slot.value,
        answer=flip.answer,
        changed=flip.changed,
        control=flip.control,
        repeats=flip.repeats,
        queries=flip.queries,
        verdict=flip.verdict,
    )


def read_table(path: Path) -> list[Row]:
    """Rows of an earlier call; [] when there is no file. Raises `UsageError` for another table."""
    if not path.is_file():
        return []
    try:
        table = _parquet.read_table(path)
    except (OSError, ValueError) as error:
        message = f"expected a table of turning points at {path}, came: {error}; name another --out"
        raise UsageError(message) from error
    if list(table.column_names) != list(COLUMNS):
        message = f"expected a table of turning points, came {path} with other columns"
        raise UsageError(message)
    return table.to_pylist()


def write_table(rows: Iterable[Row], path: Path) -> None:
    """Replace the table whole; a killed call leaves the earlier one."""
    schema = _pa.schema(list(COLUMNS.items()))
    part = path.with_name(f"{path.name}.part")
    _parquet.write_table(_pa.Table.from_pylist(list(rows), schema), part)
    part.replace(path)


def verdict_of(rows: Sequence[Row]) -> str:
    """What an episode's rows say: a turning point, unstable, lost by the controller, or none."""
    flips = [row["verdict"] for row in rows if row["part"] == "flip"]
    if TURNING in flips:
        return TURNING
    if UNSTABLE in flips:
        return UNSTABLE
    spatial = [row for row in rows if row["part"] == "regret" and row["regret_m"] is not None]
    lost = [
        row for row in spatial if row["words"] in {"vetoed", "controller: nothing good offered"}
    ]
    costly = [row for row in spatial if (row["regret_m"] or 0.0) >= 1.0]  # pyright: ignore
    if lost and not costly:
        return "lost by the controller"
    return "not one answer away"


def _row(recording: Recording, **facts: str | float | bool | None) -> Row:
    known: Row = {
        "trace_sha256": recording.trace_sha256,
        "episode_id": recording.header.episode.episode_id,
        "variant": recording.header.variant,
        "ranker": recording.header.ranker,
    }
    return {name: (known | facts).get(name) for name in COLUMNS}
