"""`summary.json`: rates and means per variant and ranker, with intervals over episodes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from c2nav_engine.experiments.columns import Row
from c2nav_engine.experiments.statistics.intervals import Interval, bca_mean, wilson

RATES = {"sr": "success", "osr": "os", "sr_zero_shot": "success_zero_shot"}
"""Summary name → column, for shares of episodes."""
MEANS = ("spl", "ne_m", "ndtw", "sdtw", "path_length_m", "steps", "queries")
"""Columns whose finite values are averaged."""


def summarise(rows: Sequence[Row]) -> dict[str, Any]:
    """One entry per variant and ranker, in the order of their first rows."""
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        groups.setdefault((str(row["variant"]), str(row["ranker"])), []).append(row)
    return {
        "schema": 1,
        "note": "rates are fractions; official scoring needs a STOP within 3 m, zero-shot does not",
        "groups": [
            {"variant": variant, "ranker": ranker, **_group(members)}
            for (variant, ranker), members in groups.items()
        ],
    }


def _group(rows: Sequence[Row]) -> dict[str, Any]:
    counts: dict[str, int] = {}
    for row in rows:
        counts[str(row["outcome"])] = counts.get(str(row["outcome"]), 0) + 1
    unreachable = sum(row.get("ne_m") == math.inf for row in rows)
    entry: dict[str, Any] = {"n": len(rows), "outcomes": counts, "unreachable": unreachable}
    for name, column in RATES.items():
        known = [int(v) for row in rows if isinstance(v := row.get(column), int | float)]
        entry[name] = _stated(wilson(sum(known), len(known))) if known else None
    for column in MEANS:
        entry[column] = _mean(rows, column)
    return entry


def _mean(rows: Sequence[Row], column: str) -> dict[str, float | int | None] | None:
    values = [row.get(column) for row in rows]
    finite = [float(v) for v in values if isinstance(v, int | float) and math.isfinite(v)]
    return _stated(bca_mean(finite, seed=0)) if finite else None


def _stated(interval: Interval) -> dict[str, float | int | None]:
    ends = {"value": interval.estimate, "low": interval.low, "high": interval.high}
    finite = {name: end if math.isfinite(end) else None for name, end in ends.items()}
    return {**finite, "n": interval.n}
