from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from jaxtyping import Float

from c2nav_engine.contract.question import Slot
from c2nav_engine.controller.config import ControllerConfig
from c2nav_engine.episodes.episode import Episode
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.regret import NOTHING_GOOD, VETOED, controller_fault, regret_m
from c2nav_engine.experiments.truth import (
    Course,
    EpisodeTruth,
    Moment,
    course_of,
    goal_after_m,
    slot_truth,
    true_leg,
)
from c2nav_engine.geometry import Point, Pose
from c2nav_engine.navigator.requests import (
    Action,
    Ask,
    Candidate,
    DepthStats,
    Facts,
    Look,
    Move,
    Moved,
    Rig,
    Seen,
    Step,
    View,
)
from c2nav_engine.runner.exchange import Exchange, Truth
from tests.helpers.questions import flat_picture, question

GOAL: Point = (0.0, 0.0, -8.0)
START = Pose((0.0, 0.0, 0.0), 0.0)


class Floor:
    """An endless floor with a wall at z = −wall; bodies slide along it."""

    source = "built"

    def __init__(self, wall_m: float = math.inf, corner: Point | None = None) -> None:
        self.wall_m = wall_m
        self.corner = corner

    def snap(self, point_m: Point) -> Point | None:
        return point_m

    def geodesic_m(self, start_m: Point, end_m: Point) -> float:
        return math.dist(start_m, end_m)

    def path(self, start_m: Point, end_m: Point) -> list[Point] | None:
        return [start_m, *([self.corner] if self.corner else []), end_m]

    def slide(self, start_m: Point, end_m: Point, *, sliding: bool = True) -> Point:
        return (end_m[0], end_m[1], max(end_m[2], -self.wall_m))

    def distance_field(self, target_m: Point) -> Straight:
        return Straight(target_m)

    def triangles(self) -> Float[np.ndarray, "n 3 3"]:
        return np.zeros((0, 3, 3))


