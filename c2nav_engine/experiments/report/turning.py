"""Turning points of the failures, where a table of `c2nav turning` lies in or beside a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from c2nav_engine.experiments.report.systems import Arm, Section
from c2nav_engine.experiments.turning.summary import (
    TurningSummary,
    failed_traces,
    rows_beside,
    summary_of,
)
from c2nav_engine.experiments.turning.table import Row


@dataclass(frozen=True, slots=True)
class Turnings:
    """The failures of one arm, sorted.

    Attributes:
        system: Whose.
        variants: Names of the configuration.
        summary: Its failures by class and slot.
    """

    system: str
    variants: tuple[str, ...]
    summary: TurningSummary


def turnings_of(section: Section) -> tuple[Turnings, ...]:
    """One entry an arm that a turning table speaks of."""
    found = [
        Turnings(system.label, arm.variants, summary_of(_rows(arm), failed_traces(arm.rows)))
        for system in section.systems
        for arm in system.arms
    ]
    return tuple(each for each in found if each.summary.analysed)


def _rows(arm: Arm) -> Sequence[Row]:
    """Of every folder once; a table that lies beside two of them says the same twice."""
    rows = [row for folder in dict.fromkeys(arm.folders) for row in rows_beside(folder)]
    return list({tuple(row.items()): row for row in rows}.values())
