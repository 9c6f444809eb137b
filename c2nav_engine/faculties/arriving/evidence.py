"""Gathering terminal evidence: ground, journey, and a look back when the ladder hesitates."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass, replace

from c2nav_engine.contract import slots
from c2nav_engine.contract.outcome import Answered, Cardinal, Key, Ordering
from c2nav_engine.contract.question import Picture, Question, Slot
from c2nav_engine.contract.slots import Route
from c2nav_engine.faculties.arriving.ladder import Evidence, Verdict, verdict_of

Seeds = Callable[[Slot], int]
"""Presentation seed of a slot in this cycle."""
Asking = Generator[Question, Answered, "Reading"]
"""Yields questions, is sent outcomes, returns the reading."""


@dataclass(frozen=True, slots=True)
class Reading:
    """What one evaluation of the terminal evidence found.

    Attributes:
        evidence: After everything that was asked.
        verdict: After the last reading; never `inspect`.
        inspected: Whether the ladder read `inspect` on the way.
        looked_back: Whether a look-back was asked, and so spent.
    """

    evidence: Evidence
    verdict: Verdict
    inspected: bool = False
    looked_back: bool = False


def sign(answered: Answered, *, favours: Key) -> int:
    """±1 for an ordering by its winner, 0 for everything else."""
    if not isinstance(answered, Ordering):
        return 0
    return 1 if answered.winner == favours else -1


def evaluate(
    route: Route,
    view: Picture,
    *,
    seeds: Seeds,
    earlier: Sequence[Picture] | None,
    lookback: Picture | None,
    budget: int,
) -> Asking:
    """The whole ladder once: ground, journey, and at most one look-back.

    `inspect` without a frame or a budget is `hold`, and so is a second `inspect`.

    Args:
        route: What every question says about the route.
        view: The current front view.
        seeds: Presentation seed by slot.
        earlier: Thumbnails of the sketch; None leaves the journey unasked and undecided.
        lookback: The frame at the look-back distance behind, if there is one.
        budget: Look-backs left here.
    """
    answered = yield slots.ground(route, view, seed=seeds(Slot.GROUND))
    evidence = Evidence(ground=sign(answered, favours="here"), journey=0)
    if earlier is not None:
        answered = yield slots.journey(route, view, seed=seeds(Slot.JOURNEY), earlier=earlier)
        evidence = replace(evidence, journey=sign(answered, favours="covered"))
    verdict = verdict_of(evidence)
    if verdict is not Verdict.INSPECT:
        return Reading(evidence, verdict)
    if lookback is None or budget <= 0:
        return Reading(evidence, Verdict.HOLD, inspected=True)
    answered = yield slots.lookback(route, now=view, back=lookback, seed=seeds(Slot.LOOKBACK))
    evidence = replace(evidence, lookback=sign(answered, favours="now"))
    verdict = verdict_of(evidence)
    verdict = Verdict.HOLD if verdict is Verdict.INSPECT else verdict
    return Reading(evidence, verdict, inspected=True, looked_back=True)


def evaluate_absolute(route: Route, view: Picture, *, seeds: Seeds) -> Asking:
    """The terminal inversion: one view, "have you arrived, yes or no"."""
    question = slots.ground(route, view, seed=seeds(Slot.GROUND))
    answered = yield slots.terminal_absolute(question)
    if not isinstance(answered, Cardinal):
        return Reading(Evidence(0, 0), Verdict.HOLD)
    if answered.value > 0.0:
        return Reading(Evidence(1, 0), Verdict.STOP)
    return Reading(Evidence(-1, 0), Verdict.HOLD)


def evaluate_basic(route: Route, view: Picture, *, seeds: Seeds) -> Asking:
    """Ground alone: the basic stop of variants without Arriving; the caller counts the run."""
    answered = yield slots.ground(route, view, seed=seeds(Slot.GROUND))
    return Reading(Evidence(sign(answered, favours="here"), 0), Verdict.HOLD)
