"""(b) The last decision from which a noiseless observer still succeeds; privileged."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from c2nav_engine.experiments.rankers import seats_for
from c2nav_engine.experiments.turning.moments import Recording, going_on
from c2nav_engine.runner.episode_run import run_to_end

NOISELESS = {"d_prime": "1000", "sigma_c": "0", "beta": "0"}
"""Options of the simulated observer that make its evidence all but certain."""
LOOK_AHEAD = 3
"""Later decisions that are tried too, because recoverability may come back once [C]."""


@dataclass(frozen=True, slots=True)
class Recoverable:
    """How far into the episode the truth could still have saved it.

    Attributes:
        decision: The last such decision; None where not even the first is.
        tried: Decisions that were tried, with whether the observer succeeded from there.
    """

    decision: int | None
    tried: dict[int, bool]


def last_recoverable(recording: Recording) -> Recoverable:
    """The same fan, gates and vetoes, recorded answers before, the truth from there on.

    A robot that can be saved at a decision could nearly always be saved before it, so the boundary
    is found by bisection and the decisions just behind it are tried as well.
    """
    numbers = [e.decision for e in recording.questions if e.decision is not None]
    tried: dict[int, bool] = {}

    def saves(place: int) -> bool:
        number = numbers[place]
        if number not in tried:
            tried[number] = _saves(recording, number)
        return tried[number]

    boundary = _bisect(len(numbers), saves)
    for place in range(boundary + 1, min(boundary + 1 + LOOK_AHEAD, len(numbers))):
        if saves(place):
            boundary = place
    return Recoverable(numbers[boundary] if boundary >= 0 else None, dict(sorted(tried.items())))


def _bisect(count: int, saves: Callable[[int], bool]) -> int:
    """Largest place that saves, if all before it do; −1 when none does."""
    low, high = -1, count
    while high - low > 1:
        middle = (low + high) // 2
        if saves(middle):
            low = middle
        else:
            high = middle
    return low


def _saves(recording: Recording, decision: int) -> bool:
    run = going_on(recording, decision, seats_for("simulated", NOISELESS))
    return run_to_end(run).metrics.get("success") == 1
