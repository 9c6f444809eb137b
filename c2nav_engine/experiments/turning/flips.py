"""(c) One answer away: the same ranker goes on after a changed answer, beside a control."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from c2nav_engine.contract.outcome import Abstention, Answered, Key, Ordering
from c2nav_engine.contract.question import Form, Slot
from c2nav_engine.experiments.turning.moments import Recording, going_on
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.episode_run import run_to_end
from c2nav_engine.runner.exchange import Exchange, Override
from c2nav_engine.runner.opening import SeatFor

UNDECIDED = "undecided"
"""The third answer of terminal evidence: neither for nor against."""
TERMINAL = frozenset({Slot.GROUND, Slot.JOURNEY, Slot.LOOKBACK})

TURNING = "one answer away"
UNSTABLE = "unstable"
NO_CHANGE = "no success"


@dataclass(frozen=True, slots=True)
class Flip:
    """One changed answer, run as often as its unchanged control.

    Attributes:
        decision: Number.
        slot: Decision slot.
        answer: What was committed instead: a key, or "undecided".
        changed: Successes with the change.
        control: Successes of the unchanged decision, run on by the same ranker.
        repeats: Runs of each.
        queries: Queries that all these runs took.
    """

    decision: int
    slot: Slot
    answer: str
    changed: int
    control: int
    repeats: int
    queries: int

    @property
    def verdict(self) -> str:
        """A turning point only where every change and no control succeeded."""
        if self.control > 0 or 0 < self.changed < self.repeats:
            return UNSTABLE
        return TURNING if self.changed else NO_CHANGE


def other_answers(exchange: Exchange) -> list[tuple[str, Answered]]:
    """Each other feasible answer: another winner, stay or next; for, against or undecided."""
    request = exchange.request
    if not isinstance(request, Ask) or request.question.form not in {Form.ORDINAL, Form.ACTION}:
        return []
    keys = request.question.keys
    committed: Key = exchange.response.winner if isinstance(exchange.response, Ordering) else ""
    found: list[tuple[str, Answered]] = [
        (key, Ordering.winner_only(key, keys)) for key in keys if key != committed
    ]
    if request.question.slot in TERMINAL and committed:
        found.append((UNDECIDED, Abstention(UNDECIDED)))
    return found


@dataclass(frozen=True, slots=True)
class Budget:
    """How much may be asked.

    Attributes:
        repeats: Runs of each changed and unchanged decision.
        max_queries: Queries after which no new answer is tried; None for no limit.
    """

    repeats: int = 3
    max_queries: int | None = None


def flips_of(
    recording: Recording,
    decisions: Sequence[int],
    seat_for: SeatFor,
    *,
    budget: Budget,
    known: Callable[[int, str], bool],
) -> Iterator[Flip]:
    """Try every other answer of the given decisions, worst first; a generator can be left early.

    Args:
        recording: The failed episode.
        decisions: Which decisions to change, in this order.
        seat_for: The ranker that made the recording, going on.
        budget: Repeats and most queries.
        known: Whether a (decision, answer) was tried by an earlier, interrupted call.
    """
    spent = 0
    by_number = {exchange.decision: exchange for exchange in recording.questions}
    for number in decisions:
        exchange = by_number[number]
        todo = [(a, o) for a, o in other_answers(exchange) if not known(number, a)]
        if not todo or not isinstance(exchange.request, Ask):
            continue
        control, asked = _successes(recording, exchange, None, (seat_for, budget.repeats))
        spent += asked
        for answer, outcome in todo:
            if budget.max_queries is not None and spent >= budget.max_queries:
                return
            changed, more = _successes(recording, exchange, outcome, (seat_for, budget.repeats))
            spent += more
            yield Flip(
                decision=number,
                slot=exchange.request.question.slot,
                answer=answer,
                changed=changed,
                control=control,
                repeats=budget.repeats,
                queries=asked + more,
            )
            asked = 0


def _successes(
    recording: Recording,
    exchange: Exchange,
    outcome: Answered | None,
    how: tuple[SeatFor, int],
) -> tuple[int, int]:
    """(successes, queries) of going on from one decision; the control keeps its own answer."""
    seat_for, repeats = how
    response = exchange.response if outcome is None else outcome
    if exchange.decision is None or response is None:
        return 0, 0
    successes = queries = 0
    for _ in range(repeats):
        override = Override(response, "turning points")  # pyright: ignore[reportArgumentType]
        run = going_on(recording, exchange.decision, seat_for, override=override)
        footer = run_to_end(run)
        successes += footer.metrics.get("success") == 1
        before = exchange.index
        queries += sum(len(e.ranked.queries) for e in run.exchanges[before:] if e.ranked)
    return successes, queries
