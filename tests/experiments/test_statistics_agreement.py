from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import kendalltau

from c2nav_engine.experiments.statistics.agreement import (
    Choice,
    kendall_tau,
    krippendorff_alpha,
    mean_kendall_tau,
    tiers_to_ranks,
    top1,
)
from c2nav_engine.experiments.statistics.orders import (
    Shown,
    chance_of_winning,
    first_excess,
    last_excess,
    position_consistency,
    repetition_stability,
)

# Krippendorff, "Computing Krippendorff's Alpha-Reliability" (2011): his nominal tables.
TWO_RATERS = ("aabbdcccedda", "babbbccceddd")
FOUR_RATERS = ("123321412...", "1233224125.3", ".3332342251.", "12332441251.")


def units(raters: tuple[str, ...]) -> list[list[str | None]]:
    return [
        [None if label == "." else label for label in unit] for unit in zip(*raters, strict=True)
    ]


def test_alpha_of_a_table_worked_by_hand() -> None:
    # Units (x, x), (x, y), (y, y): coincidences xx 2, xy 1, yx 1, yy 2; n = 6, n_x = n_y = 3.
    # α = 1 − (6 − 1) · 2 / (3·3 + 3·3) = 4/9.
    assert krippendorff_alpha([["x", "x"], ["x", "y"], ["y", "y"]]) == pytest.approx(4 / 9)


def test_alpha_of_krippendorffs_own_tables() -> None:
    assert krippendorff_alpha(units(TWO_RATERS)) == pytest.approx(0.692, abs=5e-4)
    assert krippendorff_alpha(units(FOUR_RATERS)) == pytest.approx(0.743, abs=5e-4)


@given(st.lists(st.lists(st.sampled_from(["l", "f", "r", None]), max_size=4), max_size=12))
def test_alpha_does_not_mind_who_said_it(table: list[list[str | None]]) -> None:
    reversed_raters = [unit[::-1] for unit in table]
    assert krippendorff_alpha(table) == pytest.approx(krippendorff_alpha(reversed_raters))


def test_alpha_of_perfect_chance_and_no_variation() -> None:
    assert krippendorff_alpha([["l", "l"], ["r", "r"]]) == 1.0
    assert krippendorff_alpha([["l", "l"], ["l", "l"]]) is None
    assert krippendorff_alpha([["l", None], ["r"]]) is None
    labels = np.random.default_rng(0).integers(0, 3, size=(4000, 2))
    by_chance = krippendorff_alpha([[int(a), int(b)] for a, b in labels])
    assert by_chance == pytest.approx(0.0, abs=0.04)


def test_top1_stands_beside_the_chance_of_the_offered_counts() -> None:
    told = top1(
        [Choice("left", "left", 2), Choice("left", "right", 4), Choice("front", "front", 4)]
    )
    assert told is not None
    assert told.agreement.estimate == pytest.approx(2 / 3)
    assert told.chance == pytest.approx((1 / 2 + 1 / 4 + 1 / 4) / 3)
    assert top1([]) is None


tiers = st.dictionaries(st.sampled_from("abcdef"), st.integers(0, 3), min_size=2)


@given(tiers, st.data())
def test_tau_equals_scipys(a: dict[str, int], data: st.DataObject) -> None:
    b = {key: data.draw(st.integers(0, 3)) for key in a}
    ours = kendall_tau(a, b)
    if len(set(a.values())) == 1 or len(set(b.values())) == 1:
        assert ours is None
    else:
        theirs = kendalltau([a[key] for key in a], [b[key] for key in a])[0]
        assert ours == pytest.approx(theirs)


def test_mean_tau_of_a_ranking_with_itself_and_its_reverse_is_zero() -> None:
    ranks = tiers_to_ranks([["left"], ["front"], ["right"]])
    reverse = {key: -rank for key, rank in ranks.items()}
    assert kendall_tau(ranks, ranks) == 1.0
    assert mean_kendall_tau([(ranks, ranks), (ranks, reverse)]) == 0.0
    assert mean_kendall_tau([]) is None


def test_rankings_of_different_keys_are_refused() -> None:
    with pytest.raises(ValueError, match="rankings of the same keys"):
        kendall_tau({"a": 0}, {"b": 0})


def test_a_ranker_of_places_is_inconsistent_and_all_first() -> None:
    orders = [("stay", "next"), ("next", "stay")]
    shown = [Shown(e, (e, 0), order, order[0]) for e in range(10) for order in orders]
    assert position_consistency(shown).estimate == 0.0
    first, last = first_excess(shown, seed=0), last_excess(shown, seed=0)
    assert first is not None and last is not None
    assert (first.estimate, last.estimate) == (0.5, -0.5)
    assert chance_of_winning(shown) == 0.5


def test_a_ranker_of_roles_is_consistent_without_excess() -> None:
    orders = [("stay", "next"), ("next", "stay")]
    shown = [Shown(e, (e, 0), order, "next") for e in range(10) for order in orders]
    assert position_consistency(shown).estimate == 1.0
    first = first_excess(shown, seed=0)
    assert first is not None and first.estimate == 0.0


def test_stability_counts_only_what_was_asked_twice_as_it_was() -> None:
    ab, ba = ("a", "b"), ("b", "a")
    shown = [
        Shown(0, "d0", ab, "a"),
        Shown(0, "d0", ab, "a"),
        Shown(0, "d0", ba, "b"),
        Shown(1, "d1", ab, "a"),
        Shown(1, "d1", ab, None),
        Shown(1, "d2", ab, "b"),
    ]
    stability = repetition_stability(shown)
    assert (stability.estimate, stability.n) == (0.5, 2)
    assert position_consistency(shown).n == 1


def test_answers_that_elect_nothing_are_no_position_effect() -> None:
    assert first_excess([Shown(0, 0, ("a", "b"), None)], seed=0) is None
    assert chance_of_winning([]) is None
