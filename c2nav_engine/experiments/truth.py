"""What is true of a question: the definitions behind the simulated observer (method.md).

All of it is evaluation side. g(p) is the geodesic distance to the goal, d₀ = g(start).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from c2nav_engine.contract.outcome import Key
from c2nav_engine.contract.question import Question, Slot
from c2nav_engine.controller.bundle import bundle_steps
from c2nav_engine.controller.config import ControllerConfig
from c2nav_engine.controller.odometer import planar_m
from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.profile import Profile
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.simulated import SlotTruth
from c2nav_engine.geometry import Point, Pose, wrap_rad
from c2nav_engine.metrics.trajectory import SUCCESS_M
from c2nav_engine.navigator.requests import Ask, Candidate, Look, Move, Moved, Seen
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.world.kinematics import Body
from c2nav_engine.world.surface import DistanceField, Surface

LOOKBACK_TIE_M = 0.25
"""Frames closer than this in g have no better one."""
NEARBY_CORNER_M = 0.05
"""A first corner of the shortest path nearer than this says nothing of its direction."""
TIE_M = 1e-6


@dataclass(frozen=True, slots=True)
class Course:
    """The facts of one episode that do not change while it runs.

    Attributes:
        goal_m: Goal.
        shortest_m: d₀.
        leg_end_goal_m: g at the end of each stored leg; empty where the episode stores none.
        surface: The floor.
        field: g.
        profile: The body.
        controller: Limits of its motion.
    """

    goal_m: Point
    shortest_m: float
    leg_end_goal_m: tuple[float, ...]
    surface: Surface
    field: DistanceField
    profile: Profile
    controller: ControllerConfig

    @property
    def body(self) -> Body:
        """How the body moves."""
        return Body(self.surface, self.profile)


def course_of(
    episode: Episode,
    *,
    start: Pose,
    surface: Surface,
    field: DistanceField | None,
    profile: Profile,
    controller: ControllerConfig,
) -> Course:
    """The course of an episode; raises `UsageError` without a reachable goal.

    Args:
        episode: Its goal, reference path and leg ends are read.
        start: Start pose on the floor.
        surface: The floor.
        field: Distances to the goal.
        profile: The body.
        controller: Limits of its motion.
    """
    shortest_m = math.inf if field is None else field.distance_m(start.position_m)
    if episode.goal_m is None or field is None or math.isinf(shortest_m):
        message = (
            f"episode {episode.episode_id}: expected a goal that can be reached, because the "
            "simulated observer knows the truth; choose another ranker for this source"
        )
        raise UsageError(message)
    ends = tuple(field.distance_m(episode.reference_path_m[end]) for end in episode.leg_ends)
    return Course(episode.goal_m, shortest_m, ends, surface, field, profile, controller)


@dataclass(frozen=True, slots=True)
class Moment:
    """Where an episode stands, as the shell knows it.

    Attributes:
        pose: True pose.
        step: Low-level actions executed.
        least_goal_m: Least g so far, the start included.
        queries: Queries answered so far.
        taken_at_m: Where each picture was taken, by its sha256.
    """

    pose: Pose
    step: int
    least_goal_m: float
    queries: int
    taken_at_m: Mapping[str, Point]


class EpisodeTruth:
    """The truth of one running episode, told of every exchange (a `simulated.Truth`).

    Args:
        course: The episode's unchanging facts.
        start: True start pose.
    """

    def __init__(self, course: Course, start: Pose) -> None:
        self._course = course
        self._taken_at_m: dict[str, Point] = {}
        self._moment = Moment(start, 0, course.shortest_m, 0, self._taken_at_m)
        self._read = 0
        self._pending: Ask | None = None

    def before_ask(self, ask: Ask, exchanges: Sequence[Exchange]) -> None:
        """A question is pending after these exchanges of the same episode, oldest first."""
        for exchange in exchanges[self._read :]:
            self._moment = self._after(exchange)
        self._read = len(exchanges)
        self._pending = ask

    def of(self, question: Question) -> SlotTruth:
        """The truth of the pending question; raises `UsageError` when another one is asked."""
        if self._pending is None or self._pending.question != question:
            message = (
                "expected the pending question of a running episode: the simulated observer "
                "cannot judge recorded ones, because it knows the truth only while a scene runs"
            )
            raise UsageError(message)
        return slot_truth(self._course, self._moment, self._pending)

    def _after(self, exchange: Exchange) -> Moment:
        before, truth = self._moment, exchange.truth
        queries = before.queries + (len(exchange.ranked.queries) if exchange.ranked else 0)
        poses = truth.poses if truth is not None else ()
        distances_m = truth.goal_distances_m if truth is not None else ()
        if isinstance(exchange.request, Look) and isinstance(exchange.response, Seen) and poses:
            for view in exchange.response.views:
                self._taken_at_m[view.picture.sha256] = poses[0].position_m
        moved = isinstance(exchange.request, Move) and isinstance(exchange.response, Moved)
        return Moment(
            pose=poses[-1] if poses else before.pose,
            step=before.step + (len(poses) if moved else 0),
            least_goal_m=min(before.least_goal_m, *distances_m, math.inf),
            queries=queries,
            taken_at_m=self._taken_at_m,
        )


def slot_truth(course: Course, moment: Moment, ask: Ask) -> SlotTruth:
    """The right answer to a question, by method.md's definition of its slot."""
    question = ask.question
    offered = [item for item in ask.facts.candidates if item.key in question.keys]
    here_m = course.field.distance_m(moment.pose.position_m)
    match question.slot:
        case Slot.SEEING:
            target = best_view(goal_after_m(course, moment.pose, offered), offered)
        case Slot.DIRECT:
            # Nothing was vetoed before this question: what cannot move a step is not right [C].
            movable = [item for item in offered if _steps_along(course, item) > 0]
            target = best_view(goal_after_m(course, moment.pose, movable), movable)
        case Slot.GLANCE:
            target = best_sector(course, moment.pose, offered)
        case Slot.TRANSITION:
            past = true_leg(course, here_m, legs=len(question.legs)) > question.leg
            target = "next" if past else "stay"
        case Slot.GROUND:
            target = "here" if here_m < SUCCESS_M else "ahead"
        case Slot.JOURNEY:
            target = "covered" if moment.least_goal_m < SUCCESS_M else "missing"
        case Slot.LOOKBACK:
            target = better_frame(course, moment, offered)
    return SlotTruth(
        target=target,
        step=moment.step,
        queries=moment.queries,
        headings_rad={item.key: _offset_rad(item) for item in offered},
        fan_offset_rad=course.profile.fan_offset_rad,
    )


