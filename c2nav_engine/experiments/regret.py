"""Regret: how much farther from the goal a decision left the body than the best one offered.

Evaluation side; never read by the agent, never shown to someone who judges blind.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from c2nav_engine.contract.outcome import Key

GOOD_M = 0.1
"""A bundle that brings the goal at least this much nearer is a good one [C]."""
NOTHING_GOOD = "controller: nothing good offered"
VETOED = "vetoed"


def regret_m(goal_after_m: Mapping[Key, float], committed: Key) -> float:
    """Committed minus best offered, geodesic metres to the goal at the end of each bundle; ≥ 0.

    Infinite when only the committed one lost the goal; 0 when all did.

    Args:
        goal_after_m: For each offered alternative, g after its bundle (`truth.goal_after_m`).
        committed: One of them.
    """
    best_m = min(goal_after_m.values())
    return 0.0 if math.isinf(best_m) else goal_after_m[committed] - best_m


def controller_fault(
    offered_after_m: Mapping[Key, float], vetoed_after_m: Mapping[Key, float], *, here_m: float
) -> str:
    """Words where no answer could have been good: "vetoed", "controller: nothing good offered".

    Empty where an offered view was good, and the answer alone decides.

    Args:
        offered_after_m: g after the bundle along each offered view.
        vetoed_after_m: The same for views that were removed before the question.
        here_m: g now.
    """
    if any(here_m - after_m >= GOOD_M for after_m in offered_after_m.values()):
        return ""
    if any(here_m - after_m >= GOOD_M for after_m in vetoed_after_m.values()):
        return VETOED
    return NOTHING_GOOD