class Straight:
    """Straight distances; beyond x = 50 m the goal is out of reach."""

    def __init__(self, target_m: Point) -> None:
        self.target_m = target_m

    def distance_m(self, point_m: Point) -> float:
        return math.inf if point_m[0] > 50.0 else math.dist(point_m, self.target_m)

    def distances_m(self, points_m: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        return np.array([self.distance_m((x, y, z)) for x, y, z in points_m])


def course(floor: Floor | None = None, *, leg_ends: tuple[int, ...] = ()) -> Course:
    episode = Episode(
        episode_id="1",
        trajectory_id="1",
        scene_id="floor",
        start=START,
        instruction="Walk.",
        goal_m=GOAL,
        reference_path_m=((0.0, 0.0, 0.0), (0.0, 0.0, -3.0), (0.0, 0.0, -6.0), GOAL),
        leg_ends=leg_ends,
    )
    floor = floor or Floor()
    return course_of(
        episode,
        start=START,
        surface=floor,
        field=floor.distance_field(GOAL),
        profile=VLNCE,
        controller=ControllerConfig(),
    )


def at(pose: Pose, *, least_m: float = 8.0, taken: dict[str, Point] | None = None) -> Moment:
    return Moment(pose, 4, least_m, 2, taken or {})


def asking(slot: Slot, candidates: tuple[Candidate, ...] | None = None, leg: int = 0) -> Ask:
    asked = question(slot, leg=leg)
    if candidates is not None:
        offered = {item.key for item in candidates if item.feasible}
        kept = tuple(one for one in asked.alternatives if one.key in offered)
        asked = replace(asked, alternatives=kept)
    else:
        candidates = tuple(Candidate(key, True) for key in asked.keys)
    return Ask(asked, Facts(slot, 0, leg, candidates, START, 0.0, 0.0))


def fan(free_m: float = 3.0, *, without: str = "") -> tuple[Candidate, ...]:
    angles = {"left": 45.0, "front": 0.0, "right": -45.0}
    return tuple(
        Candidate(key, key != without, free_m=free_m, offset_rad=math.radians(degrees))
        for key, degrees in angles.items()
    )


def target(slot: Slot, moment: Moment, on: Course | None = None, **asked: object) -> str | None:
    candidates, leg = asked.get("candidates"), asked.get("leg", 0)
    assert candidates is None or isinstance(candidates, tuple)
    assert isinstance(leg, int)
    return slot_truth(on or course(), moment, asking(slot, candidates, leg)).target


@pytest.mark.parametrize(
    ("yaw_degrees", "expected"), [(0.0, "front"), (-45.0, "left"), (60.0, "right")]
)
def test_seeing_is_the_view_that_leads_nearest_to_the_goal(
    yaw_degrees: float, expected: str
) -> None:
    pose = Pose(START.position_m, math.radians(yaw_degrees))
    assert target(Slot.SEEING, at(pose), candidates=fan()) == expected


def test_seeing_ties_go_to_the_smaller_turn() -> None:
    # No bundle fits anywhere: all views lead to the same place.
    assert target(Slot.SEEING, at(START), candidates=fan(free_m=0.3)) == "front"


def test_seeing_names_only_what_was_offered() -> None:
    assert target(Slot.SEEING, at(START), candidates=fan(without="front")) == "left"


def test_seeing_has_no_target_where_the_goal_is_out_of_reach() -> None:
    lost = Pose((60.0, 0.0, 0.0), 0.0)
    assert target(Slot.SEEING, at(lost), candidates=fan()) is None


def test_direct_action_has_the_same_target_under_its_own_words() -> None:
    actions = tuple(
        replace(item, key="forward" if item.key == "front" else item.key) for item in fan()
    )
    assert target(Slot.DIRECT, at(START), candidates=actions) == "forward"
    turned = Pose(START.position_m, math.radians(-45.0))
    assert target(Slot.DIRECT, at(turned), candidates=actions) == "left"


def test_direct_action_is_never_right_where_no_step_fits() -> None:
    def actions(ahead_m: float, aside_m: float) -> tuple[Candidate, ...]:
        return tuple(
            replace(item, key="forward", free_m=ahead_m)
            if item.key == "front"
            else replace(item, free_m=aside_m)
            for item in fan()
        )

    away = at(Pose(START.position_m, math.pi))
    # Both sides lead away from the goal and are still better than to push a wall.
    assert target(Slot.DIRECT, away, candidates=actions(0.3, 2.0)) in {"left", "right"}
    assert target(Slot.DIRECT, away, candidates=actions(0.3, 0.3)) is None


def test_bundles_are_bounded_by_free_space_and_end_at_a_collision() -> None:
    ends = goal_after_m(course(), START, fan(free_m=0.75))
    assert ends["front"] == pytest.approx(8.0 - 0.5)
    assert goal_after_m(course(), START, fan(free_m=9.0))["front"] == pytest.approx(8.0 - 0.75)
    walled = goal_after_m(course(Floor(wall_m=0.3)), START, fan(free_m=9.0))
    assert walled["front"] == pytest.approx(8.0 - 0.3)
    # Sliding along the wall ends with the step that touched it.
    assert walled["left"] == pytest.approx(
        math.dist((-0.75 * math.sin(math.pi / 4), 0, -0.3), GOAL), abs=0.2
    )


def test_a_vetoed_view_is_followed_as_far_as_a_bundle_goes() -> None:
    ends = goal_after_m(course(), START, fan(free_m=0.3, without="front"))
    assert ends["front"] == pytest.approx(8.0 - 0.75)
    assert ends["left"] == pytest.approx(8.0)


def sectors(*vetoed: int) -> tuple[Candidate, ...]:
    return tuple(
        Candidate(
            f"sector{k}", k not in vetoed, offset_rad=math.radians((60 * k + 195) % 360 - 180)
        )
        for k in range(6)
    )


@pytest.mark.parametrize(
    ("corner", "vetoed", "expected"),
    [
        ((-1.2, 0.0, -1.0), (), "sector1"),
        ((-1.0, 0.0, 1.0), (), "sector2"),
        ((1.0, 0.0, 0.0), (), "sector4"),
        ((-1.2, 0.0, -1.0), (1,), "sector0"),
        ((0.0, 0.0, -0.01), (), "sector0"),
    ],
)
def test_the_glance_follows_the_first_bearing_of_the_shortest_path(
    corner: Point, vetoed: tuple[int, ...], expected: str
) -> None:
    on = course(Floor(corner=corner))
    assert target(Slot.GLANCE, at(START), on, candidates=sectors(*vetoed)) == expected


@pytest.mark.parametrize(
    ("goal_m", "expected"),
    [(8.0, 0), (5.4, 0), (5.3, 1), (2.6, 2), (0.0, 2), (20.0, 0), (math.inf, 0)],
)
def test_the_true_leg_by_progress(goal_m: float, expected: int) -> None:
    assert true_leg(course(), goal_m, legs=3) == expected


@pytest.mark.parametrize(("goal_m", "expected"), [(8.0, 0), (5.1, 0), (5.0, 1), (2.0, 2), (0.0, 2)])
def test_the_true_leg_by_stored_ends(goal_m: float, expected: int) -> None:
    assert true_leg(course(leg_ends=(1, 2, 3)), goal_m, legs=3) == expected


def test_leg_ends_of_another_parse_are_not_used() -> None:
    stored = course(leg_ends=(1, 3))
    assert true_leg(stored, 5.3, legs=3) == true_leg(course(), 5.3, legs=3) == 1


def test_transition_supports_the_next_leg_once_the_true_leg_is_past_the_active_one() -> None:
    halfway = at(Pose((0.0, 0.0, -4.0), 0.0))
    assert target(Slot.TRANSITION, halfway, leg=0) == "next"
    assert target(Slot.TRANSITION, halfway, leg=1) == "stay"


def test_ground_and_journey_turn_at_three_metres() -> None:
    near, far = Pose((0.0, 0.0, -5.1), 0.0), Pose((0.0, 0.0, -5.0), 0.0)
    assert target(Slot.GROUND, at(near)) == "here"
    assert target(Slot.GROUND, at(far)) == "ahead"
    assert target(Slot.JOURNEY, at(far, least_m=2.9)) == "covered"
    assert target(Slot.JOURNEY, at(far, least_m=3.0)) == "missing"


@pytest.mark.parametrize(
    ("back_z_m", "expected"), [(-3.0, "now"), (-6.0, "back"), (-4.9, None), (None, None)]
)
def test_the_better_frame_was_taken_nearer_the_goal(
    back_z_m: float | None, expected: str | None
) -> None:
    now, back = flat_picture(1, 2, 3), flat_picture(200, 100, 50)
    candidates = (Candidate("now", True, picture=now), Candidate("back", True, picture=back))
    taken: dict[str, Point] = {now.sha256: (0.0, 0.0, -5.0)}
    if back_z_m is not None:
        taken[back.sha256] = (0.0, 0.0, back_z_m)
    moment = at(Pose((0.0, 0.0, -5.0), 0.0), taken=taken)
    assert target(Slot.LOOKBACK, moment, candidates=candidates) == expected


def test_an_episode_is_followed_by_its_exchanges() -> None:
    pictures = [flat_picture(10 * k, 0, 0) for k in range(2)]
    poses = tuple(Pose((0.0, 0.0, -float(z)), 0.0) for z in (1, 2, 6, 5))

    def looked(index: int, pose: Pose) -> Exchange:
        view = View("front", 0.0, pictures[index], 3.0, DepthStats(3.0, 0.0))
        truth = Truth((pose,), (math.dist(pose.position_m, GOAL),))
        return Exchange(index, 0, None, Look(Rig.FRONT), Seen((view,), pose), truth=truth)

    steps = tuple(Step(Action.FORWARD, pose, 1.0, False) for pose in poses)
    moved = Exchange(
        1,
        0,
        None,
        Move((Action.FORWARD,) * 4, "elect"),
        Moved(steps),
        truth=Truth(poses, tuple(math.dist(pose.position_m, GOAL) for pose in poses)),
    )
    exchanges = [looked(0, START), moved]
    truth = EpisodeTruth(course(), START)
    journey = asking(Slot.JOURNEY)
    truth.before_ask(journey, exchanges)
    # The least distance on the way was 2 m, although the body now stands 3 m away.
    assert truth.of(journey.question).target == "covered"
    assert truth.of(journey.question).step == 4
    exchanges.append(looked(1, poses[-1]))
    frames = (
        Candidate("now", True, picture=pictures[1]),
        Candidate("back", True, picture=pictures[0]),
    )
    lookback = asking(Slot.LOOKBACK, frames)
    truth.before_ask(lookback, exchanges)
    assert truth.of(lookback.question).target == "now"
    with pytest.raises(UsageError, match="expected the pending question"):
        truth.of(journey.question)


def test_an_episode_without_a_reachable_goal_has_no_truth() -> None:
    floor, lost = Floor(), Pose((60.0, 0.0, 0.0), 0.0)
    episode = Episode("9", "9", "floor", lost, "Walk.", GOAL)
    for goal_field, goal in ((floor.distance_field(GOAL), GOAL), (None, None)):
        with pytest.raises(UsageError, match="episode 9: expected a goal that can be reached"):
            course_of(
                replace(episode, goal_m=goal),
                start=lost,
                surface=floor,
                field=goal_field,
                profile=VLNCE,
                controller=ControllerConfig(),
            )


def test_regret_is_measured_from_the_best_offered() -> None:
    after = {"left": 6.0, "front": 5.5, "right": math.inf}
    assert regret_m(after, "front") == 0.0
    assert regret_m(after, "left") == 0.5
    assert regret_m(after, "right") == math.inf
    assert regret_m({"left": math.inf, "right": math.inf}, "left") == 0.0


def test_where_no_answer_could_be_good_the_words_say_why() -> None:
    assert controller_fault({"left": 5.5}, {"front": 5.0}, here_m=6.0) == ""
    assert controller_fault({"left": 6.2}, {"front": 5.0}, here_m=6.0) == VETOED
    assert controller_fault({"left": 6.2}, {"front": 6.3}, here_m=6.0) == NOTHING_GOOD
    assert controller_fault({}, {}, here_m=6.0) == NOTHING_GOOD
