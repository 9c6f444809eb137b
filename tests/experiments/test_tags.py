from __future__ import annotations

import pytest

from c2nav_engine.contract.outcome import Abstention, Ordering, Refused
from c2nav_engine.contract.question import Slot
from c2nav_engine.controller.config import ControllerConfig
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.experiments.tags import rules
from c2nav_engine.experiments.tags.endings import FAILURES, RULES, Ending, ending_of
from c2nav_engine.experiments.tags.rules import TAGS, tags_of
from c2nav_engine.experiments.truth import Course
from c2nav_engine.metrics.off_path import along_path_m
from c2nav_engine.runner.record import EpisodeOutcome
from tests.helpers.accounts import GOAL_M, Tale
from tests.helpers.meshes import slab, surface_of
from tests.helpers.questions import question

STOPPED = EpisodeOutcome.STOPPED
STRAIGHT = tuple((0.0, -0.25 * step) for step in range(1, 40))
"""Towards the goal, past it by 1.75 m."""
NEAR = STRAIGHT[:24]
"""Up to 2 m before the goal."""
SHORT = STRAIGHT[:8]
"""Up to 6 m before the goal."""
AWAY = tuple((0.0, 0.25 * step) for step in range(1, 9))


@pytest.fixture(scope="module")
def course() -> Course:
    """An open floor; the legs of `LEGS` end 5 m, 2 m and 0 m before the goal."""
    surface = surface_of([slab(-6.0, -11.0, 6.0, 6.0)])
    field = surface.distance_field(GOAL_M)
    return Course(GOAL_M, 8.0, (5.0, 2.0, 0.0), surface, field, VLNCE, ControllerConfig())


def test_reached_but_not_stopped_needs_three_metres_and_no_stop():
    assert rules.reached_not_stopped(Tale().walk(*NEAR).account())
    assert not rules.reached_not_stopped(Tale().walk(*NEAR).account(STOPPED))
    assert not rules.reached_not_stopped(Tale().walk(*SHORT).account())
    assert rules.reached_not_stopped(Tale(goal=False).walk(*NEAR).account()) is None


def test_stopped_early_is_a_stop_before_the_goal_was_ever_near():
    assert rules.stopped_early(Tale().walk(*SHORT).account(STOPPED))
    assert not rules.stopped_early(Tale().walk(*NEAR, (0.0, 0.0)).account(STOPPED))
    assert not rules.stopped_early(Tale().walk(*SHORT).account())


def test_oscillation_is_there_and_back_twice_walk_back_aside():
    there, back = STRAIGHT[:10], STRAIGHT[:10][::-1]
    assert rules.oscillation(Tale().walk(*there, *back, *there).account())
    assert not rules.oscillation(Tale().walk(*there, *back).account())
    tale = Tale().walk(*there).walk(*back, purpose="walk-back").walk(*there)
    assert not rules.oscillation(tale.account())
    assert not rules.oscillation(Tale().walk(*STRAIGHT).account())


def test_an_early_transition_leaves_a_leg_before_its_end(course: Course):
    early = Tale().walk(*STRAIGHT[:4]).sketch(1, advanced=True)
    timely = Tale().walk(*STRAIGHT[:14]).sketch(1, advanced=True)
    assert rules.early_transition(early.account(course=course))
    assert rules.early_transition(timely.account(course=course)) is False
    assert rules.early_transition(early.account()) is None


def test_a_late_transition_stays_past_the_end_of_the_leg(course: Course):
    asked = question(Slot.TRANSITION)
    stay, onward = Ordering.of("stay", "next"), Ordering.of("next", "stay")
    late = Tale().walk(*STRAIGHT[:14]).ask(asked, stay)
    assert rules.late_transition(late.account(course=course))
    assert rules.late_transition(late.account()) is None
    for tale in (
        Tale().walk(*STRAIGHT[:14]).ask(asked, onward),
        Tale().walk(*STRAIGHT[:4]).ask(asked, stay),
    ):
        assert rules.late_transition(tale.account(course=course)) is False


def test_leg_ends_that_are_not_known_leave_transitions_unknown(course: Course):
    tale = Tale(legs=("one", "two")).sketch(1, advanced=True)
    assert rules.early_transition(tale.account(course=course)) is None
    assert rules.late_transition(tale.account(course=course)) is None


def test_all_views_vetoed_at_one_decision_is_enough():
    asked = question(Slot.SEEING)
    some = Tale().ask(asked, Ordering.of(*asked.keys), vetoed=("left",))
    assert not rules.all_views_vetoed(some.account())
    assert rules.all_views_vetoed(some.ask(asked, Abstention(""), vetoed=asked.keys).account())


