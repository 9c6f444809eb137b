"""Episodes told in a few calls: where the body went, what was asked, how it ended."""

from __future__ import annotations

import math
from dataclasses import replace

from c2nav_engine.contract.outcome import Answered
from c2nav_engine.contract.prompt import Query, Ranked, Reply
from c2nav_engine.contract.question import Question
from c2nav_engine.contract.render import render
from c2nav_engine.experiments.tags.account import Account
from c2nav_engine.experiments.truth import Course
from c2nav_engine.geometry import Point, Pose
from c2nav_engine.navigator.requests import (
    Action,
    Ask,
    Candidate,
    Event,
    Facts,
    Look,
    Move,
    Moved,
    Note,
    Request,
    Response,
    Rig,
    Seen,
    SketchEntry,
    SketchState,
    Step,
    Stop,
)
from c2nav_engine.runner.exchange import Exchange, Truth
from c2nav_engine.runner.record import EpisodeOutcome, Footer
from tests.helpers.exchanges import header_for
from tests.helpers.questions import LEGS

GOAL_M: Point = (0.0, 0.0, -8.0)
START = Pose((0.0, 0.0, 0.0), 0.0)


class Tale:
    """Grows an episode; `account` is what it came to.

    Args:
        goal: Whether goal distances are measured.
        path: Reference path.
        legs: Words of the legs.
    """

    def __init__(
        self,
        *,
        goal: bool = True,
        path: tuple[Point, ...] = (START.position_m, GOAL_M),
        legs: tuple[str, ...] = LEGS,
    ) -> None:
        self._goal = goal
        self._path = path
        self._legs = legs
        self._exchanges: list[Exchange] = []
        self._step = 0
        self._decisions = 0
        self._place: Point = START.position_m
        self._add(Look(Rig.FRONT), Seen((), START), truth=self._truth((START,)))

    def walk(self, *places: tuple[float, float], purpose: str = "elect") -> Tale:
        """One step to each place (x, z), however far."""
        poses = tuple(Pose((x, 0.0, z), 0.0) for x, z in places)
        steps = tuple(Step(Action.FORWARD, pose, 0.25, collided=False) for pose in poses)
        request = Move((Action.FORWARD,) * len(poses), purpose)
        self._add(request, Moved(steps), truth=self._truth(poses))
        self._step += len(poses)
        self._place = poses[-1].position_m
        return self

    def ask(
        self,
        question: Question,
        answered: Answered,
        *,
        orders: tuple[Answered, ...] = (),
        vetoed: tuple[str, ...] = (),
    ) -> Tale:
        """A question, its outcome, and what each order answered."""
        queries = tuple(
            Query(render(question, 0), Reply(text="", model="m", latency_s=0.0), outcome)
            for outcome in orders or (answered,)
        )
        facts = self._facts(question, vetoed)
        self._add(Ask(question, facts), answered, Ranked(answered, queries, "m"), decision=True)
        return self

    def event(self, name: str) -> Tale:
        """Something between decisions."""
        self._add(Note(Event(name, "", 0)), None)
        return self

    def sketch(self, leg: int, *, advanced: bool) -> Tale:
        """The sketch after a cycle: the leg it is in now."""
        entry = SketchEntry(0, leg, (0.0, 0.0), 1, "straight", "went ahead", "current", None)
        self._add(Note(SketchState(entry, "", 0, leg, advanced, gate_open=True)), None)
        return self

    def account(
        self, outcome: EpisodeOutcome = EpisodeOutcome.STEP_LIMIT, *, course: Course | None = None
    ) -> Account:
        """End here."""
        if outcome is EpisodeOutcome.STOPPED:
            self._add(Stop(), None)
        header = header_for("tale")
        episode = replace(
            header.episode,
            start=START,
            goal_m=GOAL_M if self._goal else None,
            reference_path_m=self._path,
        )
        header = replace(header, episode=episode, legs=self._legs)
        return Account(header, Footer(outcome, {}), tuple(self._exchanges), course)

    def _facts(self, question: Question, vetoed: tuple[str, ...]) -> Facts:
        offsets = {"left": math.pi / 2.0, "front": 0.0, "right": -math.pi / 2.0}
        candidates = [
            Candidate(key, key not in vetoed, "", 2.0, offsets.get(key), None)
            for key in dict.fromkeys((*question.keys, *vetoed))
        ]
        here = Pose(self._place, 0.0)
        return Facts(question.slot, 0, question.leg, tuple(candidates), here, 0.0, 0.0)

    def _truth(self, poses: tuple[Pose, ...]) -> Truth:
        distances_m = tuple(math.dist(pose.position_m, GOAL_M) for pose in poses)
        return Truth(poses, distances_m if self._goal else ())

    def _add(
        self,
        request: Request,
        response: Response,
        ranked: Ranked | None = None,
        *,
        decision: bool = False,
        truth: Truth | None = None,
    ) -> None:
        number = self._decisions if decision else None
        self._decisions += decision
        exchange = Exchange(
            index=len(self._exchanges),
            step=self._step,
            decision=number,
            request=request,
            response=response,
            ranked=ranked,
            truth=truth,
        )
        self._exchanges.append(exchange)
