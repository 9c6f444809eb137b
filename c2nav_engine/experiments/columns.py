"""The columns of `episodes.csv` and `episodes.parquet`: a contract that outside tools rely on."""

from __future__ import annotations

import csv
import importlib
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

Row = Mapping[str, str | int | float | None]

COLUMNS: Mapping[str, str] = {
    "episode_id": "string",
    "trajectory_id": "string",
    "scene_id": "string",
    "variant": "string",
    "ranker": "string",
    "seed": "int64",
    "outcome": "string",
    "ne_m": "float64",
    "os": "int64",
    "success": "int64",
    "success_zero_shot": "int64",
    "spl": "float64",
    "ndtw": "float64",
    "sdtw": "float64",
    "path_length_m": "float64",
    "steps": "int64",
    "collisions": "int64",
    "decisions": "int64",
    "queries": "int64",
    "invalid": "int64",
    "abstained": "int64",
    "fallbacks": "int64",
    "glances": "int64",
    "walkbacks": "int64",
    "tokens": "int64",
    "latency_s": "float64",
    "trace_sha256": "string",
}
"""Name → Arrow type, in file order; missing is null (empty in the CSV)."""

WALL_COLUMNS = ("latency_s", "trace_sha256")
"""What differs between two runs of the same specs: waiting times, and traces that hold them."""


def write_rows(rows: Iterable[Row], folder: Path) -> None:
    """Write `episodes.parquet` and `episodes.csv`, replacing earlier ones whole."""
    rows = list(rows)
    pyarrow, parquet = _arrow()
    schema = pyarrow.schema(list(COLUMNS.items()))
    table = pyarrow.Table.from_pylist(
        [{name: row.get(name) for name in COLUMNS} for row in rows], schema
    )
    parquet_part = folder / "episodes.parquet.part"
    parquet.write_table(table, parquet_part)
    parquet_part.replace(folder / "episodes.parquet")
    csv_part = folder / "episodes.csv.part"
    with csv_part.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows([_cell(row.get(name)) for name in COLUMNS] for row in rows)
    csv_part.replace(folder / "episodes.csv")


def read_rows(folder: Path) -> list[dict[str, str | int | float | None]]:
    """The rows of a run folder's `episodes.parquet`."""
    _, parquet = _arrow()
    return parquet.read_table(folder / "episodes.parquet").to_pylist()


def _arrow() -> tuple[Any, Any]:
    """Arrow and its Parquet part, untyped; imported for tables alone, not by every worker."""
    return importlib.import_module("pyarrow"), importlib.import_module("pyarrow.parquet")


def _cell(value: str | float | None) -> str:
    """One physical line a row: line breaks in ids become spaces."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return " ".join(str(value).split("\n")) if isinstance(value, str) else repr(value)
