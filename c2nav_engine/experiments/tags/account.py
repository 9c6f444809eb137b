"""A recorded episode as the rules read it: where the body went, and what was decided there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from c2nav_engine.contract.outcome import Answered, Key, Ordering
from c2nav_engine.experiments.truth import Course
from c2nav_engine.geometry import Pose
from c2nav_engine.metrics.trajectory import SUCCESS_M
from c2nav_engine.navigator.requests import (
    Ask,
    Event,
    Facts,
    Look,
    Move,
    Note,
    Stop,
    Unasked,
)
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.record import Footer, Header

WALK_BACK = "walk-back"
"""Name of the event, and of the motion, of going back to a marker."""


@dataclass(frozen=True, slots=True)
class Footpoint:
    """Where the body truly stood after some low-level step.

    Attributes:
        step: Low-level actions executed; 0 is the start.
        pose: True pose.
        goal_m: Geodesic distance to the goal; None where it was not measured.
        purpose: What the motion was for; "" at the start.
    """

    step: int
    pose: Pose
    goal_m: float | None
    purpose: str = ""


@dataclass(frozen=True)
class Account:
    """One recorded episode.

    Attributes:
        header: What was known before the first request.
        footer: How it ended.
        exchanges: Everything that happened; pictures may be digests only.
        course: The truth of its scene; None where the scene, or a reachable goal, is not there.
    """

    header: Header
    footer: Footer
    exchanges: Sequence[Exchange]
    course: Course | None = None

    @cached_property
    def way(self) -> tuple[Footpoint, ...]:
        """The start and the place after every step."""
        points = [Footpoint(0, self.header.episode.start, None)]
        for exchange in self.exchanges:
            truth = exchange.truth
            if truth is None or not truth.poses:
                continue
            distances_m = truth.goal_distances_m or (None,) * len(truth.poses)
            if isinstance(exchange.request, Move):
                purpose = exchange.request.purpose
                for place, (pose, goal_m) in enumerate(zip(truth.poses, distances_m, strict=True)):
                    points.append(Footpoint(exchange.step + place + 1, pose, goal_m, purpose))
            elif isinstance(exchange.request, Look) and points[-1].goal_m is None:
                points[-1] = Footpoint(
                    points[-1].step, truth.poses[0], distances_m[0], points[-1].purpose
                )
        return tuple(points)

    def at(self, step: int) -> Footpoint:
        """Where the body stood after that many steps, or at the end of what is recorded."""
        return self.way[min(step, len(self.way) - 1)]

    @cached_property
    def goal_distances_m(self) -> tuple[float, ...]:
        """Geodesic distances along the way, as far as they were measured."""
        return tuple(point.goal_m for point in self.way if point.goal_m is not None)

    @property
    def reached(self) -> bool | None:
        """Whether the body ever stood within the success radius; None where nobody measured."""
        distances_m = self.goal_distances_m
        return min(distances_m) < SUCCESS_M if distances_m else None

    @property
    def succeeded(self) -> bool | None:
        """Official success; None where nobody measured."""
        distances_m = self.goal_distances_m
        return self.stopped and distances_m[-1] < SUCCESS_M if distances_m else None

    @property
    def stopped(self) -> bool:
        """Whether STOP was called."""
        return any(isinstance(exchange.request, Stop) for exchange in self.exchanges)

    def questions(self) -> Iterator[tuple[Exchange, Ask]]:
        """Every question with its exchange, in order."""
        for exchange in self.exchanges:
            if isinstance(exchange.request, Ask):
                yield exchange, exchange.request

    def facts(self) -> Iterator[tuple[int, Facts]]:
        """(step, facts) of every decision, also of those that needed no question."""
        for exchange in self.exchanges:
            request = exchange.request
            if isinstance(request, Ask):
                yield exchange.step, request.facts
            elif isinstance(request, Note) and isinstance(request.record, Unasked):
                yield exchange.step, request.record.facts

    def events(self, name: str) -> Iterator[tuple[int, Event]]:
        """(step, event) of the events of that name."""
        for exchange in self.exchanges:
            record = exchange.request.record if isinstance(exchange.request, Note) else None
            if isinstance(record, Event) and record.name == name:
                yield exchange.step, record


def winner_of(outcome: Answered | None) -> Key | None:
    """What an outcome elects, if anything."""
    return outcome.winner if isinstance(outcome, Ordering) else None
