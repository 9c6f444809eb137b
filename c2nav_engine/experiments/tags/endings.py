"""The failure budget: every episode stands in it once."""

from __future__ import annotations

import enum
from collections.abc import Mapping

from c2nav_engine.experiments.tags.account import Account
from c2nav_engine.runner.record import EpisodeOutcome

STILL_NEARING_M = 0.25
"""An end this near to the least distance of the way is one on the way there: one step [C]."""


class Ending(enum.StrEnum):
    """How an episode came out; success first, then the blocks of the budget."""

    SUCCESS = "success"
    NEVER_NEAR = "never within 3 m"
    REACHED = "reached, not stopped"
    STOPPED_ELSEWHERE = "stopped early or elsewhere"
    STEP_LIMIT = "step limit"
    STALLED = "stalled"
    ERROR = "error"
    UNKNOWN = "not measured"


FAILURES = tuple(ending for ending in Ending if ending not in (Ending.SUCCESS, Ending.UNKNOWN))
"""The blocks of the budget, in order."""

RULES: Mapping[Ending, str] = {
    Ending.SUCCESS: "STOP was called within 3 m of the goal",
    Ending.NEVER_NEAR: "the steps ran out, the goal was never within 3 m and no longer came nearer",
    Ending.REACHED: "the goal was within 3 m at some step, and STOP was never called",
    Ending.STOPPED_ELSEWHERE: "STOP was called 3 m or more from the goal",
    Ending.STEP_LIMIT: "the steps ran out while the goal, never within 3 m, still came nearer: "
    "the last place lies within one step of the nearest one",
    Ending.STALLED: "nothing could move any more, and the goal was never within 3 m",
    Ending.ERROR: "the episode ended in an error, or was interrupted",
    Ending.UNKNOWN: "the data hold no goal, so that nobody can tell",
}
"""What each block means, as the page says it."""


def ending_of(account: Account) -> Ending:
    """The one block an episode belongs to; the rules are `RULES`."""
    outcome = account.footer.outcome
    if outcome in (EpisodeOutcome.ERROR, EpisodeOutcome.INTERRUPTED):
        return Ending.ERROR
    if account.reached is None:
        return Ending.UNKNOWN
    if account.stopped:
        return Ending.SUCCESS if account.succeeded else Ending.STOPPED_ELSEWHERE
    if account.reached:
        return Ending.REACHED
    if outcome is EpisodeOutcome.STALLED:
        return Ending.STALLED
    distances_m = account.goal_distances_m
    nearing = distances_m[-1] - min(distances_m) <= STILL_NEARING_M
    return Ending.STEP_LIMIT if nearing else Ending.NEVER_NEAR
