"""The columns of `episodes.csv` and `episodes.parquet`: a contract that outside tools rely on."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import pyarrow
import pyarrow.parquet

# pyarrow ships no types; this module is where the row tables meet it.
_pa: Any = pyarrow
_parquet: Any = pyarrow.parquet

Row = Mapping[str, str | int | float | None]

COLUMNS: Mapping[str, Any] = {
    "episode_id": _pa.string(),
    "trajectory_id": _pa.string(),
    "scene_id": _pa.string(),
    "variant": _pa.string(),
    "ranker": _pa.string(),
    "seed": _pa.int64(),
    "outcome": _pa.string(),
    "ne_m": _pa.float64(),
    "os": _pa.int64(),
    "success": _pa.int64(),
    "success_zero_shot": _pa.int64(),
    "spl": _pa.float64(),
    "ndtw": _pa.float64(),
    "sdtw": _pa.float64(),
    "path_length_m": _pa.float64(),
    "steps": _pa.int64(),
    "collisions": _pa.int64(),
    "decisions": _pa.int64(),
    "queries": _pa.int64(),
    "invalid": _pa.int64(),
    "abstained": _pa.int64(),
    "fallbacks": _pa.int64(),
    "glances": _pa.int64(),
    "walkbacks": _pa.int64(),
    "tokens": _pa.int64(),
    "latency_s": _pa.float64(),
    "trace_sha256": _pa.string(),
}
"""Name → type, in file order; missing is null (empty in the CSV)."""

WALL_COLUMNS = ("latency_s", "trace_sha256")
"""What differs between two runs of the same specs: waiting times, and traces that hold them."""


def write_rows(rows: Iterable[Row], folder: Path) -> None:
    """Write `episodes.parquet` and `episodes.csv`, replacing earlier ones whole."""
    rows = list(rows)
    schema = _pa.schema(list(COLUMNS.items()))
    table = _pa.Table.from_pylist(
        [{name: row.get(name) for name in COLUMNS} for row in rows], schema
    )
    parquet_part = folder / "episodes.parquet.part"
    _parquet.write_table(table, parquet_part)
    parquet_part.replace(folder / "episodes.parquet")
    csv_part = folder / "episodes.csv.part"
    with csv_part.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows([_cell(row.get(name)) for name in COLUMNS] for row in rows)
    csv_part.replace(folder / "episodes.csv")


def read_rows(folder: Path) -> list[dict[str, str | int | float | None]]:
    """The rows of a run folder's `episodes.parquet`."""
    return _parquet.read_table(folder / "episodes.parquet").to_pylist()


def _cell(value: str | float | None) -> str:
    """One physical line a row: line breaks in ids become spaces."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return " ".join(str(value).split("\n")) if isinstance(value, str) else repr(value)
