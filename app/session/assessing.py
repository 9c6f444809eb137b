"""Suspects: every decision held against the truth, once the floor is known.

Evaluation side: the agent never reads it. Regret of a decision never changes once it is taken, so
each is measured once, in the background.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

from app.session.decisions import Decision
from app.session.opened import Opening
from app.session.snapshot import Assessment
from app.session.story import Story
from c2nav_engine.contract.outcome import Key
from c2nav_engine.contract.question import Slot
from c2nav_engine.errors import C2NavError
from c2nav_engine.experiments.regret import controller_fault, regret_m
from c2nav_engine.experiments.truth import Course, best_view, course_of, goal_after_m, true_leg
from c2nav_engine.geometry import Pose
from c2nav_engine.metrics.off_path import off_path_m
from c2nav_engine.navigator.config import LoopConfig
from c2nav_engine.runner.record import Header
from c2nav_engine.world.surface import Surface

EARLY, LATE = "early", "late"

_MOVING = (Slot.SEEING, Slot.GLANCE, Slot.DIRECT)


class Assessor:
    """Measures decisions of one episode; used from one background thread at a time."""

    def __init__(self, header: Header, surface: Callable[[], Surface]) -> None:
        """Remember how the floor is loaded; nothing is loaded yet."""
        self._header = header
        self._load = surface
        self._course: Course | None = None
        self._hopeless = False

    def assess(self, story: Story, known: Iterable[int]) -> dict[int, Assessment]:
        """Assessments of the decisions that are made and not known yet."""
        done = set(known)
        course = self._ready()
        if course is None:
            return {}
        return {
            decision.number: _assessed(course, story, decision)
            for decision in story.decisions
            if not decision.pending and decision.number not in done
        }

    def best_offered(self, story: Story) -> dict[int, Key]:
        """Decision → the offered alternative whose bundle ends nearest to the goal, where known."""
        course = self._ready()
        if course is None:
            return {}
        found: dict[int, Key] = {}
        for decision in story.decisions:
            if decision.slot in _MOVING and decision.question is not None:
                pose = story.track.footsteps[decision.step].pose
                after_m = goal_after_m(course, pose, decision.offered)
                best = best_view(after_m, decision.offered)
                if best is not None:
                    found[decision.number] = best
        return found

    def _ready(self) -> Course | None:
        if self._course is None and not self._hopeless:
            try:
                self._course = _course(self._header, self._load())
            except C2NavError:
                # Without a reachable goal nothing is better than anything else.
                self._hopeless = True
        return self._course


def assessor_of(opening: Opening) -> Assessor | None:
    """An assessor, where there is a goal and a floor."""
    surface = opening.surface
    if surface is None:
        found = getattr(opening.run, "surface", None)
        surface = None if found is None else lambda: found
    if surface is None or opening.header.episode.goal_m is None:
        return None
    return Assessor(opening.header, surface)


def _course(header: Header, surface: Surface) -> Course:
    episode = header.episode
    goal_m = episode.goal_m
    return course_of(
        episode,
        start=episode.start,
        surface=surface,
        field=None if goal_m is None else surface.distance_field(goal_m),
        profile=header.profile,
        controller=LoopConfig.from_json(header.config).controller,
    )


def _assessed(course: Course, story: Story, decision: Decision) -> Assessment:
    pose = story.track.footsteps[decision.step].pose
    off_m = off_path_m(pose.position_m, story.header.episode.reference_path_m)
    regret, words = None, ""
    if decision.slot in _MOVING:
        regret, words = _moved(course, pose, decision)
    elif decision.slot is Slot.TRANSITION:
        words = _turned(course, pose, decision)
    return Assessment(decision.number, regret, words, off_m)


def _moved(course: Course, pose: Pose, decision: Decision) -> tuple[float | None, str]:
    after_m = goal_after_m(course, pose, decision.facts.candidates)
    offered = {c.key: after_m[c.key] for c in decision.facts.candidates if c.feasible}
    vetoed = {key: value for key, value in after_m.items() if key not in offered}
    here_m = course.field.distance_m(pose.position_m)
    words = controller_fault(offered, vetoed, here_m=here_m)
    if decision.elected not in offered:
        return None, words
    regret = regret_m(offered, decision.elected)
    return (regret if math.isfinite(regret) else None), words


def _turned(course: Course, pose: Pose, decision: Decision) -> str:
    """Whether the leg was left too early or too late; "" where leg ends are not known."""
    question = decision.question
    if question is None or len(course.leg_end_goal_m) != len(question.legs):
        return ""
    past = true_leg(course, course.field.distance_m(pose.position_m), legs=len(question.legs))
    if decision.elected == "next" and past <= question.leg:
        return EARLY
    return LATE if decision.elected == "stay" and past > question.leg else ""
