"""Everything a report says as plain grids of words, which every file format then writes its way.

Percent appears here, because a grid is read by people; the CSV files keep fractions.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from c2nav_engine.experiments.report.behaviour import COUNTS, Behaviour, SlotUse
from c2nav_engine.experiments.report.comparing import Comparison
from c2nav_engine.experiments.report.tables import Beside, Cell, Line, Measure, Table
from c2nav_engine.experiments.report.turning import Turnings
from c2nav_engine.experiments.statistics.intervals import Interval
from c2nav_engine.experiments.statistics.paired import PairedDifference
from c2nav_engine.experiments.turning.summary import VERDICTS

NONE = "–"


@dataclass(frozen=True, slots=True)
class GridRow:
    """One row of words.

    Attributes:
        cells: As many as the grid has heads.
        block: Rows of different blocks are parted by a rule.
        reported: Whether it is somebody else's.
    """

    cells: tuple[str, ...]
    block: int = 0
    reported: bool = False


@dataclass(frozen=True, slots=True)
class Grid:
    """A table for people.

    Attributes:
        key: Stem of its files.
        title: Heading.
        heads: Column heads.
        rows: Rows in order.
        text_columns: How many leading columns are words; the rest are numbers.
        notes: Sentences below it.
    """

    key: str
    title: str
    heads: tuple[str, ...]
    rows: tuple[GridRow, ...]
    text_columns: int = 1
    notes: tuple[str, ...] = field(default=())


def table_grid(table: Table) -> Grid:
    """The paper's table: its columns in its order, ours with intervals."""
    rows = [
        GridRow(
            cells=(*line.labels, *(_cell(line.cells.get(m.name), m) for m in table.measures)),
            block=line.block,
            reported=not line.ours,
        )
        for line in table.lines
    ]
    notes = (*table.notes, *_sizes(table.lines))
    heads = (*table.heads, *(measure.head for measure in table.measures))
    return Grid(table.key, table.title, heads, tuple(rows), len(table.heads), notes)


def beside_grid(table: Table) -> Grid:
    """Each reported figure beside ours."""
    heads = ("Row", "Figure", "Reported", "Ours", "95 % interval", "Difference", "Reported is")
    return Grid(
        f"{table.key}-beside",
        f"{table.title}: reported beside ours",
        heads,
        tuple(GridRow(_beside(each)) for each in table.beside),
        text_columns=2,
        notes=(
            "No paired test is possible against a reported figure: it has no outcomes by episode. "
            "A paper's figure inside our interval is not shown to differ from ours.",
        ),
    )


def comparison_grid(key: str, title: str, comparisons: Sequence[Comparison]) -> Grid:
    """Paired tests with their discordant counts."""
    heads = (
        "Compared",
        "With",
        "n",
        "SR alone",
        "SR there alone",
        "McNemar p",
        "Holm p",
        "ΔSPL (95 %)",
        "Holm p",
        "ΔNE m (95 %)",
        "Holm p",
        "What n can say",
    )
    return Grid(
        key,
        title,
        heads,
        tuple(GridRow(_comparison(each)) for each in comparisons),
        text_columns=2,
        notes=(
            "Exact two-sided McNemar on the discordant episodes of one seed, paired bootstrap for "
            "SPL and NE, Holm across distinct configurations. Presets that are one configuration "
            "are one row.",
        ),
    )


def behaviour_grid(behaviours: Sequence[Behaviour]) -> Grid:
    """How episodes went, by configuration."""
    heads = (
        "System",
        "Variant",
        "n",
        "OSR→SR",
        "SR zero-shot scoring",
        "Outcomes",
        "Unusable answers",
        *(f"{name} / episode" for name in COUNTS),
        "tokens / episode",
    )
    return Grid(
        "behaviour",
        "Behaviour",
        heads,
        tuple(GridRow(_behaviour(each)) for each in behaviours),
        text_columns=2,
        notes=(
            "OSR→SR: successes among the episodes that came within 3 m of the goal. Zero-shot "
            "scoring counts an episode that ends within 3 m without a STOP.",
        ),
    )


def slot_grid(uses: Sequence[SlotUse], note: str) -> Grid:
    """What each decision slot cost."""
    heads = (
        "System",
        "Slot",
        "Episodes",
        "Questions",
        "Queries",
        "Unusable",
        "No winner",
        "Latency s (p50, p95)",
        "Tokens in",
        "Tokens out",
        "Cost USD",
    )
    rows = tuple(GridRow(_slot(use)) for use in uses)
    return Grid("slots", "Decision slots", heads, rows, 2, (note,) if note else ())


def turning_grid(turnings: Sequence[Turnings]) -> Grid:
    """What would have saved the failures, each in one class."""
    heads = ("System", "Variant", "Failures", "Analysed", "By slot", *VERDICTS)
    return Grid(
        "turning",
        "Turning points of the failures",
        heads,
        tuple(GridRow(_turning(each)) for each in turnings),
        text_columns=2,
        notes=(
            "Counts of the analysed failures, each in one class, with their share in percent and "
            "95 % Wilson intervals. One answer away: one changed answer alone led to success in "
            "every run, and the unchanged decision in none. By slot: where that answer was given. "
            "Lost by the controller: even a noiseless observer fails (privileged).",
        ),
    )


