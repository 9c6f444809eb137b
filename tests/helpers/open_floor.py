"""An endless open floor for the core: dead reckoning, made-up free space, no scene, no model."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

from c2nav_engine.contract.outcome import Abstention, Answered, Cardinal, Ordering
from c2nav_engine.contract.question import Picture, Slot
from c2nav_engine.episodes.profile import VLNCE, Profile
from c2nav_engine.geometry import Pose
from c2nav_engine.navigator.config import LoopConfig
from c2nav_engine.navigator.loop import navigate
from c2nav_engine.navigator.requests import (
    Action,
    Ask,
    DepthStats,
    Event,
    LadderState,
    Look,
    Move,
    Moved,
    Note,
    Record,
    Request,
    Rig,
    Seen,
    SketchState,
    Step,
    Stop,
    Unasked,
    View,
)
from c2nav_engine.navigator.state import Ending, Task
from c2nav_engine.navigator.variants import preset

R = TypeVar("R", bound=Record)
Answers = Callable[[Ask], Answered]
NO_ANSWER = Abstention("cannot tell")
PLAUSIBLE = DepthStats(3.0, 0.0)
ORIGIN = Pose((0.0, 0.0, 0.0), 0.0)


def picture(name: str) -> Picture:
    """Bytes that stand for a picture; never decoded by the core."""
    return Picture.of(name.encode(), width_px=8, height_px=8)


@dataclass
class Floor:
    """Answers looks and moves; tests set what is free and what collides.

    Attributes:
        free_m: View key → free space, or a function of (key, absolute yaw).
        collide_at: Forward steps (counted from 1) that collide and do not move.
        depth: Depth facts of every view.
    """

    profile: Profile = VLNCE
    free_m: dict[str, float] = field(default_factory=dict)
    free: Callable[[str, float], float] | None = None
    collide_at: frozenset[int] = frozenset()
    depth: DepthStats = PLAUSIBLE
    ring_depth: DepthStats = PLAUSIBLE
    pose: Pose = ORIGIN
    steps: int = 0
    forwards: int = 0
    looks: int = 0

    def look(self, request: Look) -> Seen:
        self.looks += 1
        offset = self.profile.fan_offset_rad
        if request.rig is Rig.RING:
            offsets = {f"ring{k}": k * math.tau / 12 for k in range(12)}
        else:
            offsets = {"left": offset, "front": 0.0, "right": -offset}
        views = tuple(self._view(key, angle) for key, angle in offsets.items())
        ring = request.rig is Rig.RING
        return Seen(
            views=views,
            odometry=self.pose,
            sectors=tuple(picture(f"s{k}/{self.looks}") for k in range(6)) if ring else (),
            thumbnail=None if ring else picture(f"thumb/{self.looks}"),
        )

    def _view(self, key: str, offset_rad: float) -> View:
        if self.free is not None:
            free_m = self.free(key, self.pose.yaw_rad + offset_rad)
        else:
            free_m = self.free_m.get(key, 5.0)
        depth = self.ring_depth if key.startswith("ring") else self.depth
        return View(key, offset_rad, picture(f"{key}/{self.looks}"), free_m, depth)

    def move(self, request: Move) -> Moved:
        done: list[Step] = []
        for action in request.actions:
            if self.steps >= self.profile.max_steps:
                break
            self.steps += 1
            done.append(self._step(action))
            if done[-1].collided:
                break
        return Moved(tuple(done), self.steps >= self.profile.max_steps)

    def _step(self, action: Action) -> Step:
        if action is not Action.FORWARD:
            turn = self.profile.turn_rad
            self.pose = self.pose.turned(turn if action is Action.LEFT else -turn)
            return Step(action, self.pose, 0.0, False)
        self.forwards += 1
        if self.forwards in self.collide_at:
            return Step(action, self.pose, 0.0, True)
        self.pose = Pose(self.pose.ahead(self.profile.step_m), self.pose.yaw_rad)
        return Step(action, self.pose, self.profile.step_m, False)


@dataclass
class Tale:
    """Everything that happened while the core was driven."""

    requests: list[Request] = field(default_factory=list)
    answers: list[tuple[Ask, Answered]] = field(default_factory=list)
    ending: Ending | None = None

    def asked(self, slot: Slot) -> list[Ask]:
        return [ask for ask, _ in self.answers if ask.question.slot is slot]

    def records(self, kind: type[R]) -> list[R]:
        notes = [r.record for r in self.requests if isinstance(r, Note)]
        return [record for record in notes if isinstance(record, kind)]

    def events(self, name: str) -> list[Event]:
        return [event for event in self.records(Event) if event.name == name]

    @property
    def ladders(self) -> list[LadderState]:
        return self.records(LadderState)

    @property
    def sketches(self) -> list[SketchState]:
        return self.records(SketchState)

    @property
    def unasked(self) -> list[Unasked]:
        return self.records(Unasked)

    def moves(self, purpose: str) -> list[Move]:
        return [r for r in self.requests if isinstance(r, Move) and r.purpose == purpose]

    @property
    def stopped(self) -> bool:
        return any(isinstance(request, Stop) for request in self.requests)


def task(
    variant: str = "full",
    *,
    legs: tuple[str, ...] = ("Leave the room", "stop at the red chair"),
    profile: Profile = VLNCE,
    config: LoopConfig | None = None,
    seed: int = 0,
) -> Task:
    return Task(
        instruction=", ".join(legs),
        legs=legs,
        profile=profile,
        config=config or preset(variant),
        episode_id="7",
        seed=seed,
        start=Pose((0.0, 0.0, 0.0), 0.0),
    )


def drive(given: Task, answers: Answers, floor: Floor | None = None, *, asks: int = 60) -> Tale:
    """Drive the core until it ends, or until so many questions were answered."""
    floor = floor or Floor(profile=given.profile)
    tale = Tale()
    loop = navigate(given)
    try:
        request = next(loop)
        while len(tale.answers) < asks and len(tale.requests) < 4000:
            tale.requests.append(request)
            if isinstance(request, Look):
                request = loop.send(floor.look(request))
            elif isinstance(request, Move):
                request = loop.send(floor.move(request))
            elif isinstance(request, Ask):
                answered = answers(request)
                tale.answers.append((request, answered))
                request = loop.send(answered)
            else:
                request = loop.send(None)
    except StopIteration as finished:
        tale.ending = finished.value
    return tale


def prefer(**winners: str | Answered) -> Answers:
    """Answers by slot: the key that wins, or an outcome; whatever else is asked has no answer."""

    def answer(ask: Ask) -> Answered:
        wanted = winners.get(ask.question.slot.value, NO_ANSWER)
        if not isinstance(wanted, str):
            return wanted
        keys = ask.question.keys
        return Ordering.winner_only(wanted if wanted in keys else keys[0], keys)

    return answer


def each(**scripts: Sequence[str | Answered]) -> Answers:
    """Answers by slot, one after the other; the last one of a list repeats."""
    left = {slot: list(script) for slot, script in scripts.items()}

    def answer(ask: Ask) -> Answered:
        script = left.get(ask.question.slot.value)
        if not script:
            return NO_ANSWER
        wanted = script.pop(0) if len(script) > 1 else script[0]
        return prefer(**{ask.question.slot.value: wanted})(ask)

    return answer


def degrees(value: float) -> Cardinal:
    return Cardinal(value)


def small(profile: Profile = VLNCE, **changes: object) -> Profile:
    """A profile with some values changed."""
    return replace(profile, **changes)  # pyright: ignore[reportArgumentType]
