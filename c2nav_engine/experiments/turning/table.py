"""The rows of `c2nav turning`: one file for all three parts, resumable."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, cast

import pyarrow
import pyarrow.parquet

from c2nav_engine.contract.question import Slot
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.turning.flips import Flip, Trial
from c2nav_engine.experiments.turning.moments import Recording
from c2nav_engine.experiments.turning.recoverable import Recoverable
from c2nav_engine.experiments.turning.regrets import Regret
from c2nav_engine.experiments.turning.same_ranker import Continuing

# pyarrow ships no types; rows are checked by the schema below.
_pa: Any = pyarrow
_parquet: Any = pyarrow.parquet

Row = dict[str, str | int | float | bool | None]

REGRET, RECOVERABLE, FLIP = "regret", "recoverable", "flip"
"""Values of `part`; each fills its own columns."""

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
    "regret_m": _pa.float64(),
    "words": _pa.string(),
    "to_try": _pa.int64(),
    "answer": _pa.string(),
    "goes_on": _pa.string(),
    "changed": _pa.int64(),
    "control": _pa.int64(),
    "repeats": _pa.int64(),
    "queries": _pa.int64(),
    "verdict": _pa.string(),
}
"""Name → type. `to_try` of a regret row counts the other answers that are to be tried there."""


def regret_rows(
    recording: Recording, regrets: Sequence[Regret], trials: Sequence[Trial]
) -> list[Row]:
    """The rows of part (a), with how many answers part (c) is to try at each decision."""
    to_try = Counter(trial.decision for trial in trials)
    return [
        _row(
            recording,
            part=REGRET,
            privileged=True,
            decision=regret.decision,
            slot=regret.slot.value,
            committed=regret.committed,
            target=regret.target,
            regret_m=regret.regret_m,
            words=regret.words,
            to_try=to_try[regret.decision],
        )
        for regret in regrets
    ]


def recoverable_row(recording: Recording, found: Recoverable) -> Row:
    """The row of part (b); no decision where none could be recovered from."""
    return _row(recording, part=RECOVERABLE, privileged=True, decision=found.decision)


def flip_row(recording: Recording, flip: Flip, continuing: Continuing) -> Row:
    """A row of part (c)."""
    return _row(
        recording,
        part=FLIP,
        privileged=continuing.privileged,
        decision=flip.decision,
        slot=flip.slot.value,
        answer=flip.answer,
        goes_on=goes_on(continuing),
        changed=flip.changed,
        control=flip.control,
        repeats=flip.repeats,
        queries=flip.queries,
        verdict=flip.verdict,
    )


def goes_on(continuing: Continuing) -> str:
    """A ranker with its options, as the column says it."""
    options = (f"{key}={value}" for key, value in sorted(continuing.options.items()))
    return " ".join([continuing.name, *options])


def flips_in(
    rows: Iterable[Row], trace_sha256: str, *, goes_on: str = "", repeats: int | None = None
) -> list[Flip]:
    """The flips of one trace that a table holds, in the order they were tried.

    Args:
        rows: Of any table.
        trace_sha256: Digest of the trace.
        goes_on: Only those of this ranker; "" for all.
        repeats: Only those run this often; None for all.
    """
    return [
        Flip(
            decision=cast("int", row["decision"]),
            slot=Slot(cast("str", row["slot"])),
            answer=cast("str", row["answer"]),
            changed=cast("int", row["changed"]),
            control=cast("int", row["control"]),
            repeats=cast("int", row["repeats"]),
            queries=cast("int", row["queries"]),
        )
        for row in rows
        if row["part"] == FLIP
        and row["trace_sha256"] == trace_sha256
        and goes_on in ("", row["goes_on"])
        and repeats in (None, row["repeats"])
    ]


def read_table(path: Path) -> list[Row]:
    """Rows of an earlier call; [] when there is no file. Raises `UsageError` for another table."""
    if not path.is_file():
        return []
    if not is_turning_table(path):
        message = (
            f"expected a table of turning points at {path}, came something else; name another file"
        )
        raise UsageError(message)
    return _parquet.read_table(path).to_pylist()


def is_turning_table(path: Path) -> bool:
    """Whether a file holds rows of this kind."""
    try:
        return list(_parquet.read_schema(path).names) == list(COLUMNS)
    except (OSError, ValueError):
        return False


def write_table(rows: Iterable[Row], path: Path) -> None:
    """Replace the table whole; a killed call leaves the earlier one."""
    schema = _pa.schema(list(COLUMNS.items()))
    part = path.with_name(f"{path.name}.part")
    path.parent.mkdir(parents=True, exist_ok=True)
    _parquet.write_table(_pa.Table.from_pylist(list(rows), schema), part)
    part.replace(path)


def _row(recording: Recording, **facts: str | float | bool | None) -> Row:
    known: Row = {
        "trace_sha256": recording.trace_sha256,
        "episode_id": recording.header.episode.episode_id,
        "variant": recording.header.variant,
        "ranker": recording.header.ranker,
    }
    return {name: (known | facts).get(name) for name in COLUMNS}
