"""Who answered what, in one shape for people and models."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from c2nav_engine.contract.outcome import Key
from c2nav_engine.experiments.statistics.orders import Shown


@dataclass(frozen=True, slots=True)
class Rater:
    """A person or a model.

    Attributes:
        name: Pseudonym, or the ranker's name.
        human: Whether it is a person.
        privileged: Whether it knows the truth: then it stands apart from all others.
        seen: Whether it is a person who had seen the model's answer: they stand apart too.
    """

    name: str
    human: bool
    privileged: bool = False
    seen: bool = False


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
        beside_map: Whether a person gave it in the inspector, where more is in view than the
            model was sent.
    """

    rater: Rater
    question: str
    episode: str
    slot: str
    keys: tuple[Key, ...]
    tiers: tuple[tuple[Key, ...], ...]
    beside_map: bool = False

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
class Place:
    """Where a question was asked.

    Attributes:
        trace: The trace's file.
        decision: Decision number in that trace.
    """

    trace: Path
    decision: int


@dataclass(frozen=True, slots=True)
class Answers:
    """Everything that was read.

    Attributes:
        given: One answer a rater and question: the first one where several were given.
        showings: Every presentation.
        places: Question → where it was asked, as far as traces were read.
    """

    given: tuple[Answer, ...]
    showings: tuple[Showing, ...]
    places: Mapping[str, tuple[Place, ...]] = field(default_factory=dict[str, tuple[Place, ...]])

    @property
    def people(self) -> tuple[str, ...]:
        """Who ranked without having seen a model's answer, by name."""
        raters = {answer.rater for answer in self.given}
        return tuple(sorted(rater.name for rater in raters if rater.human and not rater.seen))

    @property
    def beside_map(self) -> int:
        """Answers that people gave blind in the inspector."""
        return sum(answer.beside_map and not answer.rater.seen for answer in self.given)