def goal_after_m(course: Course, pose: Pose, candidates: Sequence[Candidate]) -> dict[Key, float]:
    """Goal distance g after the bundle that is allowed along each candidate, metres.

    A candidate that was vetoed, or whose free space is unknown, gets the longest bundle: where it
    would have led. As in execution, a collision ends it.
    """
    body = course.body
    ends: dict[Key, float] = {}
    for candidate in candidates:
        end = pose.turned(_offset_rad(candidate))
        for _ in range(_steps_along(course, candidate)):
            step = body.forward(end)
            end = step.pose
            if step.collided:
                break
        ends[candidate.key] = course.field.distance_m(end.position_m)
    return ends


def best_view(goal_after: Mapping[Key, float], offered: Sequence[Candidate]) -> Key | None:
    """The offered view with the least g after its bundle; ties go to the smaller turn."""
    least_m = min(goal_after.values(), default=math.inf)
    if math.isinf(least_m):
        return None
    tied = [item for item in offered if goal_after[item.key] <= least_m + TIE_M]
    return min(tied, key=lambda item: abs(_offset_rad(item))).key


def best_sector(course: Course, pose: Pose, offered: Sequence[Candidate]) -> Key | None:
    """The offered sector nearest the first bearing of the shortest path."""
    corners = course.surface.path(pose.position_m, course.goal_m)
    ahead = [
        corner for corner in corners or () if planar_m(corner, pose.position_m) > NEARBY_CORNER_M
    ]
    if not ahead or not offered:
        return None
    bearing_rad = pose.bearing_rad(ahead[0])

    def apart(item: Candidate) -> tuple[float, float]:
        offset_rad = _offset_rad(item)
        return abs(wrap_rad(offset_rad - bearing_rad)), abs(offset_rad)

    return min(offered, key=apart).key


def true_leg(course: Course, goal_m: float, *, legs: int) -> int:
    """The leg a body at distance g from the goal is in, from 0.

    By the stored leg ends where the ladder has as many legs: a leg is over once g has come down
    to that of its end. Else by progress, min(K, 1 + ⌊Kρ⌋).
    """
    ends_m = course.leg_end_goal_m
    if len(ends_m) == legs:
        over = 0
        while over < legs - 1 and goal_m <= ends_m[over]:
            over += 1
        return over
    progress = 1.0 if course.shortest_m == 0.0 else 1.0 - goal_m / course.shortest_m
    return min(legs, 1 + math.floor(legs * min(1.0, max(0.0, progress)))) - 1


def better_frame(course: Course, moment: Moment, offered: Sequence[Candidate]) -> Key | None:
    """The frame taken nearer to the goal; None under 0.25 m apart or where one is unknown."""
    goal_m: dict[Key, float] = {}
    for item in offered:
        taken = moment.taken_at_m.get(item.picture.sha256) if item.picture else None
        if item.key == "now":
            taken = taken or moment.pose.position_m
        if taken is None:
            return None
        goal_m[item.key] = course.field.distance_m(taken)
    gap_m = abs(goal_m["now"] - goal_m["back"])
    # Two unreachable places differ by nan, which is no target either.
    return min(goal_m, key=lambda key: goal_m[key]) if gap_m >= LOOKBACK_TIE_M else None


def _steps_along(course: Course, candidate: Candidate) -> int:
    limits = course.controller
    if not candidate.feasible or candidate.free_m is None:
        return limits.bundle_steps
    return bundle_steps(candidate.free_m, step_m=course.profile.step_m, config=limits)


def _offset_rad(candidate: Candidate) -> float:
    return candidate.offset_rad or 0.0
