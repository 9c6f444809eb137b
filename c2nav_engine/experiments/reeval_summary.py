"""What a re-evaluation says at a glance, by decision slot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from c2nav_engine.experiments.reeval import Labelling
from c2nav_engine.experiments.statistics.agreement import Choice, Top1, top1
from c2nav_engine.experiments.statistics.intervals import Interval, wilson
from c2nav_engine.experiments.statistics.orders import Shown, first_excess, position_consistency

Record = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class SlotSummary:
    """One slot.

    Attributes:
        slot: Decision slot.
        decisions: Recorded questions.
        asked: Presentations.
        elected: Share of presentations that elected a winner.
        same_winner: Agreement with the recorded winner in the recorded order; None without any.
        position: Share of decisions whose winner stays when positions change under kept letters.
        letter: Share of presentations whose winner stays when letters change in place.
        first: How much more often than 1/m the first position wins.
        first_letter: How much more often than 1/m the letter A wins.
    """

    slot: str
    decisions: int
    asked: int
    elected: Interval
    same_winner: Top1 | None
    position: Interval
    letter: Interval
    first: Interval | None
    first_letter: Interval | None


def summarise(records: Sequence[Record]) -> tuple[SlotSummary, ...]:
    """One entry a slot that has ordinal questions."""
    slots = sorted({str(record["slot"]) for record in records})
    return tuple(_slot(slot, [r for r in records if r["slot"] == slot]) for slot in slots)


def _slot(slot: str, records: Sequence[Record]) -> SlotSummary:
    elected = [record for record in records if record["winner"] is not None]
    return SlotSummary(
        slot=slot,
        decisions=len({_decision(record) for record in records}),
        asked=len(records),
        elected=wilson(len(elected), len(records)),
        same_winner=top1(
            [
                Choice(record["winner"], record["recorded_winner"], record["options"])
                for record in elected
                if record["order"] == 0 and record["recorded_winner"] is not None
            ]
        ),
        # The recorded order's letters are the ones that are kept.
        position=position_consistency(
            [_shown(r) for r in records if r["order"] == 0 or r["labelling"] == Labelling.KEY]
        ),
        letter=_letter_consistency(records),
        first=first_excess([_shown(r) for r in records], seed=0),
        first_letter=first_excess([_by_letter(r) for r in records], seed=0),
    )


def _letter_consistency(records: Sequence[Record]) -> Interval:
    """Same positions, other letters: does the winner stay?"""
    pairs: dict[tuple[str, int, int], list[str | None]] = {}
    for record in records:
        if record["order"] != 0:
            pairs.setdefault((*_decision(record), record["order"]), []).append(record["winner"])
    whole = [winners for winners in pairs.values() if len(winners) == 2]
    same = sum(a == b and a is not None for a, b in whole)
    return wilson(same, len(whole))


def _shown(record: Record) -> Shown:
    """Keys by position."""
    return Shown(
        episode=(record["run"], record["episode_id"]),
        decision=_decision(record),
        order=tuple(record["keys"]),
        winner=record["winner"],
    )


def _by_letter(record: Record) -> Shown:
    """Keys by letter, A first."""
    keys = dict(zip(record["labels"], record["keys"], strict=True))
    shown = _shown(record)
    order = tuple(keys[label] for label in sorted(keys))
    return Shown(shown.episode, shown.decision, order, shown.winner)


def _decision(record: Record) -> tuple[str, int]:
    return str(record["trace_sha256"]), int(record["decision"])
