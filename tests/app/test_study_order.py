"""Which decisions a study draws, and in which order a person sees them."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from app.reviews.questions import reshuffled
from app.reviews.queues import APART, Place, queue_of, repeated
from app.reviews.sampling import MOST_AN_EPISODE, Candidate, drawn

EPISODES = st.lists(st.integers(1, 3), min_size=1, max_size=40).map(
    lambda sizes: [f"e{number}" for number, size in enumerate(sizes) for _ in range(size)]
)


@given(EPISODES, st.integers(0, 9), st.sampled_from(["P1", "P2"]))
@settings(max_examples=60, deadline=None)
def test_a_queue_holds_everything_once_ascending_and_repeats_far_apart(
    episodes: list[str], seed: int, name: str
):
    repeats = repeated(episodes, share=0.1, seed=seed)
    queue = queue_of(episodes, repeats, seed=seed, name=name)
    assert sorted(place.item for place in queue if not place.again) == list(range(len(episodes)))
    again = [place.item for place in queue if place.again]
    assert len(set(again)) == len(again)
    assert set(again) <= set(repeats)
    for item in again:
        apart = queue.index(Place(item, again=True)) - queue.index(Place(item))
        assert apart >= APART
    for episode in set(episodes):
        seen = [place.item for place in queue if episodes[place.item] == episode]
        assert seen == sorted(seen)


def test_a_study_of_usual_size_repeats_a_tenth_for_everybody():
    episodes = [f"e{number // 3}" for number in range(60)]
    repeats = repeated(episodes, share=0.1, seed=3)
    assert len(repeats) == 6
    orders = {queue_of(episodes, repeats, seed=3, name=name) for name in ("P1", "P2", "P3")}
    assert len(orders) == 3
    assert {len(queue) for queue in orders} == {66}
    assert queue_of(episodes, repeats, seed=3, name="P1") in orders


@given(st.integers(0, 5), st.integers(1, 9))
@settings(max_examples=30, deadline=None)
def test_a_draw_is_even_over_slots_and_sparse_in_episodes(seed: int, per_slot: int):
    slots = ["seeing"] * 6 + ["transition"] * 3 + ["glance"]
    pool = [
        Candidate(Path("t"), "0" * 64, decision, f"e{episode}", slot)
        for episode in range(12)
        for decision, slot in enumerate(slots)
    ]
    chosen = drawn(pool, per_slot=per_slot, seed=seed)
    assert chosen == drawn(pool, per_slot=per_slot, seed=seed)
    assert len(set(chosen)) == len(chosen)
    assert max(Counter(one.episode for one in chosen).values()) <= MOST_AN_EPISODE
    counts = Counter(one.slot for one in chosen)
    assert max(counts.values()) <= per_slot
    # 12 episodes have room for 36 decisions in all: with some to spare, every slot is filled.
    assert set(counts.values()) == {per_slot}
    assert len(counts) == 3


def test_where_episodes_run_out_slots_still_stand_even():
    slots = ["a", "b", "c", "d", "e", "f"]
    pool = [
        Candidate(Path("t"), "0" * 64, number, f"e{episode}", slot)
        for episode in range(8)
        for number, slot in enumerate(slots)
    ]
    counts = Counter(one.slot for one in drawn(pool, per_slot=8, seed=1))
    assert counts == dict.fromkeys(slots, 4)


@given(st.permutations(["a", "b", "c", "d"]), st.integers(2, 4), st.integers(0, 20))
def test_what_comes_again_stands_elsewhere(keys: list[str], count: int, seed: int):
    shown = tuple(keys[:count])
    other = reshuffled(shown, seed=seed)
    assert sorted(other) == sorted(shown)
    assert all(a != b for a, b in zip(shown, other, strict=True))
