"""Plain words for what happened: the page's vocabulary, said once."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence

from c2nav_engine.contract.outcome import (
    Abstention,
    Answered,
    Cardinal,
    Empty,
    Invalid,
    Key,
    Ordering,
    Refused,
    Tie,
    TransportFailure,
    Truncated,
)
from c2nav_engine.contract.question import Slot
from c2nav_engine.navigator.requests import Action, Step

SIGNS = ("●", "▲", "■")
"""Of the lanes Seeing, Transition, Arriving."""

_SLOTS: Mapping[Slot, str] = {
    Slot.SEEING: "Seeing",
    Slot.GLANCE: "Junction glance",
    Slot.DIRECT: "Direct action",
    Slot.TRANSITION: "Transition",
    Slot.GROUND: "Arriving: ground",
    Slot.JOURNEY: "Arriving: journey",
    Slot.LOOKBACK: "Arriving: look-back",
}

_KEYS: Mapping[Key, str] = {
    "front": "ahead",
    "now": "this frame",
    "back": "earlier frame",
    **{f"sector{k}": f"sector {k + 1}" for k in range(6)},
}


def slot_words(slot: Slot) -> str:
    """What a slot is called."""
    return _SLOTS[slot]


def key_words(key: Key) -> str:
    """What an alternative is called beside its letter."""
    return _KEYS.get(key, key)


def ordinal(rank: int) -> str:
    """1 → "1st"."""
    return f"{rank}{ {1: 'st', 2: 'nd', 3: 'rd'}.get(rank, 'th') }"


def ranking(tiers: Sequence[Sequence[Key]], letters: Mapping[Key, str]) -> str:
    """Tiers in letters: "B > A = C"."""
    return " > ".join(
        " = ".join(sorted(letters.get(key, key_words(key)) for key in tier)) for tier in tiers
    )


def outcome_words(outcome: Answered | None, letters: Mapping[Key, str]) -> str:
    """An outcome in a few words."""
    match outcome:
        case None:
            return ""
        case Ordering():
            return ranking(outcome.tiers, letters)
        case Tie():
            return f"tie: {ranking(outcome.tiers, letters)}"
        case Abstention() | Invalid() | TransportFailure():
            name = "abstained" if isinstance(outcome, Abstention) else "no usable answer"
            return f"{name}: {outcome.reason}" if outcome.reason else name
        case Cardinal():
            return f"{outcome.value:g}"
        case Refused() | Truncated() | Empty():
            return type(outcome).__name__.lower()


def is_fault(outcome: Answered | None) -> bool:
    """Whether an outcome is a bad answer rather than an honest abstention."""
    return isinstance(outcome, Invalid | Refused | Truncated | Empty | TransportFailure)


def motion_words(steps: Sequence[Step], turn_rad: float) -> str:
    """What the body did: "turn left 45°, 3 steps (0.75 m)"."""
    counts = Counter(step.action for step in steps)
    words: list[str] = []
    for action, name in ((Action.LEFT, "left"), (Action.RIGHT, "right")):
        if counts[action]:
            words.append(f"turn {name} {degrees(turn_rad * counts[action])}")
    if counts[Action.FORWARD]:
        moved_m = sum(step.moved_m for step in steps if step.action is Action.FORWARD)
        words.append(f"{plural(counts[Action.FORWARD], 'step')} ({moved_m:.2f} m)")
    if counts[Action.STOP]:
        words.append("stop")
    if any(step.collided for step in steps):
        words.append("collided")
    return ", ".join(words) or "no motion"


def degrees(angle_rad: float) -> str:
    """Radians as whole degrees."""
    return f"{round(math.degrees(angle_rad))}°".replace("-", "−")


def plural(count: int, noun: str) -> str:
    """A count with its noun, in the plural where needed."""
    if noun == "query":
        return f"{count:,} {'query' if count == 1 else 'queries'}"
    return f"{count:,} {noun}{'' if count == 1 else 's'}"


def seconds(duration_s: float) -> str:
    """A duration for people."""
    if duration_s < 10.0:
        return f"{duration_s:.1f} s"
    if duration_s < 120.0:
        return f"{duration_s:.0f} s"
    return f"{duration_s / 60.0:.0f} min"
