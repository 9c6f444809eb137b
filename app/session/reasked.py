"""Recorded questions that were asked again: rows beside the recorded answer, never in a trace."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from app.session.branches import Branch
from c2nav_engine.contract.outcome import Answered, Key
from c2nav_engine.traces.contract_messages import outcome_of
from c2nav_engine.traces.pb import common_pb2

KEPT = "key"
"""Labelling in which every alternative keeps its recorded letter and only positions change."""


@dataclass(frozen=True, slots=True)
class Reasked:
    """One presentation of a recorded question, answered anew.

    Attributes:
        ranker: Who was asked.
        shown: Keys, first position first.
        letters_kept: Whether letters stayed with their alternatives while positions changed.
        outcome: The answer, mapped back to keys.
    """

    ranker: str
    shown: tuple[Key, ...]
    letters_kept: bool
    outcome: Answered


ByDecision = Mapping[int, tuple[Reasked, ...]]
"""What a re-evaluation says of one recording."""

NOTHING: ByDecision = {}


def by_trace(rows: Iterable[Mapping[str, Any]]) -> dict[str, ByDecision]:
    """Rows of a re-evaluation, as digest of the trace → decision → answers in file order."""
    found: dict[str, dict[int, tuple[Reasked, ...]]] = {}
    for row in rows:
        decisions = found.setdefault(row["trace_sha256"], {})
        number = int(row["decision"])
        decisions[number] = (*decisions.get(number, ()), _reasked(row))
    return dict(found)


def _reasked(row: Mapping[str, Any]) -> Reasked:
    message = common_pb2.Outcome(
        kind=row["outcome"],
        tiers=[common_pb2.Tier(keys=tier) for tier in row["ranking"] or ()],
        reason=row["reason"] or "",
        value=row["value"] or 0.0,
    )
    kept = row["labelling"] == KEPT
    return Reasked(row["ranker"], tuple(row["keys"]), kept, outcome_of(message))


def shared_until(branch: Branch, branches: Iterable[Branch]) -> int | None:
    """The last decision whose question a branch has in common with its root; None for all."""
    by_id = {each.branch_id: each for each in branches}
    shared: int | None = None
    while branch.parent:
        left = branch.fork_decision
        shared = left if shared is None else min(shared, left)
        branch = by_id[branch.parent]
    return shared
