"""Turning points on the run page: what one other answer would have made of the failures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from c2nav_engine.experiments.columns import Row
from c2nav_engine.experiments.statistics.intervals import Interval

if TYPE_CHECKING:
    from c2nav_engine.experiments.turning.summary import TurningSummary

RULES = {
    "one answer away": "one changed answer alone led to success in every run, unchanged in none",
    "not one answer away": "no changed answer led to success, at the decisions that were tried",
    "unstable": "only some runs of a change succeeded, or its unchanged control did",
    "lost by the controller": "even the truth fails with these views and gates · privileged",
    "not finished": "an answer that was to be tried was not",
}


@dataclass(frozen=True, slots=True)
class Share:
    """One class of the failures, or the part of it that fell in one slot.

    Attributes:
        words: What it is called.
        rule: What it means; "" for a slot.
        count: Failures in it.
        percent: Of the analysed ones.
        interval: Ends of the 95 % interval, in percent.
    """

    words: str
    rule: str
    count: int
    percent: str
    interval: str


@dataclass(frozen=True, slots=True)
class Turned:
    """The failures of one arm, each in one class.

    Attributes:
        failures: How many there are.
        analysed: How many of them a table of `c2nav turning` speaks of.
        shares: Every class, the slots of the first below it.
    """

    failures: int
    analysed: int
    shares: tuple[Share, ...]


def turned_of(folder: Path, members: Sequence[Row]) -> Turned | None:
    """What the tables in a run folder or beside it say; None where none speaks of these episodes.

    Args:
        folder: The run.
        members: Its rows of the index.
    """
    # The tables' reader takes a second to import, and few runs have one.
    from c2nav_engine.experiments.turning.summary import failed_traces, rows_beside, summary_of

    summary = summary_of(rows_beside(folder), failed_traces(members))
    if not summary.analysed:
        return None
    return Turned(summary.failures, summary.analysed, tuple(_shares(summary)))


def _shares(summary: TurningSummary) -> Iterator[Share]:
    from c2nav_engine.experiments.turning.flips import TURNING

    for verdict, rate in summary.verdicts.items():
        yield _share(verdict, RULES[verdict], rate)
        if verdict == TURNING:
            for slot, part in summary.by_slot.items():
                yield _share(f"in {slot.value}", "", part)


def _share(words: str, rule: str, rate: Interval) -> Share:
    return Share(
        words=words,
        rule=rule,
        count=round(rate.estimate * rate.n),
        percent=f"{100 * rate.estimate:.0f} %",
        interval=f"{100 * rate.low:.0f}–{100 * rate.high:.0f}",
    )
