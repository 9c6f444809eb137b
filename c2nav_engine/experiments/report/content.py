"""A report before it is written: sections with their tables, tests and behaviour."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from c2nav_engine.experiments.report.behaviour import (
    Behaviour,
    SlotUse,
    behaviours_of,
    slots_of,
)
from c2nav_engine.experiments.report.comparing import (
    Comparison,
    systems_in_pairs,
    variants_against_full,
)
from c2nav_engine.experiments.report.grids import (
    Grid,
    behaviour_grid,
    beside_grid,
    comparison_grid,
    slot_grid,
    table_grid,
    turning_grid,
)
from c2nav_engine.experiments.report.reading import Run
from c2nav_engine.experiments.report.reported import OPENNAV_100_SHA256
from c2nav_engine.experiments.report.systems import Section, sections_of
from c2nav_engine.experiments.report.tables import Table, tables_of
from c2nav_engine.experiments.report.turning import Turnings, turnings_of


@dataclass(frozen=True, slots=True)
class Chapter:
    """One section with everything that is said about it.

    Attributes:
        key: Prefix of its files; "" for the first.
        section: The systems.
        tables: The paper's four tables, or those a privileged section has rows for.
        against_full: Every configuration against `full`.
        in_pairs: `full` of every two systems.
        behaviours: By configuration.
        slots: By system and decision slot.
        slots_note: Which traces are missing.
        turnings: Turning points of the failures, where they were looked for.
        notes: What a reader must know first.
    """

    key: str
    section: Section
    tables: tuple[Table, ...]
    against_full: tuple[Comparison, ...]
    in_pairs: tuple[Comparison, ...]
    behaviours: tuple[Behaviour, ...]
    slots: tuple[SlotUse, ...]
    slots_note: str
    turnings: tuple[Turnings, ...]
    notes: tuple[str, ...]

    @property
    def title(self) -> str:
        """Heading."""
        kind = "Simulated observer (privileged)" if self.section.privileged else "Models"
        return f"{kind}: {self.section.protocol.words}"

    def grids(self) -> Iterator[Grid]:
        """Everything as tables for people, in reading order."""
        for table in self.tables:
            yield table_grid(table)
            if table.beside:
                yield beside_grid(table)
        if self.against_full:
            yield comparison_grid("against-full", "Against full", self.against_full)
        if self.in_pairs:
            yield comparison_grid("between-rankers", "Between rankers", self.in_pairs)
        yield behaviour_grid(self.behaviours)
        if self.slots:
            yield slot_grid(self.slots, self.slots_note)
        if self.turnings:
            yield turning_grid(self.turnings)


@dataclass(frozen=True, slots=True)
class Annex:
    """Tables that come from elsewhere than episodes, such as a human study.

    Attributes:
        title: Heading.
        notes: What a reader must know first.
        grids: Its tables.
    """

    title: str
    notes: tuple[str, ...]
    grids: tuple[Grid, ...]


@dataclass(frozen=True, slots=True)
class Report:
    """Everything that is written.

    Attributes:
        runs: What it is made from.
        chapters: One a section; models first.
        annexes: What follows the chapters.
    """

    runs: tuple[Run, ...]
    chapters: tuple[Chapter, ...]
    annexes: tuple[Annex, ...] = ()


def report_of(runs: Sequence[Run], annexes: Sequence[Annex] = ()) -> Report:
    """Sort, measure and test; nothing is written."""
    sections = sections_of(runs)
    chapters = tuple(_chapter(section, place) for place, section in enumerate(sections))
    return Report(tuple(runs), chapters, tuple(annexes))


def _chapter(section: Section, place: int) -> Chapter:
    slots, slots_note = slots_of(section)
    return Chapter(
        key="" if place == 0 else f"{place + 1}-",
        section=section,
        tables=tables_of(section),
        against_full=variants_against_full(section),
        in_pairs=systems_in_pairs(section),
        behaviours=behaviours_of(section),
        slots=slots,
        slots_note=slots_note,
        turnings=turnings_of(section),
        notes=tuple(_notes(section)),
    )


def _notes(section: Section) -> Iterator[str]:
    if section.privileged:
        yield (
            "The observer knows the truth. Its figures show what an interface does to evidence of "
            "a given quality; they stand beside no model and no reported row."
        )
    elif section.protocol.source_sha256 != OPENNAV_100_SHA256:
        yield (
            f"The episodes of {section.protocol.source} are not the OpenNav_R2R-CE_100 of the "
            "reported rows: differences from them mix method and task."
        )
    for system in section.systems:
        failed = sum(row["outcome"] == "error" for arm in system.arms for row in arm.rows)
        if failed:
            yield (
                f"{system.label}: {failed} tasks ended in an error and count as they stand in "
                "episodes.csv; `c2nav run … --resume` takes them up again."
            )
        seeds = {seed for arm in system.arms for seed in arm.seeds}
        if len(seeds) > 1:
            yield (
                f"{system.label}: {len(seeds)} seeds; whole episodes are drawn for the intervals, "
                "and McNemar tests use the lowest seed."
            )
