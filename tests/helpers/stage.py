"""A small play for the inspector: an episode without a simulator, driven like the real one.

The body walks a known path; views are painted, not rendered. Everything that the page can show
occurs: vetoed views, a contested election, orders that disagree, a transition, the ladder, a
fallback. The same script runs live, is replayed up to a decision and forked.
"""

from __future__ import annotations

import functools
import math
import threading
import time
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from app.reviews.audit import AuditBook
from app.session.opened import Choice, Entry, ForkAt, Opened, Opening
from app.session.shelf import OpenBook
from c2nav_engine.contract.outcome import ORDERS_DISAGREE, Abstention, Answered, Ordering
from c2nav_engine.contract.presentation import presentations
from c2nav_engine.contract.prompt import Query, Ranked, Reply
from c2nav_engine.contract.question import Alternative, Form, Orders, Picture, Question, Slot
from c2nav_engine.contract.render import render
from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.geometry import Point, Pose
from c2nav_engine.navigator.config import LoopConfig
from c2nav_engine.navigator.requests import (
    Action,
    Ask,
    Candidate,
    DepthStats,
    Event,
    Facts,
    LadderState,
    Look,
    Marker,
    Move,
    Moved,
    Note,
    Request,
    Rig,
    Seen,
    SketchEntry,
    SketchState,
    Step,
    Stop,
    View,
)
from c2nav_engine.runner.exchange import Exchange, Override, Truth
from c2nav_engine.runner.record import EpisodeOutcome, Footer, Header

INSTRUCTION = (
    "Walk straight out of the bedroom, keep going across the living room with the sofa on your "
    "right, and stop beside the dining table."
)
LEGS = (
    "Walk straight out of the bedroom",
    "keep going across the living room with the sofa on your right",
    "stop beside the dining table",
)
PATH: tuple[Point, ...] = (
    (-6.525, 0.0, 0.575),
    (-4.575, 0.0, 0.575),
    (-2.625, 0.0, 0.575),
    (-0.675, 0.0, 0.475),
    (1.225, 0.0, 0.425),
    (3.175, 0.0, -0.025),
    (4.975, 0.0, -0.625),
)
EPISODE = Episode(
    episode_id="1",
    trajectory_id="1",
    scene_id="house/aws_small_house_yup.glb",
    start=Pose(PATH[0], -math.pi / 2.0),
    instruction=INSTRUCTION,
    goal_m=PATH[-1],
    geodesic_m=11.7,
    reference_path_m=PATH,
)
OFFSETS = {"left": math.radians(45.0), "front": 0.0, "right": -math.radians(45.0)}