# ---------------------------------------------------------------- words of one cell


def shown(value: float, measure: Measure) -> str:
    """A figure in the paper's precision: percent with one decimal, metres with two."""
    if not math.isfinite(value):
        return NONE
    return f"{100 * value:.1f}" if measure.percent else f"{value:.2f}"


def interval_words(interval: Interval, measure: Measure) -> str:
    """As in "22.8 to 40.6"; a dash where nothing bounds it."""
    return f"{shown(interval.low, measure)} to {shown(interval.high, measure)}"


def _cell(cell: Cell | None, measure: Measure) -> str:
    if cell is None:
        return NONE
    if cell.interval is not None:
        return f"{shown(cell.value, measure)} ({interval_words(cell.interval, measure)})"
    digits = 1 if measure.percent else 2
    value = f"{100 * cell.value:.2f}" if measure.percent else f"{cell.value:.2f}"
    # Published figures keep the digits they were printed with (29.12, 48.41).
    value = value.removesuffix("0") if measure.percent else value
    return value if cell.spread is None else f"{value} ± {cell.spread:.{digits}f}"


def _sizes(lines: Sequence[Line]) -> Iterator[str]:
    sizes = sorted({line.episodes for line in lines if line.ours})
    if sizes:
        counts = " or ".join(str(size) for size in sizes)
        yield f"Ours: {counts} episodes, 95 % intervals over episodes (Wilson for rates, else BCa)."


def _signed(value: float, measure: Measure) -> str:
    text = f"{100 * value:+.1f}" if measure.percent else f"{value:+.2f}"
    return text.replace("-", "−")


def _beside(each: Beside) -> tuple[str, ...]:
    return (
        each.row,
        each.measure.head,
        _cell(Cell(each.reported), each.measure),
        shown(each.ours.estimate, each.measure),
        interval_words(each.ours, each.measure),
        _signed(each.difference, each.measure),
        "inside" if each.inside else "outside",
    )


def _comparison(each: Comparison) -> tuple[str, ...]:
    success = each.success
    return (
        each.b,
        each.a,
        str(each.episodes),
        str(success.only_b),
        str(success.only_a),
        _p(success.p),
        _p(each.holm.get("sr")),
        _difference(each.spl, 100.0, 1),
        _p(each.holm.get("spl")),
        _difference(each.ne_m, 1.0, 2),
        _p(each.holm.get("ne_m")),
        each.words,
    )


def _difference(paired: PairedDifference | None, scale: float, digits: int) -> str:
    if paired is None:
        return NONE
    ends = (paired.difference.estimate, paired.difference.low, paired.difference.high)
    value, low, high = (
        f"{scale * end:+.{digits}f}".replace("-", "−") if math.isfinite(end) else NONE
        for end in ends
    )
    return f"{value} ({low} to {high})"


def _p(p: float | None) -> str:
    if p is None:
        return NONE
    return "< 0.001" if p < 0.001 else f"{p:.3f}"


def _share(interval: Interval | None) -> str:
    if interval is None:
        return NONE
    ends = (interval.estimate, interval.low, interval.high)
    return "{:.1f} ({:.1f} to {:.1f})".format(*(100 * end for end in ends))


def _behaviour(each: Behaviour) -> tuple[str, ...]:
    return (
        each.system,
        " = ".join(each.variants),
        str(each.episodes),
        _share(each.conversion),
        _share(each.success_zero_shot),
        ", ".join(f"{name} {count}" for name, count in sorted(each.outcomes.items())),
        NONE if each.invalid_share is None else f"{100 * each.invalid_share:.1f}",
        *(_plain(each.per_episode.get(name), 1) for name in COUNTS),
        _plain(each.tokens, 0),
    )


def _slot(use: SlotUse) -> tuple[str, ...]:
    latency = NONE if use.latency_s is None else "{:.3f}, {:.3f}".format(*use.latency_s)
    return (
        use.system,
        use.slot,
        str(use.traces),
        str(use.questions),
        str(use.queries),
        str(use.unusable),
        str(use.abstained),
        latency,
        _plain(use.tokens_in, 0),
        _plain(use.tokens_out, 0),
        _plain(use.cost_usd, 4),
    )


def _turning(each: Turnings) -> tuple[str, ...]:
    summary = each.summary
    slots = (f"{slot.value} {_counted(rate)}" for slot, rate in summary.by_slot.items())
    return (
        each.system,
        " = ".join(each.variants),
        str(summary.failures),
        str(summary.analysed),
        ", ".join(slots) or NONE,
        *(_counted(summary.verdicts[name]) for name in VERDICTS),
    )


def _counted(rate: Interval) -> str:
    return f"{round(rate.estimate * rate.n)}: {_share(rate)}"


def _plain(value: float | None, digits: int) -> str:
    return NONE if value is None else f"{value:.{digits}f}"
