"""Figures over episodes: the one place where rows become rates and means with intervals.

Seeds of one episode are alike, so an episode counts once: with one row an episode a rate has a
Wilson interval and a mean a BCa bootstrap; with several, whole episodes are drawn instead.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from c2nav_engine.experiments.columns import Row
from c2nav_engine.experiments.statistics.clusters import cluster_mean_interval
from c2nav_engine.experiments.statistics.intervals import Interval, bca_mean, wilson

SEED = 0
"""Of every bootstrap: the same rows give the same intervals."""

RATES: Mapping[str, str] = {"sr": "success", "osr": "os", "sr_zero_shot": "success_zero_shot"}
"""Figure → column, for shares of episodes."""
MEANS = ("spl", "ne_m", "ndtw", "sdtw", "path_length_m", "steps", "queries")
"""Columns whose finite values are averaged."""


def number(row: Row, column: str) -> float | None:
    """A finite number of a row; None where it is missing or an unreachable goal."""
    value = row.get(column)
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else None


def by_episode(rows: Sequence[Row], column: str) -> list[list[float]]:
    """Known values of each episode, in order of first appearance."""
    groups: dict[str, list[float]] = {}
    for row in rows:
        value = number(row, column)
        if value is not None:
            groups.setdefault(str(row["episode_id"]), []).append(value)
    return list(groups.values())


def figure(rows: Sequence[Row], name: str) -> Interval | None:
    """A rate of `RATES` or the mean of a column, with its 95 % interval; None without values."""
    groups = by_episode(rows, RATES.get(name, name))
    if not groups:
        return None
    if any(len(group) > 1 for group in groups):
        return cluster_mean_interval(groups, seed=SEED)
    values = [value for group in groups for value in group]
    if name in RATES:
        return wilson(sum(value >= 0.5 for value in values), len(values))
    return bca_mean(values, seed=SEED)


def ratio(rows: Sequence[Row], above: str, below: str) -> Interval | None:
    """Rows with `above` among the rows with `below`, both 0 or 1; Wilson, None without any."""
    among = [row for row in rows if number(row, below) == 1.0 and number(row, above) is not None]
    if not among:
        return None
    return wilson(sum(number(row, above) == 1.0 for row in among), len(among))
