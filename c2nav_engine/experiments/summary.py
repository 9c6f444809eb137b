"""`summary.json`: rates and means per variant and ranker, with intervals over episodes."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from typing import Any

from c2nav_engine.experiments.columns import Row
from c2nav_engine.experiments.estimates import MEANS, RATES, figure
from c2nav_engine.experiments.statistics.intervals import Interval


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
    return {
        "n": len(rows),
        "outcomes": dict(Counter(str(row["outcome"]) for row in rows)),
        "unreachable": sum(row.get("ne_m") == math.inf for row in rows),
        **{name: _stated(figure(rows, name)) for name in (*RATES, *MEANS)},
    }


def _stated(interval: Interval | None) -> dict[str, float | int | None] | None:
    if interval is None:
        return None
    ends = {"value": interval.estimate, "low": interval.low, "high": interval.high}
    finite = {name: end if math.isfinite(end) else None for name, end in ends.items()}
    return {**finite, "n": interval.n}
