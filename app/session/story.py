"""What a branch's exchanges tell, derived once and shared by every view.

Everything on the page is a function of a branch (header, exchanges, pending request, footer) and
of the stop where one stands. A live run and a trace give the same story.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from app.session.decisions import Decision, decisions_of
from app.session.track import Track, track_of
from c2nav_engine.navigator.requests import (
    Event,
    LadderState,
    Note,
    Request,
    SketchState,
)
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.record import Footer, Header


@dataclass(frozen=True, slots=True)
class Stop:
    """One place to stand: a decision, or a low-level step between decisions.

    Attributes:
        step: Low-level actions executed so far.
        decision: The decision here, else the last one before; −1 before the first.
        at_decision: Whether the decision is taken here.
    """

    step: int
    decision: int
    at_decision: bool


@dataclass(frozen=True, slots=True)
class Story:
    """A branch, read.

    Attributes:
        header: What was known before the first request.
        decisions: In order, the pending one last.
        track: The way through the world.
        stops: Every place to stand, in order; never empty.
        sketches: Exchange index → sketch after that exchange.
        ladders: Exchange index → evidence after that exchange.
        events: Exchange index, step and event, in order.
        footer: How it ended; None while it runs.
        length: Number of exchanges read.
    """

    header: Header
    decisions: tuple[Decision, ...]
    track: Track
    stops: tuple[Stop, ...]
    sketches: tuple[tuple[int, SketchState], ...]
    ladders: tuple[tuple[int, LadderState], ...]
    events: tuple[tuple[int, int, Event], ...]
    footer: Footer | None
    length: int

    @property
    def pending(self) -> Decision | None:
        """The decision that waits for an answer."""
        last = self.decisions[-1] if self.decisions else None
        return last if last is not None and last.pending else None

    def decision_at(self, stop: int) -> Decision | None:
        """The decision at a stop, or the last one before it."""
        number = self.stops[stop].decision
        return self.decisions[number] if 0 <= number < len(self.decisions) else None

    def stop_of_decision(self, number: int) -> int:
        """The stop where a decision is taken; the nearest where there is none."""
        for index, stop in enumerate(self.stops):
            if stop.at_decision and stop.decision >= number:
                return index
        return len(self.stops) - 1

    def stop_of_step(self, step: int) -> int:
        """The last stop at or before a step."""
        best = 0
        for index, stop in enumerate(self.stops):
            if stop.step > step:
                break
            best = index
        return best

    def end_of(self, decision: int) -> int:
        """Index of the exchange where the next decision begins."""
        if decision + 1 < len(self.decisions):
            return self.decisions[decision + 1].exchange
        return self.length


def story_of(
    header: Header,
    exchanges: Sequence[Exchange],
    *,
    pending: Request | None,
    footer: Footer | None,
) -> Story:
    """Read a branch."""
    decisions = decisions_of(exchanges, pending)
    track = track_of(exchanges, header.episode.start)
    notes = [
        (exchange.index, exchange.step, exchange.request.record)
        for exchange in exchanges
        if isinstance(exchange.request, Note)
    ]
    return Story(
        header=header,
        decisions=decisions,
        track=track,
        stops=_stops(decisions, track),
        sketches=tuple((index, n) for index, _, n in notes if isinstance(n, SketchState)),
        ladders=tuple((index, n) for index, _, n in notes if isinstance(n, LadderState)),
        events=tuple((index, step, n) for index, step, n in notes if isinstance(n, Event)),
        footer=footer,
        length=len(exchanges),
    )


def _stops(decisions: Sequence[Decision], track: Track) -> tuple[Stop, ...]:
    stops: list[Stop] = []
    upcoming = 0
    for footstep in track.footsteps:
        here = footstep.step
        before = upcoming
        while upcoming < len(decisions) and decisions[upcoming].step <= here:
            stops.append(Stop(here, upcoming, at_decision=True))
            upcoming += 1
        if upcoming == before:
            stops.append(Stop(here, upcoming - 1, at_decision=False))
    return tuple(stops)
