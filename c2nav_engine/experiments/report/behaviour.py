"""What the aggregate figures hide: stops that were missed, recoveries, and what each slot costs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import fmean

import numpy as np

from c2nav_engine.contract.outcome import Abstention, Empty, Invalid, Refused, Tie, Truncated
from c2nav_engine.errors import TraceError
from c2nav_engine.experiments.columns import Row
from c2nav_engine.experiments.estimates import figure, number, ratio
from c2nav_engine.experiments.report.systems import Arm, Section, System
from c2nav_engine.experiments.spec import trace_name
from c2nav_engine.experiments.statistics.intervals import Interval
from c2nav_engine.traces.contract_messages import outcome_of
from c2nav_engine.traces.moments import parsed
from c2nav_engine.traces.pb.decision_pb2 import Decision, Query
from c2nav_engine.traces.reader import TraceFile

_UNUSABLE = (Invalid, Refused, Truncated, Empty)


@dataclass(frozen=True, slots=True)
class Behaviour:
    """How the episodes of one arm went.

    Attributes:
        system: Whose.
        variants: Presets of the configuration.
        episodes: Distinct episodes.
        outcomes: Outcome → rows.
        conversion: Successes among the rows that came within 3 m of the goal (OSR → SR).
        success_zero_shot: Success without a STOP, as several published baselines count it.
        per_episode: Mean counts by column.
        invalid_share: Unusable answers over queries; None without queries.
        tokens: Mean tokens an episode; None where unknown.
    """

    system: str
    variants: tuple[str, ...]
    episodes: int
    outcomes: Mapping[str, int]
    conversion: Interval | None
    success_zero_shot: Interval | None
    per_episode: Mapping[str, float]
    invalid_share: float | None
    tokens: float | None


COUNTS = ("steps", "decisions", "queries", "fallbacks", "glances", "walkbacks", "collisions")
"""Columns whose means an episode are shown."""


def behaviours_of(section: Section) -> tuple[Behaviour, ...]:
    """One entry an arm."""
    return tuple(_behaviour(system, arm) for system in section.systems for arm in system.arms)


def _behaviour(system: System, arm: Arm) -> Behaviour:
    queries = _total(arm.rows, "queries")
    return Behaviour(
        system=system.label,
        variants=arm.variants,
        episodes=arm.episodes,
        outcomes=dict(Counter(str(row["outcome"]) for row in arm.rows)),
        conversion=ratio(arm.rows, "success", "os"),
        success_zero_shot=figure(arm.rows, "sr_zero_shot"),
        per_episode={name: mean for name in COUNTS if (mean := _mean(arm.rows, name)) is not None},
        invalid_share=_total(arm.rows, "invalid") / queries if queries else None,
        tokens=_mean(arm.rows, "tokens"),
    )


def _values(rows: Iterable[Row], column: str) -> list[float]:
    return [value for row in rows if (value := number(row, column)) is not None]


def _mean(rows: Iterable[Row], column: str) -> float | None:
    values = _values(rows, column)
    return fmean(values) if values else None


def _total(rows: Iterable[Row], column: str) -> float:
    return sum(_values(rows, column))


# ---------------------------------------------------------------- slots, from the traces


@dataclass(frozen=True, slots=True)
class SlotUse:
    """What one decision slot of a system cost, over every trace that could be read.

    Attributes:
        system: Whose.
        slot: Decision slot.
        traces: Episodes in which it was asked.
        questions: Questions put.
        queries: Queries they took.
        unusable: Queries whose answer could not be used.
        abstained: Questions that ended without a winner although every answer was usable.
        latency_s: Median and 95th percentile of a query; None where nothing was timed.
        tokens_in: Mean prompt tokens of a query; None where unknown.
        tokens_out: Mean completion tokens of a query; None where unknown.
        cost_usd: Sum over queries; None where no price is known.
    """

    system: str
    slot: str
    traces: int
    questions: int
    queries: int
    unusable: int
    abstained: int
    latency_s: tuple[float, float] | None
    tokens_in: float | None
    tokens_out: float | None
    cost_usd: float | None


@dataclass
class _Tally:
    """Counts of one slot while traces are read."""

    traces: set[Path] = field(default_factory=set[Path])
    questions: int = 0
    abstained: int = 0
    unusable: int = 0
    latencies_s: list[float] = field(default_factory=list[float])
    tokens_in: list[int] = field(default_factory=list[int])
    tokens_out: list[int] = field(default_factory=list[int])
    costs_usd: list[float] = field(default_factory=list[float])

    def add(self, decision: Decision, trace: Path) -> None:
        self.traces.add(trace)
        self.questions += 1
        self.abstained += isinstance(outcome_of(decision.committed), Abstention | Tie)
        for query in decision.ranked.queries:
            self._add_query(query)

    def _add_query(self, query: Query) -> None:
        self.unusable += isinstance(outcome_of(query.outcome), _UNUSABLE)
        self.latencies_s.append(query.wall.latency_s)
        if query.wall.HasField("tokens_in"):
            self.tokens_in.append(query.wall.tokens_in)
        if query.wall.HasField("tokens_out"):
            self.tokens_out.append(query.wall.tokens_out)
        if query.wall.HasField("cost_usd"):
            self.costs_usd.append(query.wall.cost_usd)

    def use(self, system: str, slot: str) -> SlotUse:
        timed = self.latencies_s
        ends = np.quantile(timed, [0.5, 0.95]).tolist() if timed else None
        return SlotUse(
            system=system,
            slot=slot,
            traces=len(self.traces),
            questions=self.questions,
            queries=len(timed),
            unusable=self.unusable,
            abstained=self.abstained,
            latency_s=None if ends is None else (ends[0], ends[1]),
            tokens_in=fmean(self.tokens_in) if self.tokens_in else None,
            tokens_out=fmean(self.tokens_out) if self.tokens_out else None,
            cost_usd=sum(self.costs_usd) if self.costs_usd else None,
        )


def slots_of(section: Section) -> tuple[tuple[SlotUse, ...], str]:
    """Use of every slot by system, and a note on traces that could not be read ("" if none)."""
    uses: list[SlotUse] = []
    missing = 0
    for system in section.systems:
        tallies: dict[str, _Tally] = {}
        for path in traces_of(system):
            missing += not _read(path, tallies)
        uses += [tally.use(system.label, slot) for slot, tally in sorted(tallies.items())]
    note = f"{missing} traces are not there or unreadable and not part of it." if missing else ""
    return tuple(uses), note


def traces_of(system: System) -> Iterator[Path]:
    """Where the traces of a system's rows should lie."""
    for arm in system.arms:
        for row, folder in zip(arm.rows, arm.folders, strict=True):
            yield trace_of(row, arm.variants, folder)


def trace_of(row: Row, variants: Sequence[str], folder: Path) -> Path:
    """The trace of a row: presets that share a config have one, under either name."""
    names = (
        trace_name(str(row["episode_id"]), variant, int(row["seed"] or 0)) for variant in variants
    )
    paths = [folder / "traces" / f"{name}.mcap" for name in names]
    return next((path for path in paths if path.is_file()), paths[0])


def _read(path: Path, tallies: dict[str, _Tally]) -> bool:
    try:
        with TraceFile(path) as trace:
            for stored in trace.messages("/decision"):
                decision = parsed(stored)
                if isinstance(decision, Decision) and decision.HasField("question"):
                    tallies.setdefault(decision.slot, _Tally()).add(decision, path)
    except TraceError:
        return False
    return True
