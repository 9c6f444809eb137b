from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from app.session.draft import (
    NONE_OF_THESE,
    Draft,
    arranged,
    none_of_these,
    outcome_of,
    press,
    take_back,
    tie,
)
from c2nav_engine.contract.outcome import Abstention, Ordering, Tie

KEYS = ("left", "front", "right")


@given(st.permutations(KEYS))
def test_pressing_keys_in_an_order_commits_that_order(order: list[str]):
    draft = Draft()
    for key in order:
        draft = press(draft, key)
    assert outcome_of(draft, KEYS) == Ordering.of(*order)


@given(st.lists(st.sampled_from(KEYS), max_size=8))
def test_a_draft_never_ranks_a_key_twice(presses: list[str]):
    draft = Draft()
    for key in presses:
        draft = press(draft, key)
    assert len(set(draft.keys)) == len(draft.keys)


@given(st.lists(st.sampled_from(KEYS), unique=True, min_size=1))
def test_taking_back_undoes_the_last_press(order: list[str]):
    before = Draft()
    for key in order[:-1]:
        before = press(before, key)
    assert take_back(press(before, order[-1])) == before


def test_unranked_keys_share_the_last_rank():
    assert outcome_of(press(Draft(), "front"), KEYS) == Ordering((("front",), ("left", "right")))


def test_a_tie_at_the_top_selects_nothing():
    draft = press(tie(press(Draft(), "left")), "front")
    assert outcome_of(draft, KEYS) == Tie((("left", "front"), ("right",)))


def test_none_of_these_is_an_abstention_with_its_reason():
    assert outcome_of(none_of_these(), KEYS) == Abstention(NONE_OF_THESE)


def test_dragging_drops_emptied_tiers():
    assert arranged(((), ("left",), (), ("front",))).tiers == (("left",), ("front",))