@functools.cache
def painted(seed: int, width: int = 224, height: int = 224) -> Picture:
    """A picture with a horizon, a floor and a few coloured boxes."""
    rng = np.random.default_rng(seed)
    image = np.empty((height, width, 3), np.uint8)
    image[: height // 2] = np.array([236, 232, 226]) - rng.integers(0, 40)
    image[height // 2 :] = np.array([120, 160, 190]) + rng.integers(0, 30)
    for _ in range(5):
        colour = tuple(int(v) for v in rng.integers(30, 230, 3))
        x, w = int(rng.integers(0, width - 20)), int(rng.integers(20, width // 3))
        top = int(rng.integers(height // 4, height // 2 + 10))
        bottom = int(rng.integers(height // 2 + 10, height - 10))
        cv2.rectangle(image, (x, top), (x + w, bottom), colour, -1)
    jpeg = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, 92])[1].tobytes()
    return Picture.of(jpeg, width_px=width, height_px=height)


def header(**changes: Any) -> Header:
    """The header of the play."""
    plain = Header(
        run="play",
        episode=EPISODE,
        legs=LEGS,
        parser="english",
        profile=VLNCE,
        variant="full",
        config=LoopConfig().as_json(),
        config_sha256="",
        ranker="scripted",
        seed=0,
        surface="built",
    )
    return replace(plain, **changes)


def distance_m(point_m: Point) -> float:
    """Along the path's straight line: good enough for a play."""
    return math.dist(point_m, PATH[-1])


Script = Generator[Request, Any, None]


def script(cycles: int) -> Script:
    """The whole play: requests out, answers in."""
    pose = EPISODE.start
    leg, travelled_m, support = 0, 0.0, 0
    for cycle in range(cycles):
        seen: Seen = yield Look(Rig.FAN)
        facts = _facts(Slot.SEEING, cycle, pose, leg=leg, travelled_m=travelled_m)
        candidates = tuple(_candidate(view, cycle) for view in seen.views)
        contested = "first election of a leg" if cycle in (0, 4) else ""
        facts = replace(facts, candidates=candidates, contested=contested)
        answer: Answered = yield Ask(_election(facts, cycle), facts)
        if isinstance(answer, Ordering):
            moved: Moved = yield Move(_towards(answer.winner, pose, cycle), "elect")
            if moved.steps:
                pose = moved.steps[-1].odometry
            travelled_m += sum(step.moved_m for step in moved.steps)
        else:
            yield Note(Event("fallback", "no ordering", cycle))
        if cycle in (3, 4, 7, 8):
            supported: Answered = yield from _transition(cycle, pose, leg)
            won = isinstance(supported, Ordering) and supported.winner == "next"
            support = support + 1 if won else 0
        advanced = support == 2 and leg < 2
        entry = SketchEntry(
            cycle,
            leg,
            (0.1, 0.7),
            3,
            "straight",
            "moved a few steps ahead",
            "current",
            painted(1000 + cycle, 112, 112),
        )
        leg, support = (leg + 1, 0) if advanced else (leg, support)
        rendering = "So far: left the bedroom; moved several steps ahead, turned slightly left."
        yield Note(SketchState(entry, rendering, support, leg, advanced, gate_open=cycle > 1))
        if leg == 2 and cycle >= cycles - 3:
            stopped = yield from _arriving(cycle, pose)
            if stopped:
                yield Stop()
                return


def _facts(slot: Slot, cycle: int, pose: Pose, *, leg: int, travelled_m: float = 0.0) -> Facts:
    return Facts(
        slot,
        cycle,
        leg,
        (),
        odometry=pose,
        travelled_m=travelled_m,
        leg_travelled_m=travelled_m / 2.0,
        notes={"history": "no collision, glance not due"},
    )


def _candidate(view: View, cycle: int) -> Candidate:
    vetoed = view.free_m < 0.5
    veto = f"free {view.free_m:.1f} m, needs 0.5 m" if vetoed else ""
    return Candidate(view.key, not vetoed, veto, view.free_m, view.offset_rad, view.picture)


def _election(facts: Facts, cycle: int) -> Question:
    offered = [c for c in facts.candidates if c.feasible]
    words = {"left": "to the left", "front": "ahead", "right": "to the right"}
    return Question(
        slot=Slot.SEEING,
        form=Form.ORDINAL,
        orders=Orders.CYCLIC if facts.contested else Orders.ONCE,
        instruction=INSTRUCTION,
        legs=LEGS,
        leg=facts.leg,
        alternatives=tuple(Alternative(c.key, words[c.key], c.picture) for c in offered),
        shuffle_seed=cycle,
        template="seeing/1",
        sketch="moved a few steps ahead, turned slightly left",
    )


def _contrast(slot: Slot, facts: Facts, keys: tuple[str, str], *, seed: int) -> Ask:
    texts = {
        "stay": f"The robot is still on the part to follow now: {LEGS[facts.leg]}",
        "next": "The robot has finished that part, and the next part has begun",
        "here": "The place that the last part of the route describes is here.",
        "ahead": "The place that the last part of the route describes is still ahead.",
        "covered": "The recorded journey covers the whole route.",
        "missing": "Part of the route is still missing from the recorded journey.",
    }
    pictured = slot is Slot.LOOKBACK
    alternatives = tuple(
        Alternative(key, texts.get(key, ""), painted(seed + n) if pictured else None)
        for n, key in enumerate(keys)
    )
    question = Question(
        slot,
        Form.ORDINAL,
        Orders.BOTH,
        INSTRUCTION,
        LEGS,
        facts.leg,
        alternatives,
        shuffle_seed=seed,
        template=f"{slot.value}/1",
        sketch="moved several steps ahead",
        context=() if pictured else (("What the robot sees now:", painted(seed)),),
    )
    candidates = tuple(Candidate(a.key, True, picture=a.picture) for a in alternatives)
    return Ask(question, replace(facts, candidates=candidates))


def _transition(cycle: int, pose: Pose, leg: int) -> Generator[Request, Any, Answered]:
    facts = _facts(Slot.TRANSITION, cycle, pose, leg=leg)
    answer: Answered = yield _contrast(Slot.TRANSITION, facts, ("stay", "next"), seed=300 + cycle)
    return answer


def _arriving(cycle: int, pose: Pose) -> Generator[Request, Any, bool]:
    evidence: dict[str, int] = {}
    for slot, keys in (
        (Slot.GROUND, ("here", "ahead")),
        (Slot.JOURNEY, ("covered", "missing")),
        (Slot.LOOKBACK, ("now", "back")),
    ):
        facts = _facts(slot, cycle, pose, leg=2)
        answer = yield _contrast(slot, facts, keys, seed=500 + 10 * cycle)
        good = answer.winner == keys[0] if isinstance(answer, Ordering) else None
        evidence[slot.value] = 0 if good is None else (1 if good else -1)
    sure = all(value == 1 for value in evidence.values())
    marker = Marker(pose, 1, cycle, 9.0)
    yield Note(
        LadderState(
            cycle,
            evidence["ground"],
            evidence["journey"],
            evidence["lookback"],
            "stop" if sure else "hold",
            (),
            2,
            () if sure else (marker,),
            "" if sure else "marker left",
        )
    )
    return sure


def _towards(key: str, pose: Pose, cycle: int) -> tuple[Action, ...]:
    turn = {"left": (Action.LEFT,) * 3, "front": (), "right": (Action.RIGHT,) * 3}[key]
    return (*turn, *(Action.FORWARD,) * 3)


# ---------------------------------------------------------------- the shell of the play


def ranked_as(question: Question, best: Sequence[str]) -> Ranked:
    """One ranker's record that puts keys in an order, the same in every presentation."""
    outcome = Ordering.of(*best)
    queries = tuple(
        Query(render(question, order), Reply(text=" > ".join(best), latency_s=0.1), outcome)
        for order in range(len(presentations(question)))
    )
    return Ranked(outcome, queries, "scripted")


def scripted_answer(question: Question) -> Ranked:
    """Prefers ahead, then left; the first transition's orders disagree."""
    wish = ["next", "here", "covered", "now", "front", "left", "right"]
    best = sorted(question.keys, key=lambda key: wish.index(key) if key in wish else 99)
    disagree = question.slot is Slot.TRANSITION and question.shuffle_seed == 303
    queries: list[Query] = []
    for order in range(len(presentations(question))):
        outcome = Ordering.of(*(best[::-1] if disagree and order else best))
        reply = Reply(text=" > ".join(best), latency_s=0.7, tokens_in=620, tokens_out=9)
        queries.append(Query(render(question, order), reply, outcome))
    final = Abstention(ORDERS_DISAGREE) if disagree else Ordering.of(*best)
    return Ranked(final, tuple(queries), "scripted")


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
        self.pending: Request | None = next(self.script)
        self._pose = EPISODE.start
        self._steps = 0
        self._decisions = 0
        self._proposal: Ranked | None = None
        self.closed = False
        self.kept: dict[str, bytes] = {}

    def propose(self) -> Ranked:
        assert isinstance(self.pending, Ask)
        request = self.pending
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
