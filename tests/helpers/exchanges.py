"""A made-up episode as a list of exchanges: every kind of request, answer, note and outcome.

It is no navigation, only its record's shape: what traces, exports and the inspector must carry.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import cycle as endlessly
from pathlib import Path

import cv2
import numpy as np

from c2nav_engine.contract import template
from c2nav_engine.contract.outcome import (
    ORDERS_DISAGREE,
    Abstention,
    Answered,
    Cardinal,
    Empty,
    Invalid,
    Ordering,
    Refused,
    Tie,
    TransportFailure,
    Truncated,
)
from c2nav_engine.contract.presentation import presentations
from c2nav_engine.contract.prompt import Query, Ranked, Reply
from c2nav_engine.contract.question import Orders, Picture, Question, Slot
from c2nav_engine.contract.render import render
from c2nav_engine.controller.sensed import Action, Candidate, DepthStats, Step, View
from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.geometry import Pose
from c2nav_engine.navigator.requests import (
    Ask,
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
    Unasked,
)
from c2nav_engine.runner.exchange import Exchange, Override, Response, Truth
from c2nav_engine.runner.record import EpisodeOutcome, Footer, Header
from c2nav_engine.runner.recording import TraceWriter
from tests.helpers.questions import INSTRUCTION, LEGS, question

GOAL_M = (0.0, 0.0, -8.0)


@dataclass(frozen=True, slots=True)
class FakeEpisode:
    """What a run would hand to the trace writer."""

    header: Header
    exchanges: tuple[Exchange, ...]
    footer: Footer


def fake_episode(cycles: int = 6, *, seed: int = 0, side_px: int = 64) -> FakeEpisode:
    """A deterministic episode of that many cycles; pictures of `side_px` columns and rows."""
    made = _Maker(np.random.default_rng(seed), side_px)
    for number in range(cycles):
        made.cycle(number, last=number >= cycles // 2)
    made.note(Event("fallback", "no view survived", cycles))
    made.add(Stop(), None)
    footer = Footer(
        EpisodeOutcome.STOPPED,
        {"ne_m": 1.25, "success": 1, "spl": math.inf, "ndtw": None, "steps": made.step},
    )
    return FakeEpisode(header_for("fake", seed=seed), tuple(made.exchanges), footer)


def header_for(run: str, *, seed: int = 0) -> Header:
    """A header with every field set."""
    episode = Episode(
        episode_id="7",
        trajectory_id="3",
        scene_id="builtin/none",
        start=Pose((0.1, 0.2, -0.3), 0.4),
        instruction=INSTRUCTION,
        goal_m=GOAL_M,
        geodesic_m=8.25,
        reference_path_m=((0.1, 0.2, -0.3), GOAL_M),
        leg_ends=(0, 1),
        extra={"info": {"geodesic_distance": 8.25}},
    )
    return Header(
        run=run,
        episode=episode,
        legs=LEGS,
        parser="english",
        profile=VLNCE,
        variant="full",
        config={"seeing": {"offsets": [1, 2.5]}, "on": True},
        config_sha256="ab" * 32,
        ranker="scripted",
        seed=seed,
        ranker_options={"model": "none"},
        surface="built",
        headings="v1-3",
        scene_licence="CC0-1.0",
        code_version="0.1.0",
        templates=template.texts(),
        extra={"note": "made up"},
    )


def write_fake(path: Path, cycles: int = 3, *, seed: int = 0, side_px: int = 16) -> FakeEpisode:
    """Write a made-up episode as a finished trace."""
    episode = fake_episode(cycles, seed=seed, side_px=side_px)
    write_episode(path, episode)
    return episode


def write_episode(path: Path, episode: FakeEpisode) -> str:
    """Write an episode as a finished trace; returns its digest."""
    with TraceWriter(path, episode.header) as writer:
        for exchange in episode.exchanges:
            writer.write(exchange)
        return writer.finish(episode.footer)


class _Maker:
    """Grows the list of exchanges; keeps step and pose."""

    def __init__(self, generator: np.random.Generator, side_px: int) -> None:
        self._generator = generator
        self._side_px = side_px
        self._pose = Pose((0.0, 0.0, 0.0), 0.0)
        self._front: Picture = self.picture()
        self._thumbnails: list[Picture] = []
        self._asked = 0
        self._odd = endlessly(ODD_OUTCOMES)
        self.step = 0
        self.exchanges: list[Exchange] = []

    def cycle(self, number: int, *, last: bool) -> None:
        """One navigation cycle with everything that may happen in it."""
        if number % 4 == 3:
            self.glance(number)
        fan = self.fan()
        if number % 5 == 4:
            facts = self.facts(Slot.SEEING, number, ("left", "front", "right"), fan, offered=1)
            self.add(Note(Unasked(facts, "front")), None, decision=True)
        else:
            contested = number % 3 == 0
            orders = Orders.CYCLIC if contested else Orders.ONCE
            self.ask(Slot.SEEING, number, orders=orders, pictures=fan)
        back = self._front
        self.move("elect", (Action.LEFT, Action.FORWARD, Action.FORWARD))
        self.front()
        self.ask(Slot.GROUND if last else Slot.TRANSITION, number)
        if last:
            self.ask(Slot.JOURNEY, number)
            self.ask(Slot.LOOKBACK, number, pictures={"now": self._front, "back": back})
            marker = Marker(self._pose, 2, number, 1.5)
            ladder = LadderState(number, 1, 0, -1, "hold", ("depth 0.2 m",), 2, (marker,), "")
            self.note(ladder)
        self.note(self.sketch(number))

    def glance(self, number: int) -> None:
        self.note(Event("glance", "two elections in a row were no ordering", number))
        views = tuple(self.view(f"ring{k}", math.radians(30 * k)) for k in range(12))
        sectors = tuple(self.picture(2) for _ in range(6))
        self.add(Look(Rig.RING), Seen(views, self._pose, sectors), truth=self.truth())
        pictures = {f"sector{k}": sector for k, sector in enumerate(sectors)}
        self.ask(Slot.GLANCE, number, pictures=pictures)
        self.move("glance", (Action.RIGHT,) * 4)

    def fan(self) -> dict[str, Picture]:
        offsets_rad = {"left": 0.785, "front": 0.0, "right": -0.785}
        views = [self.view(key, offset_rad) for key, offset_rad in offsets_rad.items()]
        views[1] = replace(views[1], picture=self._front)
        self.look(Rig.FAN, tuple(views))
        return {view.key: view.picture for view in views}

    def front(self) -> None:
        view = self.view("front", 0.0)
        self._front = view.picture
        self.look(Rig.FRONT, (view,))

    def look(self, rig: Rig, views: tuple[View, ...]) -> None:
        thumbnail = self.picture(0.25)
        self._thumbnails.append(thumbnail)
        seen = Seen(views, self._pose, thumbnail=thumbnail)
        self.add(Look(rig), seen, truth=self.truth(depth=True))

    def move(self, purpose: str, actions: tuple[Action, ...]) -> None:
        steps: list[Step] = []
        poses: list[Pose] = []
        for action in actions:
            moved_m = 0.25 if action is Action.FORWARD else 0.0
            self._pose = Pose(self._pose.ahead(moved_m), self._pose.yaw_rad)
            if action is not Action.FORWARD:
                self._pose = self._pose.turned(0.26 if action is Action.LEFT else -0.26)
            steps.append(Step(action, self._pose, moved_m, collided=False))
            poses.append(self._pose)
        distances_m = tuple(math.dist(pose.position_m, GOAL_M) for pose in poses)
        truth = Truth(tuple(poses), distances_m)
        self.add(Move(actions, purpose), Moved(tuple(steps)), truth=truth)
        self.step += len(steps)

    def ask(
        self,
        slot: Slot,
        number: int,
        *,
        orders: Orders | None = None,
        pictures: dict[str, Picture] | None = None,
    ) -> None:
        asked = question(
            slot, orders=orders, pictures=pictures, now=self._front, seed=number + 2**40
        )
        context = tuple((f"Step {k}", each) for k, each in enumerate(self._thumbnails[-4:]))
        asked = replace(asked, context=(*asked.context, *context))
        self._asked += 1
        outcome: Answered = Ordering.of(*asked.keys)
        if self._asked % 3 == 0:
            outcome = next(self._odd)
        ranked = ranked_for(asked, outcome)
        override = None
        if self._asked % 7 == 0:
            override = Override(Ordering.winner_only(asked.keys[-1], asked.keys), "P1", "door", 9.5)
        facts = self.facts(slot, number, asked.keys, pictures or {})
        self.add(
            Ask(asked, facts),
            override.outcome if override else outcome,
            decision=True,
            ranked=None if self._asked % 14 == 0 else ranked,
            override=override,
            wall_s={"asked": 1.5 * self._asked},
        )

    def facts(
        self,
        slot: Slot,
        number: int,
        keys: tuple[str, ...],
        pictures: dict[str, Picture],
        *,
        offered: int = 9,
    ) -> Facts:
        candidates = tuple(
            Candidate(key, True, "", 2.5, 0.1 * place, pictures.get(key))
            if place < offered
            else Candidate(key, False, "free space 0.31 m is below 0.50 m", 0.31, None, None)
            for place, key in enumerate(keys)
        )
        return Facts(
            slot, number, 0, candidates, self._pose, 1.5 * number, 0.5, notes={"gate": "open"}
        )

    def sketch(self, number: int) -> SketchState:
        entry = SketchEntry(
            number, 0, (0.25, -1.5), 3, "left", "went ahead", "ambiguous", self._thumbnails[-1]
        )
        return SketchState(entry, "It went ahead a few steps.", 1, 0, number == 2, gate_open=True)

    def note(self, record: Event | SketchState | LadderState) -> None:
        self.add(Note(record), None)

    def add(
        self,
        request: Request,
        response: Response,
        *,
        decision: bool = False,
        ranked: Ranked | None = None,
        override: Override | None = None,
        truth: Truth | None = None,
        wall_s: dict[str, float] | None = None,
    ) -> None:
        number = sum(each.decision is not None for each in self.exchanges) if decision else None
        self.exchanges.append(
            Exchange(
                index=len(self.exchanges),
                step=self.step,
                decision=number,
                request=request,
                response=response,
                ranked=ranked,
                override=override,
                truth=truth,
                wall_s=wall_s or {},
            )
        )

    def view(self, key: str, offset_rad: float) -> View:
        depth = DepthStats(float(self._generator.uniform(0.5, 5.0)), 0.125)
        return View(key, offset_rad, self.picture(), 2.75, depth)

    def truth(self, *, depth: bool = False) -> Truth:
        distance_m = math.dist(self._pose.position_m, GOAL_M)
        return Truth((self._pose,), (distance_m,), self.depth_png() if depth else b"")

    def picture(self, scale: float = 1.0) -> Picture:
        rows, columns = self._size(min(scale, 1.0)), self._size(scale)
        coarse = self._generator.integers(0, 255, (6, 6, 3), np.uint8)
        rgb = cv2.resize(coarse, (columns, rows), interpolation=cv2.INTER_CUBIC)
        _, jpeg = cv2.imencode(".jpg", rgb, [cv2.IMWRITE_JPEG_QUALITY, 92])
        return Picture.of(jpeg.tobytes(), width_px=columns, height_px=rows)

    def depth_png(self) -> bytes:
        coarse = self._generator.uniform(500.0, 8000.0, (5, 5)).astype(np.float32)
        size = (self._side_px, self._side_px)
        depth_mm = cv2.resize(coarse, size, interpolation=cv2.INTER_LINEAR).astype(np.uint16)
        return cv2.imencode(".png", depth_mm)[1].tobytes()

    def _size(self, scale: float) -> int:
        return max(8, int(self._side_px * scale))


ODD_OUTCOMES: tuple[Answered, ...] = (
    Abstention(ORDERS_DISAGREE),
    Tie((("left", "front"), ("right",))),
    Invalid("names no label"),
    Refused(),
    Truncated(),
    Empty(),
    TransportFailure("timed out after 60 s"),
    Cardinal(-12.5),
)


def ranked_for(asked: Question, outcome: Answered) -> Ranked:
    """A record with one query per presentation and, for odd outcomes, a repair attempt."""
    queries: list[Query] = []
    for order in range(len(presentations(asked))):
        for repair in range(1 if isinstance(outcome, Ordering) else 2):
            prompt = render(asked, order, repair=repair)
            known = outcome if isinstance(outcome, TransportFailure) else None
            reply = Reply(
                outcome=known,
                text=f"A > B — because of the door ({order})",
                latency_s=0.25 + order,
                tokens_in=812,
                tokens_out=None if repair else 9,
                cost_usd=None if repair else 0.001,
                model="scripted-1",
                cached=bool(repair),
                retry_after_s=None if known else 0.0,
            )
            queries.append(Query(prompt, reply, outcome))
    return Ranked(outcome, tuple(queries), "scripted")
