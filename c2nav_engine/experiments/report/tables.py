"""The paper's four tables: which rows they have, and ours beside each reported one.

Every figure is a fraction of one or in metres here; percent is made where a table is written.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from c2nav_engine.experiments.estimates import figure
from c2nav_engine.experiments.report import reported as paper
from c2nav_engine.experiments.report.reported import Reported
from c2nav_engine.experiments.report.systems import Arm, Section, System
from c2nav_engine.experiments.statistics.intervals import Interval

METHOD = "C²Nav"


@dataclass(frozen=True, slots=True)
class Measure:
    """One measured column.

    Attributes:
        name: Figure of `estimates.figure`.
        head: Column head as in the paper.
        percent: Whether it is a fraction that is shown as percent.
    """

    name: str
    head: str
    percent: bool = True


NE = Measure("ne_m", "NE ↓", percent=False)
OSR = Measure("osr", "OSR ↑")
SR = Measure("sr", "SR ↑")
SPL = Measure("spl", "SPL ↑")
WITH_NE = (NE, OSR, SR, SPL)
WITHOUT_NE = (OSR, SR, SPL)


@dataclass(frozen=True, slots=True)
class Cell:
    """One figure: with an interval when it is ours, with a spread where one is reported."""

    value: float
    interval: Interval | None = None
    spread: float | None = None


@dataclass(frozen=True, slots=True)
class Line:
    """One row of a table.

    Attributes:
        labels: Its leading cells.
        cells: Figure → cell.
        block: Rows of different blocks are parted by a rule.
        ours: False for a reported row.
        system: Whose row it is; "" for a reported one.
        variant: Preset; "" where a row has none.
        episodes: Distinct episodes behind it; 0 for a reported one.
    """

    labels: tuple[str, ...]
    cells: Mapping[str, Cell]
    block: int
    ours: bool
    system: str = ""
    variant: str = ""
    episodes: int = 0


@dataclass(frozen=True, slots=True)
class Beside:
    """A reported figure beside ours.

    Attributes:
        row: What both rows are called.
        system: Whose figure ours is.
        measure: Which figure.
        reported: As published, in our unit.
        ours: With its interval.
    """

    row: str
    system: str
    measure: Measure
    reported: float
    ours: Interval

    @property
    def difference(self) -> float:
        """Ours minus the reported one."""
        return self.ours.estimate - self.reported

    @property
    def inside(self) -> bool:
        """Whether our 95 % interval holds the reported figure."""
        # Printed figures are rounded; a last digit is no reason to be outside.
        slack = 0.5e-3 if self.measure.percent else 0.5e-2
        return self.ours.low - slack <= self.reported <= self.ours.high + slack


@dataclass(frozen=True, slots=True)
class Table:
    """One of the four tables.

    Attributes:
        key: "main", "scale", "faculty" or "role".
        title: Heading.
        heads: Heads of the label columns.
        measures: Measured columns, in the paper's order.
        lines: Rows in the paper's order, each reported one followed by ours.
        beside: Reported figures beside ours.
        notes: What a reader must know before comparing.
    """

    key: str
    title: str
    heads: tuple[str, ...]
    measures: tuple[Measure, ...]
    lines: tuple[Line, ...]
    beside: tuple[Beside, ...]
    notes: tuple[str, ...] = ()


def tables_of(section: Section) -> tuple[Table, ...]:
    """The four tables of a section; privileged ones stand without any reported row."""
    made = (_main(section), _scale(section), _faculty(section), _role(section))
    return tuple(table for table in made if table.lines)


def _main(section: Section) -> Table:
    lines: list[Line] = []
    beside: list[Beside] = []
    if not section.privileged:
        lines += [_reported(row, WITH_NE, block=0) for row in paper.BASELINES]
    for system in section.systems:
        arm = None if section.privileged else system.arm("random")
        if arm is not None:
            labels = (f"Random ({_whose(section, system)})", "–", "–")
            lines.append(_ours(arm, labels, WITH_NE, system=system, block=0))
            beside += _beside(paper.RANDOM, lines[-1], WITH_NE)
    if not section.privileged:
        for row in paper.BACKBONES:
            if row.labels[0] in paper.MAIN_BACKBONES:
                name = row.labels[0]
                renamed = (f"{METHOD} ({name})", name, "Yes")
                lines.append(_reported(row, WITH_NE, block=1, labels=renamed))
    for system in section.systems:
        arm = system.arm("full")
        if arm is not None:
            labels = (f"{METHOD} ({_whose(section, system)})", _backbone(system), "Yes")
            lines.append(_ours(arm, labels, WITH_NE, system=system, block=1))
            beside += _beside(_counterpart(section, system), lines[-1], WITH_NE)
    heads = ("Method", "Backbone", "WP-free")
    return Table("main", "Main result", heads, WITH_NE, tuple(lines), tuple(beside))


def _scale(section: Section) -> Table:
    lines: list[Line] = []
    beside: list[Beside] = []
    left = list(section.systems)
    for row in () if section.privileged else paper.BACKBONES:
        lines.append(_reported(row, WITH_NE, block=0))
        for system in [each for each in left if _counterpart(section, each) == row]:
            left.remove(system)
            lines += _scale_lines(section, system, block=0)
            beside += _beside(row, lines[-1], WITH_NE) if lines[-1].ours else ()
    for system in left:
        lines += _scale_lines(section, system, block=1)
    return Table("scale", "Backbones", ("Backbone",), WITH_NE, tuple(lines), tuple(beside))


def _scale_lines(section: Section, system: System, *, block: int) -> Iterator[Line]:
    arm = system.arm("full")
    if arm is not None:
        labels = (f"{_backbone(system)} ({_whose(section, system, short=True)})",)
        yield _ours(arm, labels, WITH_NE, system=system, block=block)


def _faculty(section: Section) -> Table:
    parts = (("base", "seeing", "seeing-remembering", "full"), tuple(paper.FACULTIES)[4:])
    blocks = [{variant: paper.FACULTIES[variant] for variant in part} for part in parts]
    heads = ("Variant", "Seeing", "Remembering", "Arriving")
    return _ablation(section, "faculty", ("Faculties", heads), blocks)


def _role(section: Section) -> Table:
    blocks = [paper.COMPONENTS, paper.INVERSIONS]
    heads = ("Interface variant",)
    return _ablation(section, "role", ("Components and role inversions", heads), blocks)


def _ablation(
    section: Section,
    key: str,
    naming: tuple[str, tuple[str, ...]],
    blocks: Sequence[Mapping[str, Reported]],
) -> Table:
    """Rows by preset: the reported one, then ours for every system."""
    lines: list[Line] = []
    beside: list[Beside] = []
    for block, rows in enumerate(blocks):
        for variant, row in rows.items():
            if not section.privileged:
                lines.append(_reported(row, WITHOUT_NE, block=block))
            for system in section.systems:
                arm = system.arm(variant)
                if arm is None:
                    continue
                labels = (f"{row.labels[0]} ({_whose(section, system)})", *row.labels[1:])
                line = _ours(arm, labels, WITHOUT_NE, system=system, block=block, variant=variant)
                lines.append(line)
                beside += () if section.privileged else _beside(row, line, WITHOUT_NE)
    title, heads = naming
    notes = () if section.privileged else tuple(_notes(section))
    return Table(key, title, heads, WITHOUT_NE, tuple(lines), tuple(beside), notes)


def _notes(section: Section) -> Iterator[str]:
    others = [s.label for s in section.systems if _backbone_row(s) != paper.BACKBONES[1]]
    if others:
        yield (
            f"The reported rows are for {paper.ABLATED_BACKBONE}; "
            f"{', '.join(others)} is another backbone."
        )


def _reported(
    row: Reported,
    measures: Sequence[Measure],
    *,
    block: int,
    labels: tuple[str, ...] | None = None,
) -> Line:
    spread = row.spread or {}
    values = {measure.name: row.value(measure.name) for measure in measures}
    cells = {
        name: Cell(value, spread=spread.get(name))
        for name, value in values.items()
        if value is not None
    }
    first, *rest = labels or row.labels
    return Line((f"{first} (reported)", *rest), cells, block, ours=False)


def _ours(
    arm: Arm,
    labels: tuple[str, ...],
    measures: Sequence[Measure],
    *,
    system: System,
    block: int,
    variant: str = "",
) -> Line:
    intervals = {measure.name: figure(arm.rows, measure.name) for measure in measures}
    return Line(
        labels=labels,
        cells={
            name: Cell(interval.estimate, interval)
            for name, interval in intervals.items()
            if interval is not None
        },
        block=block,
        ours=True,
        system=system.label,
        variant=variant or arm.variants[0],
        episodes=arm.episodes,
    )


def _beside(row: Reported | None, line: Line, measures: Sequence[Measure]) -> Iterator[Beside]:
    if row is None:
        return
    for measure in measures:
        cell, value = line.cells.get(measure.name), row.value(measure.name)
        if cell is not None and cell.interval is not None and value is not None:
            yield Beside(line.labels[0], line.system, measure, value, cell.interval)


def _counterpart(section: Section, system: System) -> Reported | None:
    return None if section.privileged else _backbone_row(system)


def _backbone_row(system: System) -> Reported | None:
    return paper.backbone_of(system.ranker)


def _backbone(system: System) -> str:
    _, colon, model = system.ranker.partition(":")
    return model if colon else system.ranker


def _whose(section: Section, system: System, *, short: bool = False) -> str:
    """The word "ours", with the system where a section has several."""
    return "ours" if short or len(section.systems) == 1 else f"ours, {system.label}"
