"""Who answered what, in one shape for people and models."""

from __future__ import annotations

from dataclasses import dataclass

from c2nav_engine.contract.outcome import Key
from c2nav_engine.experiments.statistics.orders import Shown


@dataclass(frozen=True, slots=True)
class Rater:
    """A person or a model.

    Attributes:
        name: Pseudonym, or the ranker's name.
        human: Whether it is a person.
    """

    name: str
    human: bool


@dataclass(frozen=True, slots=True)
class Answer:
    """One answer of one rater to one question.

    Attributes:
        rater: Who.
        question: Names what was asked, whatever the order shown; equal over runs.
        episode: Scene and episode.
        slot: Decision slot.
        keys: What was offered, sorted.
        tiers: Keys from best to worst; () when nothing was ranked.
    """

    rater: Rater
    question: str
    episode: str
    slot: str
    keys: tuple[Key, ...]
    tiers: tuple[tuple[Key, ...], ...]

    @property
    def winner(self) -> Key | None:
        """The single best, if there is one."""
        return self.tiers[0][0] if self.tiers and len(self.tiers[0]) == 1 else None


@dataclass(frozen=True, slots=True)
class Showing:
    """One presentation and what was elected: the material of order effects."""

    rater: Rater
    slot: str
    shown: Shown


@dataclass(frozen=True, slots=True)
class Answers:
    """Everything that was read.

    Attributes:
        given: One answer a rater and question: the first one where several were given.
        showings: Every presentation.
    """

    given: tuple[Answer, ...]
    showings: tuple[Showing, ...]
