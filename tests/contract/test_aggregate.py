from __future__ import annotations

import itertools
from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from c2nav_engine.contract.aggregate import TOO_FEW_ANSWERS, aggregate, points
from c2nav_engine.contract.outcome import (
    ORDERS_DISAGREE,
    Abstention,
    Empty,
    Invalid,
    Ordering,
    Refused,
    Tie,
    TransportFailure,
    Truncated,
)
from c2nav_engine.contract.question import Orders, Slot
from tests.helpers.questions import question

KEYS = ("left", "front", "right")
PAIR = question(Slot.GROUND)
CYCLIC = question(orders=Orders.CYCLIC)

NON_ANSWERS = st.sampled_from(
    [Invalid("two answers"), Invalid("a number"), Refused(), Truncated(), Empty(),
     TransportFailure("slow"), Abstention("cannot tell")]
)  # fmt: skip
PAIR_ORDERS = st.sampled_from([Ordering.of("here", "ahead"), Ordering.of("ahead", "here")])
PAIR_OUTCOMES = st.one_of(PAIR_ORDERS, NON_ANSWERS, st.just(Tie((("here", "ahead"),))))
FULL = st.sampled_from([Ordering.of(*keys) for keys in itertools.permutations(KEYS)])
WINNER = st.sampled_from([Ordering.winner_only(key, KEYS) for key in KEYS])
CYCLIC_OUTCOMES = st.lists(st.one_of(FULL, WINNER, NON_ANSWERS), min_size=3, max_size=3)


@given(first=PAIR_OUTCOMES, second=PAIR_OUTCOMES)
def test_swapping_the_presentations_leaves_the_verdict(first, second):
    assert aggregate(PAIR, [first, second]) == aggregate(PAIR, [second, first])


@given(first=PAIR_OUTCOMES, second=PAIR_OUTCOMES)
def test_only_two_equal_winners_select(first, second):
    outcome = aggregate(PAIR, [first, second])
    agree = isinstance(first, Ordering) and first == second
    assert isinstance(outcome, Ordering) == agree


def test_two_winners_abstain_by_name():
    orders = [Ordering.of("here", "ahead"), Ordering.of("ahead", "here")]
    assert aggregate(PAIR, orders) == Abstention(ORDERS_DISAGREE)


def test_a_non_answer_beside_an_ordering_speaks_for_the_pair():
    assert aggregate(PAIR, [Ordering.of("here", "ahead"), Empty()]) == Empty()


@given(outcomes=CYCLIC_OUTCOMES, turn=st.integers(0, 2))
def test_the_borda_count_does_not_know_the_order_of_asking(outcomes, turn):
    turned = outcomes[turn:] + outcomes[:turn]
    assert aggregate(CYCLIC, outcomes) == aggregate(CYCLIC, turned)
    assert aggregate(CYCLIC, outcomes) == aggregate(CYCLIC, outcomes[::-1])


@given(outcomes=CYCLIC_OUTCOMES)
def test_fewer_than_two_valid_answers_abstain(outcomes):
    valid = sum(isinstance(outcome, Ordering) for outcome in outcomes)
    abstained = aggregate(CYCLIC, outcomes) == Abstention(TOO_FEW_ANSWERS)
    assert abstained == (valid < 2)


@given(ordering=st.one_of(FULL, WINNER))
def test_every_answer_gives_away_the_same_number_of_points(ordering):
    assert sum(points(ordering).values()) == 3


def test_the_rest_of_a_winner_only_answer_share_their_points():
    assert points(Ordering.winner_only("front", KEYS)) == {
        "front": 2,
        "left": Fraction(1, 2),
        "right": Fraction(1, 2),
    }


def test_a_borda_count_by_hand():
    orders = [Ordering.of("front", "left", "right"), Ordering.of("left", "front", "right")]
    assert aggregate(CYCLIC, [*orders, Invalid("x")]) == Tie((("left", "front"), ("right",)))
    decided = [*orders, Ordering.of("front", "right", "left")]
    assert aggregate(CYCLIC, decided) == Ordering.of("front", "left", "right")


@given(order=FULL)
def test_unanimity_is_kept(order):
    assert aggregate(CYCLIC, [order, order, order]) == order
