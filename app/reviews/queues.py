"""In which order a person sees a study: their own, and never a later question first.

A later question of an episode tells what was answered before, so within an episode decisions come
in ascending order. For the same reason only an episode's last decision is ever repeated.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

APART = 20
"""[C] Least number of places between an item and its repetition."""

_TRIES = 200
"""Orders that are drawn before a repetition that finds no room is left out."""


@dataclass(frozen=True, slots=True)
class Place:
    """One place of a queue.

    Attributes:
        item: Number of the study's item.
        again: Whether it is the item's repetition.
    """

    item: int
    again: bool = False


def repeated(episodes: Sequence[str], *, share: float, seed: int) -> tuple[int, ...]:
    """Items to show twice: a share of all, drawn from the last item of each episode.

    Args:
        episodes: The episode of each item; items of one episode in ascending order.
        share: Of the items, as a fraction of one.
        seed: Of the draw.
    """
    last = sorted({episode: item for item, episode in enumerate(episodes)}.values())
    wanted = min(round(share * len(episodes)), len(last))
    if len(episodes) <= APART:
        return ()
    generator = np.random.default_rng(seed)
    return tuple(sorted(generator.choice(last, size=wanted, replace=False).tolist()))


def queue_of(
    episodes: Sequence[str], repeats: Sequence[int], *, seed: int, name: str
) -> tuple[Place, ...]:
    """A queue's places: a law of the study's seed and the queue's name, the same everywhere."""
    best: tuple[Place, ...] = ()
    for attempt in range(_TRIES):
        facts = hashlib.sha256(f"{seed}/{name}/{attempt}".encode()).digest()
        generator = np.random.default_rng(int.from_bytes(facts[:8], "big"))
        queue = _with_repeats(_ascending(episodes, repeats, generator), repeats, generator)
        if len(queue) > len(best):
            best = queue
        if len(best) == len(episodes) + len(repeats):
            break
    return best


def _ascending(
    episodes: Sequence[str], repeats: Sequence[int], generator: np.random.Generator
) -> list[int]:
    """A random order in which the items of each episode ascend; repeated ones rather early."""
    early = {episodes[item] for item in repeats}
    room = max(0.0, 1.0 - APART / max(1, len(episodes)))
    keys = generator.random(len(episodes)) * [
        room if episode in early else 1.0 for episode in episodes
    ]
    shuffled: list[int] = np.argsort(keys, kind="stable").tolist()
    rising = {
        episode: iter([item for item, other in enumerate(episodes) if other == episode])
        for episode in set(episodes)
    }
    return [next(rising[episodes[item]]) for item in shuffled]


def _with_repeats(
    order: Sequence[int], repeats: Sequence[int], generator: np.random.Generator
) -> tuple[Place, ...]:
    queue = [Place(item) for item in order]
    for item in repeats:
        earliest = queue.index(Place(item)) + APART
        # Whatever is put in later can only push an item and its repetition further apart.
        if earliest <= len(queue):
            queue.insert(int(generator.integers(earliest, len(queue) + 1)), Place(item, again=True))
    return tuple(queue)
