"""What a question can come back with: eight outcomes, one of which selects.

Paper, "Ordinal Interface Contract": the model returns an ordering over offered alternatives.
Everything else it may do is a value too, so that no answer can be mistaken for a choice.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

Key = str
"""Names an alternative towards the controller ("left", "stay"); the model sees labels instead."""

ORDERS_DISAGREE = "orders disagree"
"""Reason of the abstention when two presentation orders give two winners."""


@dataclass(frozen=True, slots=True)
class Ordering:
    """Alternatives from best to worst, with one winner.

    Attributes:
        tiers: Keys by rank; the first tier holds exactly one, later tiers may be tied.
    """

    tiers: tuple[tuple[Key, ...], ...]

    def __post_init__(self) -> None:
        """Reject what is no ordering; raises `ValueError`."""
        keys = self.keys
        if not self.tiers or len(self.tiers[0]) != 1 or len(set(keys)) != len(keys):
            message = f"expected tiers of distinct keys under a single winner, came {self.tiers}"
            raise ValueError(message)

    @property
    def winner(self) -> Key:
        """The elected alternative."""
        return self.tiers[0][0]

    @property
    def keys(self) -> tuple[Key, ...]:
        """All keys, best first."""
        return tuple(key for tier in self.tiers for key in tier)

    @staticmethod
    def of(*keys: Key) -> Ordering:
        """A strict order, best first."""
        return Ordering(tuple((key,) for key in keys))

    @staticmethod
    def winner_only(winner: Key, keys: tuple[Key, ...]) -> Ordering:
        """The winner first, all others tied behind it."""
        rest = tuple(key for key in keys if key != winner)
        return Ordering(((winner,), rest) if rest else ((winner,),))


@dataclass(frozen=True, slots=True)
class Tie:
    """No single best: the first tier holds two or more keys."""

    tiers: tuple[tuple[Key, ...], ...]


@dataclass(frozen=True, slots=True)
class Abstention:
    """The evidence does not decide; `reason` says why."""

    reason: str


@dataclass(frozen=True, slots=True)
class Invalid:
    """An answer that names no ordering over the offered labels; `reason` says what it was."""

    reason: str


@dataclass(frozen=True, slots=True)
class Refused:
    """The model declined to answer."""


@dataclass(frozen=True, slots=True)
class Truncated:
    """The answer was cut off before it said anything usable."""


@dataclass(frozen=True, slots=True)
class Empty:
    """The answer held nothing."""


@dataclass(frozen=True, slots=True)
class TransportFailure:
    """No answer arrived; `reason` is what the transport said."""

    reason: str


@dataclass(frozen=True, slots=True)
class Cardinal:
    """The number or verdict of an inverted form; only the three inversions ever see one.

    Attributes:
        value: Degrees (left positive), progress 0–100, or 1.0 for yes and 0.0 for no, by form.
    """

    value: float


Outcome = Ordering | Tie | Abstention | Invalid | Refused | Truncated | Empty | TransportFailure
Answered = Outcome | Cardinal
Said = Ordering | Tie | Abstention
"""What a person can answer to a question: a ranking, a tie at the top, or none."""


def ranking_of(tiers: tuple[tuple[Key, ...], ...], offered: Iterable[Key] = ()) -> Ordering | Tie:
    """Tiers from best to worst as an outcome; what is `offered` and left out is tied behind."""
    named = {key for tier in tiers for key in tier}
    rest = tuple(key for key in offered if key not in named)
    whole = (*tiers, rest) if rest else tiers
    return Ordering(whole) if len(whole[0]) == 1 else Tie(whole)
