"""Twelve automatic tags, each one rule over a recorded episode.

A rule answers yes, no, or None: unknown, because the trace or the scene does not hold what it
needs. Evaluation side: no agent reads it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from c2nav_engine.contract.outcome import Empty, Invalid, Ordering, Refused, Truncated
from c2nav_engine.contract.question import Slot
from c2nav_engine.experiments.regret import VETOED, controller_fault
from c2nav_engine.experiments.tags.account import WALK_BACK, Account, Footpoint, winner_of
from c2nav_engine.experiments.truth import Course, goal_after_m, true_leg
from c2nav_engine.experiments.turning.regrets import SPATIAL
from c2nav_engine.metrics.off_path import off_paths_m
from c2nav_engine.metrics.trajectory import SUCCESS_M
from c2nav_engine.navigator.requests import Facts, Note, SketchState
from c2nav_engine.runner.exchange import Exchange

AWAY_M = 1.5
"""A place counts as left once the body was farther from it than this [C]."""
BACK_M = 0.5
"""A place counts as returned to within this [C]."""
RETURNS = 2
"""Returns that make an oscillation: there and back, and there again [C]."""
OFF_PATH_M = 3.0
"""Beyond this distance the reference path is left: the success radius [C]."""


def reached_not_stopped(account: Account) -> bool | None:
    """The goal was within 3 m at some step, and STOP was never called."""
    return None if account.reached is None else account.reached and not account.stopped


def stopped_early(account: Account) -> bool | None:
    """STOP was called although the goal had never been within 3 m."""
    return None if account.reached is None else account.stopped and not account.reached


def oscillation(account: Account) -> bool:
    """Twice or more the body came back within 0.5 m of a place that it had left by over 1.5 m.

    The next return is looked for from the farthest place of the last; a Walk-Back starts afresh.
    """
    way = account.way
    points = np.array([(at.pose.position_m[0], at.pose.position_m[2]) for at in way])
    returns = begin = 0
    for place, here in enumerate(way):
        if here.purpose == WALK_BACK:
            begin = place
            continue
        since = points[begin : place + 1]
        apart_m = np.linalg.norm(since - points[place], axis=1)
        # The oldest near place decides: what lies between it and here holds the whole excursion.
        near = int(np.argmax(apart_m <= BACK_M))
        left_m = np.linalg.norm(since[near:] - since[near], axis=1)
        if left_m.max() > AWAY_M:
            returns += 1
            begin += near + int(left_m.argmax())
    return returns >= RETURNS


def early_transition(account: Account) -> bool | None:
    """A leg was left while the body had not yet passed its end. Needs leg ends and the scene."""
    course = _course_with_legs(account)
    if course is None:
        return None
    legs, leg = len(account.header.legs), 0
    for exchange in account.exchanges:
        record = exchange.request.record if isinstance(exchange.request, Note) else None
        if not isinstance(record, SketchState):
            continue
        if record.advanced and _true_leg(account, course, exchange.step, legs) <= leg:
            return True
        leg = record.leg
    return False


def late_transition(account: Account) -> bool | None:
    """A Transition question past the leg's end did not elect the next leg. Needs leg ends."""
    course = _course_with_legs(account)
    if course is None:
        return None
    legs = len(account.header.legs)
    return any(
        _true_leg(account, course, exchange.step, legs) > ask.question.leg
        and committed(exchange) != "next"
        for exchange, ask in account.questions()
        if ask.question.slot is Slot.TRANSITION
    )


def all_views_vetoed(account: Account) -> bool:
    """At some decision every view was vetoed, so that nothing was left to ask about."""
    return any(
        facts.candidates and not any(candidate.feasible for candidate in facts.candidates)
        for _, facts in account.facts()
    )


def invalid_answers(account: Account) -> bool:
    """Some answer could not be used: it was invalid, refused, truncated or empty."""
    return any(
        isinstance(query.outcome, Invalid | Refused | Truncated | Empty)
        for exchange, _ in account.questions()
        if exchange.ranked is not None
        for query in exchange.ranked.queries
    )


def walkback_rescued(account: Account) -> bool | None:
    """A Walk-Back began 3 m or more from the goal, and the episode succeeded."""
    if account.succeeded is None:
        return None
    begun_m = [account.at(step).goal_m for step, _ in account.events(WALK_BACK)]
    return account.succeeded and any(
        goal_m is not None and goal_m >= SUCCESS_M for goal_m in begun_m
    )


