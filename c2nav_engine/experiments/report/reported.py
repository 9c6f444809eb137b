"""What the paper and its baselines report: reference rows, never data of ours.

Percentages as printed. There are no per-episode outcomes behind them, so that no paired test
against them is possible: ours can only be said to hold them inside its interval or not.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

OPENNAV_100_SHA256 = "742f0d064756fba5b530bf0a682ff51928716f1a93a6521e63ae5c43214f893c"
"""The episode file behind every reported row: `OpenNav_R2R-CE_100`."""

ABLATED_BACKBONE = "Qwen3-VL-8B"
"""Backbone of the paper's ablations and role inversions."""


@dataclass(frozen=True, slots=True)
class Reported:
    """One row of a published table.

    Attributes:
        labels: Its leading cells: method, backbone and waypoint-freedom, or the variant's name.
        osr: Oracle success, percent.
        sr: Success, percent.
        spl: Success weighted by path length, percent.
        ne_m: Navigation error; None where the table has none.
        spread: Reported standard deviation by figure, in the same unit.
    """

    labels: tuple[str, ...]
    osr: float
    sr: float
    spl: float
    ne_m: float | None = None
    spread: Mapping[str, float] | None = None

    def value(self, figure: str) -> float | None:
        """The figure in the unit of our rows: rates as fractions of one, metres."""
        shares = {"osr": self.osr, "sr": self.sr, "spl": self.spl}
        return round(shares[figure] / 100.0, 6) if figure in shares else self.ne_m


def _row(*labels: str, ne: float | None = None, rates: tuple[float, float, float]) -> Reported:
    osr, sr, spl = rates
    return Reported(labels, osr, sr, spl, ne)


_LAVIRA_GPT = Reported(
    ("LaViRA", "GPT-4o / Qwen2.5-VL-32B", "Yes"),
    43.3,
    36.0,
    28.3,
    6.43,
    {"ne_m": 0.28, "osr": 3.2, "sr": 1.7, "spl": 0.8},
)
_LAVIRA_GEMINI = Reported(
    ("LaViRA", "Gemini-2.5-Pro / Qwen2.5-VL-32B", "Yes"),
    48.7,
    38.3,
    28.3,
    6.54,
    {"ne_m": 0.27, "osr": 2.1, "sr": 0.6, "spl": 0.9},
)

BASELINES: tuple[Reported, ...] = (
    _row("Random", "–", "–", ne=8.63, rates=(12.0, 2.0, 1.5)),
    _row("NavGPT-CE", "GPT-4", "No", ne=8.37, rates=(26.9, 16.3, 10.2)),
    _row("DiscussNav-CE", "GPT-4", "No", ne=7.77, rates=(15.0, 11.0, 10.5)),
    _row("MapGPT-CE", "GPT-4o", "Yes", ne=8.16, rates=(21.0, 7.0, 5.0)),
    _row("Open-Nav", "GPT-4", "No", ne=6.70, rates=(23.0, 19.0, 16.1)),
    _row("SmartWay", "GPT-4o", "No", ne=7.01, rates=(51.0, 29.0, 22.5)),
    _row("InstructNav", "GPT-4", "Yes", ne=6.89, rates=(47.0, 31.0, 24.0)),
    _row("CA-Nav", "GPT-4", "Yes", ne=7.58, rates=(48.0, 25.3, 10.8)),
    _row("Three-Step Nav", "GPT-5 (2025-08-07)", "No", ne=5.87, rates=(39.0, 34.0, 29.12)),
    _LAVIRA_GPT,
    _LAVIRA_GEMINI,
    _row("AgenticNav", "GPT-5.5", "Yes", ne=5.19, rates=(65.0, 55.0, 48.41)),
)
"""Table 1, upper block, transcribed by the paper from the cited primary papers."""

RANDOM = BASELINES[0]

BACKBONES: tuple[Reported, ...] = (
    _row("Qwen3-VL-4B", ne=9.30, rates=(36.0, 28.0, 15.5)),
    _row("Qwen3-VL-8B-Instruct", ne=8.89, rates=(41.0, 31.0, 16.7)),
    _row("Qwen3-VL-32B", ne=8.10, rates=(48.0, 39.0, 23.5)),
    _row("GPT-5.5", ne=7.20, rates=(54.0, 44.0, 29.0)),
)
"""Table 2: the same interface with four backbones."""

MAIN_BACKBONES = ("Qwen3-VL-8B-Instruct", "GPT-5.5")
"""Which of them stand in Table 1."""

FACULTIES: Mapping[str, Reported] = {
    "base": _row("Base navigator", "–", "–", "–", rates=(30.0, 18.0, 11.7)),
    "seeing": _row("+ Seeing (A)", "✓", "–", "–", rates=(42.0, 25.0, 10.9)),
    "seeing-remembering": _row("+ A + Remembering (B)", "✓", "✓", "–", rates=(37.0, 29.0, 16.2)),
    "full": _row("Full (A+B+C)", "✓", "✓", "✓", rates=(41.0, 31.0, 16.7)),
    "no-seeing": _row("− Seeing (A)", "–", "✓", "✓", rates=(30.0, 14.0, 6.1)),
    "no-remembering": _row("− Remembering (B)", "✓", "–", "✓", rates=(41.0, 25.0, 10.9)),
    "no-arriving": _row("− Arriving (C)", "✓", "✓", "–", rates=(37.0, 29.0, 16.2)),
}
"""Table 3 by preset; the first four add up, the last three take away."""

COMPONENTS: Mapping[str, Reported] = {
    "no-sketch": _row("− Route Sketch", rates=(36.0, 27.0, 14.4)),
    "no-transition": _row("− contrastive Transition", rates=(43.0, 26.0, 10.8)),
    "no-walkback": _row("− Walk-Back", rates=(36.0, 26.0, 14.1)),
}
"""Component-level removals, from the text of "Ablation Studies"."""

INVERSIONS: Mapping[str, Reported] = {
    "full": _row("Full ordinal interface", rates=(41.0, 31.0, 16.7)),
    "spatial-cardinal": _row("Spatial: cardinal commitment", rates=(30.0, 12.0, 5.3)),
    "transition-cardinal": _row("Transition: cardinal progress", rates=(40.0, 28.0, 14.8)),
    "terminal-absolute": _row("Terminal: absolute arrival", rates=(28.0, 21.0, 9.7)),
}
"""Table 4 by preset."""


def backbone_of(ranker: str) -> Reported | None:
    """The row of the backbone that a ranker's name speaks of; None when the paper has none."""
    folded = ranker.casefold()
    names = {row.labels[0].casefold().removesuffix("-instruct"): row for row in BACKBONES}
    return next((row for name, row in names.items() if name in folded), None)


def reported_beside(variants: Iterable[str], ranker: str) -> Reported | None:
    """The row beside a configuration: its backbone's for `full`, else the ablation's or None."""
    variants = tuple(variants)
    if "full" in variants and (row := backbone_of(ranker)) is not None:
        return row
    known = {**FACULTIES, **COMPONENTS, **INVERSIONS}
    return next((known[variant] for variant in variants if variant in known), None)
