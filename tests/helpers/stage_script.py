"""The script of the play in `stage`: what it asks of its shell, and what a scripted ranker says."""

from __future__ import annotations

import functools
import math
from collections.abc import Generator, Sequence
from dataclasses import replace
from typing import Any

import cv2
import numpy as np

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
    Stop,
    View,
)
from c2nav_engine.runner.record import Header

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
        facts = facts_of(Slot.SEEING, cycle, pose, leg=leg, travelled_m=travelled_m)
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


def facts_of(slot: Slot, cycle: int, pose: Pose, *, leg: int, travelled_m: float = 0.0) -> Facts:
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


def contrast_of(slot: Slot, facts: Facts, keys: tuple[str, str], *, seed: int) -> Ask:
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
    facts = facts_of(Slot.TRANSITION, cycle, pose, leg=leg)
    answer: Answered = yield contrast_of(Slot.TRANSITION, facts, ("stay", "next"), seed=300 + cycle)
    return answer


def _arriving(cycle: int, pose: Pose) -> Generator[Request, Any, bool]:
    evidence: dict[str, int] = {}
    for slot, keys in (
        (Slot.GROUND, ("here", "ahead")),
        (Slot.JOURNEY, ("covered", "missing")),
        (Slot.LOOKBACK, ("now", "back")),
    ):
        facts = facts_of(slot, cycle, pose, leg=2)
        answer = yield contrast_of(slot, facts, keys, seed=500 + 10 * cycle)
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


# ---------------------------------------------------------------- answers


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