def test_invalid_answers_are_those_that_could_not_be_used():
    asked = question(Slot.GROUND)
    right = Ordering.of(*asked.keys)
    assert not rules.invalid_answers(Tale().ask(asked, right).account())
    assert not rules.invalid_answers(Tale().ask(asked, Abstention("unsure")).account())
    repaired = Tale().ask(asked, right, orders=(Refused(), right))
    assert rules.invalid_answers(repaired.account())


def test_a_walk_back_rescues_from_afar_and_is_wasted_on_a_failure():
    away = Tale().walk(*AWAY).event("walk-back").walk(*NEAR, purpose="walk-back")
    assert rules.walkback_wasted(away.account())
    rescued = away.account(STOPPED)
    assert rules.walkback_rescued(rescued)
    assert not rules.walkback_wasted(rescued)
    near = Tale().walk(*NEAR).event("walk-back").account(STOPPED)
    assert not rules.walkback_rescued(near)
    assert not rules.walkback_rescued(Tale().walk(*NEAR).account(STOPPED))


def test_best_view_vetoed_where_only_a_vetoed_view_led_nearer(course: Course):
    asked = question(Slot.SEEING, keys=("left", "right"))
    vetoed = Tale().ask(asked, Ordering.of("left", "right"), vetoed=("front",))
    assert rules.best_view_vetoed(vetoed.account(course=course))
    assert rules.best_view_vetoed(vetoed.account()) is None
    asked = question(Slot.SEEING)
    offered = Tale().ask(asked, Ordering.of(*asked.keys), vetoed=("left",))
    assert rules.best_view_vetoed(offered.account(course=course)) is False


def test_never_recovered_ends_off_the_path_and_fails():
    aside = tuple((0.25 * step, 0.0) for step in range(1, 17))
    assert rules.never_recovered(Tale().walk(*aside).account())
    assert not rules.never_recovered(Tale().walk(*aside, *aside[::-1]).account())
    assert not rules.never_recovered(Tale().walk(*NEAR).account(STOPPED))
    assert rules.never_recovered(Tale(path=()).walk(*aside).account()) is None


def test_an_order_flip_is_a_committed_winner_that_another_order_denied():
    asked = question(Slot.SEEING)
    left, right = Ordering.of("left", "front", "right"), Ordering.of("right", "front", "left")
    assert rules.order_flip(Tale().ask(asked, left, orders=(left, left, right)).account())
    assert not rules.order_flip(Tale().ask(asked, left, orders=(left, left)).account())
    disagreed = Abstention("orders disagree")
    assert not rules.order_flip(Tale().ask(asked, disagreed, orders=(left, right)).account())


def test_there_are_twelve_tags_and_each_says_its_rule(course: Course):
    found = tags_of(Tale().walk(*NEAR).account(STOPPED, course=course))
    assert len(TAGS) == 12
    assert list(found) == list(TAGS)
    assert all(len(tag.meaning) > 20 for tag in TAGS.values())


ENDINGS = {
    Ending.SUCCESS: Tale().walk(*NEAR).account(STOPPED),
    Ending.NEVER_NEAR: Tale().walk(*SHORT, *AWAY).account(),
    Ending.REACHED: Tale().walk(*STRAIGHT).account(EpisodeOutcome.STALLED),
    Ending.STOPPED_ELSEWHERE: Tale().walk(*NEAR, (0.0, 0.0)).account(STOPPED),
    Ending.STEP_LIMIT: Tale().walk(*SHORT).account(),
    Ending.STALLED: Tale().walk(*SHORT).account(EpisodeOutcome.STALLED),
    Ending.ERROR: Tale().walk(*NEAR).account(EpisodeOutcome.ERROR),
    Ending.UNKNOWN: Tale(goal=False).walk(*NEAR).account(STOPPED),
}


@pytest.mark.parametrize("ending", list(Ending), ids=str)
def test_every_episode_stands_in_the_budget_once(ending: Ending):
    assert ending_of(ENDINGS[ending]) is ending
    assert set(RULES) == set(Ending) == {Ending.SUCCESS, Ending.UNKNOWN, *FAILURES}


def test_the_length_along_a_path_is_that_of_its_nearest_point():
    path = ((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (4.0, 0.0, 4.0))
    points = [(2.0, 1.0, 1.5), (5.0, 0.0, 2.0), (-3.0, 0.0, 4.0), (4.0, 0.0, 9.0)]
    assert along_path_m(points, path) == pytest.approx([2.0, 6.0, 0.0, 8.0])
    assert along_path_m(points, path[:1]) == pytest.approx([0.0] * 4)
