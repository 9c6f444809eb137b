"""The report's plots as PDF and SVG, with words that stay words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from c2nav_engine.experiments.estimates import figure
from c2nav_engine.experiments.report.behaviour import SlotUse
from c2nav_engine.experiments.report.content import Chapter
from c2nav_engine.experiments.report.reported import Reported, reported_beside
from c2nav_engine.experiments.statistics.intervals import Interval

_INK, _REPORTED, _GRID = "#1f2933", "#b45309", "#d9dee3"
_COLOURS = ("#0f62fe", "#007d79", "#8a3ffc", "#b28600", "#a2191f", "#198038")
_STYLE = {
    "pdf.fonttype": 42,
    "svg.fonttype": "none",
    "svg.hashsalt": "c2nav",
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "axes.edgecolor": _INK,
    "text.color": _INK,
    "axes.labelcolor": _INK,
    "xtick.color": _INK,
    "ytick.color": _INK,
}
_SVG_FACTS = ("Date", "Creator", "Format", "Type")


@dataclass(frozen=True, slots=True)
class Plot:
    """One figure on disk.

    Attributes:
        title: What it shows.
        pdf: For papers.
        svg: For pages; its text can be searched.
    """

    title: str
    pdf: Path
    svg: Path


def write_plots(chapter: Chapter, folder: Path) -> list[Plot]:
    """Draw what the chapter holds; nothing for figures without data."""
    plots = [
        _rates(chapter, name, title, folder)
        for name, title in (("sr", "Success rate"), ("osr", "Oracle success rate"), ("spl", "SPL"))
    ]
    if any(use.latency_s and use.latency_s[1] > 0 for use in chapter.slots):
        plots.append(_latency(chapter, folder))
    return plots


def _rates(chapter: Chapter, name: str, title: str, folder: Path) -> Plot:
    """One line a variant and system: ours with its interval, the reported one as a diamond."""
    systems = chapter.section.systems
    shown: list[tuple[str, int, Interval, Reported | None]] = []
    for place, system in enumerate(systems):
        for arm in system.arms:
            found = figure(arm.rows, name)
            if found is not None:
                label = " = ".join(arm.variants)
                label = label if len(systems) == 1 else f"{label} · {system.label}"
                shown.append((label, place, found, _reported(chapter, arm.variants, system.ranker)))
    plt, axes, canvas = _canvas(height_in=0.6 + 0.24 * len(shown))
    for line, (_, place, interval, row) in enumerate(reversed(shown)):
        colour = _COLOURS[place % len(_COLOURS)]
        axes.plot([100 * interval.low, 100 * interval.high], [line, line], color=colour, lw=1.4)
        axes.plot([100 * interval.estimate], [line], "o", color=colour, ms=4)
        value = None if row is None else row.value(name)
        if value is not None:
            axes.plot([100 * value], [line], "D", mfc="none", mec=_REPORTED, ms=5)
    axes.set_yticks(range(len(shown)), [label for label, *_ in reversed(shown)])
    axes.set_ylim(-0.7, len(shown) - 0.3)
    axes.set_xlim(0, 100)
    diamonds = any(row is not None for *_, row in shown)
    axes.set_xlabel(f"{title}, % (95 % interval{'; ◇ reported' if diamonds else ''})")
    return _saved((plt, canvas), title, folder / f"{chapter.key}{name}")


def _reported(chapter: Chapter, variants: Sequence[str], ranker: str) -> Reported | None:
    """The reported row beside an arm: its backbone's for `full`, else the ablation's."""
    if chapter.section.privileged:
        return None
    return reported_beside(variants, ranker)


def _latency(chapter: Chapter, folder: Path) -> Plot:
    """Median and 95th percentile of a query, by slot."""
    timed: list[tuple[SlotUse, tuple[float, float]]] = [
        (use, use.latency_s) for use in chapter.slots if use.latency_s is not None
    ]
    plt, axes, canvas = _canvas(height_in=0.6 + 0.24 * len(timed))
    several = len(chapter.section.systems) > 1
    labels = [f"{use.slot} · {use.system}" if several else use.slot for use, _ in timed]
    for line, (_, (median_s, high_s)) in enumerate(reversed(timed)):
        axes.plot([median_s, high_s], [line, line], color=_COLOURS[0], lw=1.4)
        axes.plot([median_s], [line], "o", color=_COLOURS[0], ms=4)
    axes.set_yticks(range(len(timed)), labels[::-1])
    axes.set_ylim(-0.7, len(timed) - 0.3)
    axes.set_xlim(left=0)
    title = "Latency of a query"
    axes.set_xlabel("seconds a query (median to 95th percentile)")
    return _saved((plt, canvas), title, folder / f"{chapter.key}latency")


def _canvas(*, height_in: float) -> tuple[Any, Any, Any]:
    """The one door to matplotlib, which ships partial types."""
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    library: Any = mpl
    with library.rc_context(_STYLE):
        drawing: Any = Figure(figsize=(6.0, height_in), layout="constrained")
        FigureCanvasAgg(drawing)
        axes: Any = drawing.add_subplot()
        axes.grid(axis="x", color=_GRID, lw=0.6)
        axes.set_axisbelow(True)
        axes.spines[["top", "right", "left"]].set_visible(False)
        axes.tick_params(axis="y", length=0)
    return library, axes, drawing


def _saved(drawn: tuple[Any, Any], title: str, stem: Path) -> Plot:
    library, drawing = drawn
    plot = Plot(title, stem.with_name(f"{stem.name}.pdf"), stem.with_name(f"{stem.name}.svg"))
    # Dates and random ids are left out: the same rows give the same bytes.
    with library.rc_context(_STYLE):
        drawing.savefig(plot.pdf, metadata={"CreationDate": None, "Producer": None})
        drawing.savefig(plot.svg, metadata=dict.fromkeys(_SVG_FACTS))
    return plot
