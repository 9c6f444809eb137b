"""Which decisions a study asks people about: even over the slots, few from one episode."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from c2nav_engine.contract.presentation import ORDINAL_FORMS
from c2nav_engine.errors import UsageError
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.recorded import OpenTrace, open_trace

MOST_AN_EPISODE = 3
"""[C] Decisions of one episode in a study, over all of its traces."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """A recorded question that could be judged.

    Attributes:
        trace: The trace's file.
        trace_sha256: Its digest.
        decision: Decision number in that trace.
        episode: Scene and episode: what counts as one episode over variants and seeds.
        slot: Decision slot.
    """

    trace: Path
    trace_sha256: str
    decision: int
    episode: str
    slot: str


def candidates_of(runs: Sequence[Path]) -> list[Candidate]:
    """Every recorded question of these runs that asked for an order, in a fixed order.

    Raises:
        UsageError: A folder holds no finished trace.
    """
    found: list[Candidate] = []
    for run in runs:
        traces = sorted((run / "traces").glob("*.mcap"))
        if not traces:
            message = f"expected a run folder with finished traces, came {run}: none in its traces/"
            raise UsageError(message)
        for path in traces:
            with open_trace(path) as trace:
                found += _questions(trace)
    return sorted(found, key=lambda one: (one.episode, one.trace_sha256, one.decision))


def _questions(trace: OpenTrace) -> list[Candidate]:
    episode = trace.header.episode
    name = f"{episode.scene_id}/{episode.episode_id}"
    return [
        Candidate(
            trace.path,
            trace.sha256,
            exchange.decision,
            name,
            exchange.request.question.slot.value,
        )
        for exchange in trace.decisions()
        if exchange.decision is not None
        and isinstance(exchange.request, Ask)
        and exchange.request.question.form in ORDINAL_FORMS
        and exchange.ranked is not None
        and exchange.ranked.queries
    ]


def drawn(
    candidates: Sequence[Candidate],
    *,
    per_slot: int,
    seed: int,
    most: int = MOST_AN_EPISODE,
) -> list[Candidate]:
    """Up to `per_slot` decisions of each slot, at most `most` an episode.

    Slots draw one decision each in turn, the scarcest first: none uses up the episodes that
    another one needs.
    """
    generator = np.random.default_rng(seed)
    order: list[int] = generator.permutation(len(candidates)).tolist()
    shuffled = [candidates[index] for index in order]
    left = {slot: [one for one in shuffled if one.slot == slot] for slot in _slots(candidates)}
    taken: Counter[str] = Counter()
    chosen: list[Candidate] = []
    for _ in range(per_slot):
        for slot in sorted(left, key=lambda slot: (len(left[slot]), slot)):
            free = [one for one in left[slot] if taken[one.episode] < most]
            if free:
                # From the episode that has given least, so that many episodes are heard.
                one = min(free, key=lambda one: taken[one.episode])
                left[slot].remove(one)
                taken[one.episode] += 1
                chosen.append(one)
    return sorted(chosen, key=lambda one: (one.episode, one.decision, one.trace_sha256))


def _slots(candidates: Sequence[Candidate]) -> list[str]:
    return sorted({one.slot for one in candidates})
