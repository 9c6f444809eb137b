"""A small play for the inspector: an episode without a simulator, driven like the real one.

The body walks a known path; views are painted, not rendered. Everything that the page can show
occurs: vetoed views, a contested election, orders that disagree, a transition, the ladder, a
fallback. The same script runs live, is replayed up to a decision and forked.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.reviews.audit import AuditBook
from app.session.opened import Choice, Entry, ForkAt, Opened, Opening
from app.session.shelf import OpenBook
from c2nav_engine.contract.prompt import Ranked
from c2nav_engine.contract.question import Question
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.geometry import Pose
from c2nav_engine.navigator.requests import (
    Action,
    Ask,
    DepthStats,
    Look,
    Move,
    Moved,
    Request,
    Seen,
    Step,
    Stop,
    View,
)
from c2nav_engine.rankers.tally import Telling
from c2nav_engine.runner.exchange import Exchange, Override, Truth
from c2nav_engine.runner.record import EpisodeOutcome, Footer, Header
from tests.helpers.stage_script import (
    EPISODE,
    OFFSETS,
    PATH,
    Script,
    contrast_of,
    distance_m,
    facts_of,
    header,
    painted,
    ranked_as,
    script,
    scripted_answer,
)

__all__ = [
    "EPISODE",
    "OFFSETS",
    "PATH",
    "PlayRun",
    "contrast_of",
    "facts_of",
    "finished_run",
    "fork_of",
    "header",
    "in_memory",
    "live_run",
    "opened_live",
    "opened_recording",
    "ranked_as",
    "scripted_answer",
]


@dataclass
class PlayRun:
    """Drives the script as `EpisodeRun` drives the navigator."""

    header: Header
    script: Script
    delay_s: float = 0.0
    gate: threading.Event | None = None
    answer: Callable[[Question, Pose], Ranked] | None = None
    surface: Any = None

    def __post_init__(self) -> None:
        self.exchanges: list[Exchange] = []
        self.footer: Footer | None = None
        self.trace_sha256 = ""
        self.trace = f"logs/inspected/1.full.at{self.header.fork_decision}.mcap"
        self.pending: Request | None = next(self.script)
        self._pose = EPISODE.start
        self._steps = 0
        self._decisions = 0
        self._proposal: Ranked | None = None
        self.told: Telling | None = None
        self.closed = False
        self.kept: dict[str, bytes] = {}

    def propose(self, told: Telling | None = None) -> Ranked:
        assert isinstance(self.pending, Ask)
        request = self.pending
        self.told = told
        if self._proposal is None:
            time.sleep(self.delay_s)
            if self.gate is not None:
                assert self.gate.wait(60.0)
            answer = self.answer or (lambda question, _: scripted_answer(question))
            ranked = answer(request.question, self._pose)
            if self.pending is not request:
                return ranked
            self._proposal = ranked
        return self._proposal

    def advance(self) -> Exchange:
        request = self.pending
        assert request is not None
        if isinstance(request, Ask):
            self.propose()
            return self.commit()
        return self._finish(request, *self._respond(request))

    def commit(self, override: Override | None = None) -> Exchange:
        request = self.pending
        assert isinstance(request, Ask)
        ranked = self._proposal
        if ranked is None and override is None:
            ranked = self.propose()
        outcome = override.outcome if override else ranked.outcome if ranked else None
        return self._finish(request, outcome, None, ranked=ranked, override=override)

    def keep(self, name: str, data: bytes) -> None:
        self.kept.setdefault(name, data)

    def close(self) -> None:
        self.closed = True

    def _respond(self, request: Request) -> tuple[Any, Truth | None]:
        if isinstance(request, Look):
            distance = distance_m(self._pose.position_m)
            return _looked(self._pose, self._steps), Truth((self._pose,), (distance,))
        if isinstance(request, Move):
            return self._walk(request.actions)
        return None, None

    def _walk(self, actions: Sequence[Action]) -> tuple[Moved, Truth]:
        steps: list[Step] = []
        for action in actions:
            before = self._pose
            if action is Action.FORWARD:
                self._pose = Pose(before.ahead(0.25), before.yaw_rad)
            else:
                sign = 1.0 if action is Action.LEFT else -1.0
                self._pose = before.turned(sign * VLNCE.turn_rad)
            moved_m = math.dist(before.position_m, self._pose.position_m)
            steps.append(Step(action, self._pose, moved_m, collided=False))
        poses = tuple(step.odometry for step in steps)
        return Moved(tuple(steps)), Truth(poses, tuple(distance_m(p.position_m) for p in poses))

    def _finish(
        self,
        request: Request,
        response: Any,
        truth: Truth | None,
        *,
        ranked: Ranked | None = None,
        override: Override | None = None,
    ) -> Exchange:
        decision = self._decisions if isinstance(request, Ask) else None
        self._decisions += decision is not None
        exchange = Exchange(
            len(self.exchanges), self._steps, decision, request, response, ranked, override, truth
        )
        self.exchanges.append(exchange)
        if isinstance(response, Moved):
            self._steps += len(response.steps)
        self._proposal = None
        try:
            self.pending = self.script.send(response)
        except StopIteration:
            self.pending = None
            left_m = distance_m(self._pose.position_m)
            stopped = isinstance(request, Stop)
            outcome = EpisodeOutcome.STOPPED if stopped else EpisodeOutcome.STALLED
            success = int(stopped and left_m < 3.0)
            self.footer = Footer(outcome, {"ne_m": left_m, "success": success, "os": success})
        return exchange


def _looked(pose: Pose, step: int) -> Seen:
    views = tuple(
        View(
            key,
            offset,
            painted(step * 7 + n),
            free_m=0.3 if (key == "right" and step % 2 == 0) else 3.4 - n,
            depth=DepthStats(2.0, 0.01),
        )
        for n, (key, offset) in enumerate(OFFSETS.items())
    )
    return Seen(views, pose, thumbnail=painted(step * 7 + 1, 112, 112))


def live_run(
    cycles: int = 14,
    delay_s: float = 0.0,
    gate: threading.Event | None = None,
    *,
    answer: Callable[[Question, Pose], Ranked] | None = None,
    surface: Any = None,
    **changes: Any,
) -> PlayRun:
    """A run at its first request."""
    return PlayRun(header(**changes), script(cycles), delay_s, gate, answer, surface)


def finished_run(cycles: int = 14) -> PlayRun:
    """A run that went to its end."""
    run = live_run(cycles)
    while run.pending is not None:
        run.advance()
    return run


def fork_of(wanted: ForkAt) -> PlayRun:
    """The same answers up to a decision, then another one."""
    exchanges, decision, override = wanted.exchanges, wanted.decision, wanted.override
    run = live_run(parent_sha256="0" * 64, fork_decision=decision)
    while run.pending is not None:
        number = run._decisions if isinstance(run.pending, Ask) else None
        if number == decision:
            run._proposal = next(e.ranked for e in exchanges if e.decision == decision)
            run.commit(override)
            return run
        if number is not None:
            original = next(e for e in exchanges if e.decision == number)
            run._proposal = original.ranked
            run.commit(original.override)
        else:
            run.advance()
    raise AssertionError(f"no decision {decision}")


def opened_live(
    *,
    book: OpenBook | None = None,
    delay_s: float = 0.0,
    gate: threading.Event | None = None,
    cycles: int = 14,
    scene: Any = None,
    **extra: Any,
) -> Opened:
    """A live source with one entry."""
    return Opened(
        "furnished house",
        (Entry("1", "episode 1 · 11.7 m"), Entry("2", "episode 2 · 4.0 m")),
        Choice("1", "full", "scripted"),
        lambda _: Opening(header(), run=live_run(cycles, delay_s, gate), scene=scene),
        fork=fork_of,
        variants=("full", "base"),
        rankers=("scripted", "human"),
        book=book or in_memory,
        **extra,
    )


def in_memory(entry: str, sha256: str) -> AuditBook:
    """Reviews that are forgotten with the session."""
    del entry, sha256
    return AuditBook(Path("nowhere") / "reviews.sqlite")


def opened_recording(
    *, cycles: int = 14, scene: Any = None, book: OpenBook | None = None, blind: bool = False
) -> Opened:
    """A recording with one entry."""
    run = finished_run(cycles)
    return Opened(
        "play.mcap",
        (Entry("play", "episode 1 · full"),),
        Choice("play"),
        lambda _: Opening(
            run.header,
            run.exchanges,
            run.footer,
            trace_sha256="ab" * 32,
            source="play.mcap",
            scene=scene,
        ),
        fork=fork_of,
        book=book or in_memory,
        blind=blind,
    )
