from __future__ import annotations

import math

import pytest

from c2nav_engine.contract.outcome import Abstention, Ordering
from c2nav_engine.contract.question import Slot
from c2nav_engine.experiments.pairing.alignment import Axis, Line, line_of, stands
from c2nav_engine.experiments.pairing.parting import Part, parting
from c2nav_engine.runner.record import EpisodeOutcome
from tests.helpers.accounts import Tale
from tests.helpers.questions import flat_picture, question

ASKED = question(Slot.SEEING)
LEFT, RIGHT = Ordering.of("left", "front", "right"), Ordering.of("right", "front", "left")
AHEAD = tuple((0.0, -0.25 * step) for step in range(1, 5))
ASIDE = tuple((0.25 * step, 0.0) for step in range(1, 5))


def shared() -> Tale:
    return Tale().ask(ASKED, LEFT).walk(*AHEAD)


def parted(a: Tale, b: Tale):
    return parting(a.account().exchanges, b.account().exchanges)


def test_equal_episodes_never_part_whatever_order_their_questions_were_shown_in():
    assert parted(shared(), shared()) is None
    reseeded = question(Slot.SEEING, seed=99)
    assert parted(Tale().ask(ASKED, LEFT), Tale().ask(reseeded, LEFT)) is None
    assert parted(shared().event("fallback"), shared()) is None


def test_another_picture_is_another_question():
    other = question(Slot.SEEING, pictures={"front": flat_picture(9, 9, 9)})
    found = parted(shared().ask(ASKED, LEFT), shared().ask(other, RIGHT))
    assert found is not None
    assert (found.part, found.decision, found.step) == (Part.QUESTION, (1, 1), (4, 4))
    assert "picture" in found.field


def test_another_winner_is_another_answer_and_another_tail_is_none():
    tail = Ordering.of("left", "right", "front")
    assert parted(Tale().ask(ASKED, LEFT), Tale().ask(ASKED, tail)) is None
    found = parted(shared().ask(ASKED, LEFT), shared().ask(ASKED, RIGHT))
    assert found is not None
    assert (found.part, found.first, found.second) == (Part.ANSWER, "elects left", "elects right")
    found = parted(shared().ask(ASKED, LEFT), shared().ask(ASKED, Abstention("unsure")))
    assert found is not None
    assert found.second == "abstention: unsure"


def test_another_way_after_the_same_answer_is_another_motion():
    found = parted(shared().ask(ASKED, LEFT).walk(*AHEAD), shared().ask(ASKED, LEFT).walk(*ASIDE))
    assert found is not None
    assert (found.part, found.decision) == (Part.MOTION, (1, 1))
    assert found.field.startswith("achieved")


def test_a_stop_against_going_on_is_a_motion_and_a_needless_question_a_question():
    stopped = shared().account(EpisodeOutcome.STOPPED).exchanges
    walked = shared().walk(*ASIDE).account().exchanges
    found = parting(stopped, walked)
    assert found is not None
    assert (found.part, found.first) == (Part.MOTION, "stops")
    found = parting(shared().account().exchanges, walked)
    assert found is not None
    assert (found.part, found.first) == (Part.MOTION, "is over")
    found = parting(shared().ask(ASKED, LEFT).account().exchanges, walked)
    assert found is not None
    assert found.part is Part.QUESTION


# ---------------------------------------------------------------- alignment

FAST = Line((0, 0, 0, 1, 1, 1), (0.0, 0.0, 1.0, 2.0, 2.0, 3.0))
SLOW = Line((0, 0, 0, 0, 0, 0, 1), (0.0, 0.0, 0.5, 0.5, 1.0, 1.5, 2.0))


@pytest.mark.parametrize("axis", list(Axis), ids=str)
def test_both_walk_forward_from_the_parting_to_their_ends(axis: Axis):
    found = stands(FAST, SLOW, axis, shared=(0, 1), parted=1)
    assert (found[0].words, found[0].first, found[0].second) == ("decision 0", 0, 0)
    assert all(stand.first <= FAST.last and stand.second <= SLOW.last for stand in found)
    for steps in ([stand.first for stand in found], [stand.second for stand in found]):
        assert steps == sorted(steps)
    assert (found[-1].first, found[-1].second) == (FAST.last, SLOW.last)


def test_by_leg_the_faster_one_waits_at_the_end_of_its_leg():
    found = stands(FAST, SLOW, Axis.LEG, shared=(0,), parted=1)
    pairs = [(stand.first, stand.second) for stand in found if stand.words.startswith("leg 1")]
    assert pairs == [(1, 1), (2, 2), (2, 3), (2, 4), (2, 5)]


def test_by_distance_both_stand_where_they_first_were_so_far():
    found = stands(FAST, SLOW, Axis.DISTANCE, shared=(0,), parted=1)
    at = {stand.words.split()[0]: (stand.first, stand.second) for stand in found}
    assert at["1.0"] == (2, 4)
    assert at["2.0"] == (3, 6)
    assert at["3.0"] == (5, 6)
    with pytest.raises(ValueError, match="reference path"):
        stands(FAST, Line((0, 0)), Axis.DISTANCE, shared=(), parted=0)


def test_an_episode_is_read_by_its_decisions_and_its_reference_path():
    second = question(Slot.SEEING, leg=1)
    line = line_of(Tale().ask(ASKED, LEFT).walk(*AHEAD).ask(second, LEFT).walk(*AHEAD).account())
    assert line.legs == (0, 0, 0, 0, 1, 1, 1, 1, 1)
    assert line.along_m[-1] == pytest.approx(math.dist((0, 0), AHEAD[-1]))
    assert list(line.along_m) == sorted(line.along_m)
