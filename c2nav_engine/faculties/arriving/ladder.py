"""The hesitation ladder: evidence (ground, journey, look-back) → hold, inspect or stop.

All 27 rows in one table [C]; the same table stands in the documentation.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass


class Verdict(enum.StrEnum):
    """What the ladder reads."""

    HOLD = "hold"
    INSPECT = "inspect"
    STOP = "stop"


@dataclass(frozen=True, slots=True)
class Evidence:
    """Categorical bookkeeping of comparisons (paper, eq. 6); cleared every cycle.

    Attributes:
        ground: −1 against, 0 undecided, +1 for stopping.
        journey: The same for the recorded journey.
        lookback: The same for the look-back comparison; 0 until asked.
    """

    ground: int
    journey: int
    lookback: int = 0


_H, _I, _S = Verdict.HOLD, Verdict.INSPECT, Verdict.STOP

# Rows (ground, journey); columns look-back −1, 0, +1.
_ROWS: dict[tuple[int, int], tuple[Verdict, Verdict, Verdict]] = {
    (-1, -1): (_H, _H, _H),
    (-1, 0): (_H, _H, _H),
    (-1, 1): (_H, _H, _H),
    (0, -1): (_H, _H, _H),
    (0, 0): (_H, _H, _H),
    (0, 1): (_H, _I, _S),
    (1, -1): (_H, _H, _H),
    (1, 0): (_H, _I, _S),
    (1, 1): (_H, _S, _S),
}

LADDER: dict[tuple[int, int, int], Verdict] = {
    (ground, journey, lookback): row[lookback + 1]
    for (ground, journey), row in _ROWS.items()
    for lookback in (-1, 0, 1)
}
"""(ground, journey, look-back) → verdict."""


def verdict_of(evidence: Evidence) -> Verdict:
    """Read the ladder."""
    return LADDER[evidence.ground, evidence.journey, evidence.lookback]