def walkback_wasted(account: Account) -> bool | None:
    """A Walk-Back took place, and the episode failed all the same."""
    if account.succeeded is None:
        return None
    return not account.succeeded and any(True for _ in account.events(WALK_BACK))


def best_view_vetoed(account: Account) -> bool | None:
    """At some election only a vetoed view would have brought the goal nearer. Needs the scene."""
    course = account.course
    if course is None:
        return None
    return any(
        _fault(course, account.at(step), facts) == VETOED
        for step, facts in account.facts()
        if facts.slot in SPATIAL
    )


def never_recovered(account: Account) -> bool | None:
    """The episode failed, and ended over 3 m from the reference path: it never came back to it."""
    path_m = account.header.episode.reference_path_m
    off_m = off_paths_m([account.way[-1].pose.position_m], path_m)
    if off_m is None or account.succeeded is None:
        return None
    return not account.succeeded and bool(off_m[0] > OFF_PATH_M)


def order_flip(account: Account) -> bool:
    """A ranking was committed although another presentation order elected something else."""
    return any(
        isinstance(exchange.ranked.outcome, Ordering)
        and exchange.override is None
        and any(
            winner_of(query.outcome) not in (None, exchange.ranked.outcome.winner)
            for query in exchange.ranked.queries
        )
        for exchange, _ in account.questions()
        if exchange.ranked is not None
    )


# ---------------------------------------------------------------- what several rules need


def committed(exchange: Exchange) -> str | None:
    """The key that a question's exchange committed, if any."""
    response = exchange.response
    return response.winner if isinstance(response, Ordering) else None


def _course_with_legs(account: Account) -> Course | None:
    """The course, where it knows the end of every leg."""
    course = account.course
    known = course is not None and len(course.leg_end_goal_m) == len(account.header.legs)
    return course if known else None


def _true_leg(account: Account, course: Course, step: int, legs: int) -> int:
    goal_m = course.field.distance_m(account.at(step).pose.position_m)
    return true_leg(course, goal_m, legs=legs)


def _fault(course: Course, here: Footpoint, facts: Facts) -> str:
    """Why no answer could have been good at this place, if so."""
    after_m = goal_after_m(course, here.pose, facts.candidates)
    offered = {c.key: after_m[c.key] for c in facts.candidates if c.feasible}
    vetoed = {key: goal_m for key, goal_m in after_m.items() if key not in offered}
    here_m = course.field.distance_m(here.pose.position_m)
    return controller_fault(offered, vetoed, here_m=here_m)


# ---------------------------------------------------------------- the list


@dataclass(frozen=True, slots=True)
class Tag:
    """An automatic tag.

    Attributes:
        name: Stable column name.
        words: What the page calls it.
        rule: Whether it holds for an episode; None where that is unknown.
    """

    name: str
    words: str
    rule: Callable[[Account], bool | None]

    @property
    def meaning(self) -> str:
        """The rule in words: its docstring."""
        return (self.rule.__doc__ or "").strip()


TAGS: Mapping[str, Tag] = {
    tag.name: tag
    for tag in (
        Tag("reached_not_stopped", "reached but not stopped", reached_not_stopped),
        Tag("stopped_early", "stopped early", stopped_early),
        Tag("oscillation", "oscillation", oscillation),
        Tag("early_transition", "early transition", early_transition),
        Tag("late_transition", "late transition", late_transition),
        Tag("all_views_vetoed", "all views vetoed", all_views_vetoed),
        Tag("invalid_answers", "invalid answers", invalid_answers),
        Tag("walkback_rescued", "walk-back rescued", walkback_rescued),
        Tag("walkback_wasted", "walk-back wasted", walkback_wasted),
        Tag("best_view_vetoed", "best view vetoed", best_view_vetoed),
        Tag("never_recovered", "never recovered after leaving the path", never_recovered),
        Tag("order_flip", "order flip at a committed answer", order_flip),
    )
}
"""The twelve automatic tags by name, in the order of the page."""


def tags_of(account: Account) -> dict[str, bool | None]:
    """Every tag of an episode by name."""
    return {name: tag.rule(account) for name, tag in TAGS.items()}
