from __future__ import annotations

from dataclasses import replace

import pytest

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
from c2nav_engine.contract.prompt import Prompt, Reply
from c2nav_engine.contract.question import Form, Orders, Slot
from c2nav_engine.errors import RankerStopped, RankerUnavailable
from c2nav_engine.rankers.accounting import AskingConfig
from c2nav_engine.rankers.scripted import Scripted
from c2nav_engine.rankers.wrapper import AskingRanker
from tests.helpers.questions import question

DOWN = Reply(outcome=TransportFailure("HTTP 500"))


class Clock:
    """A clock that ticks a quarter second per reading, and the pauses that were asked for."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.slept_s: list[float] = []

    def read(self) -> float:
        self.now_s += 0.25
        return self.now_s


def ranker(script, *, clock: Clock | None = None, **config) -> AskingRanker:
    clock = clock or Clock()
    asking = replace(AskingConfig(concurrency=1), **config)
    adapter = script if isinstance(script, Scripted) else Scripted(script)
    return AskingRanker(adapter, asking, clock=clock.read, sleep=clock.slept_s.append)


def best_first(*wanted: str):
    """Answers with the label that stands for the first wanted key on offer."""

    def say(prompt: Prompt) -> str:
        by_key = {key: label for label, key in prompt.labels}
        return next(by_key[key] for key in wanted if key in by_key)

    return say


def test_an_answer_is_mapped_back_through_its_labels():
    for seed in range(6):
        ranked = ranker(best_first("right")).rank(question(seed=seed))
        assert ranked.outcome == Ordering.winner_only("right", ("left", "front", "right")) or (
            isinstance(ranked.outcome, Ordering) and ranked.outcome.winner == "right"
        )


def test_a_pair_that_agrees_takes_two_queries_and_selects():
    ranked = ranker(best_first("here")).rank(question(Slot.GROUND))
    assert ranked.outcome == Ordering.of("here", "ahead")
    assert [query.prompt.order for query in ranked.queries] == [0, 1]


def test_a_ranker_that_always_takes_the_first_label_abstains_on_every_pair():
    for seed in range(8):
        ranked = ranker(lambda prompt: "A").rank(question(Slot.TRANSITION, seed=seed))
        assert ranked.outcome == Abstention(ORDERS_DISAGREE)


def test_a_first_label_bias_cannot_win_a_contested_election():
    ranked = ranker(lambda prompt: "A").rank(question(orders=Orders.CYCLIC))
    assert isinstance(ranked.outcome, Tie)
    assert len(ranked.queries) == 3


@pytest.mark.parametrize(
    "bad", ["A > A > C", "", Refused(), Truncated(), Ordering.of("sofa", "left", "front")]
)
def test_one_repair_attempt_then_the_answer_stands(bad):
    asked: list[int] = []

    def say(prompt: Prompt):
        asked.append(prompt.repair)
        return bad

    ranked = ranker(say).rank(question())
    assert asked == [0, 1]
    assert isinstance(ranked.outcome, Invalid | Empty | Refused | Truncated)


def test_a_repaired_answer_counts():
    ranked = ranker(lambda prompt: "B" if prompt.repair else "dunno").rank(question())
    assert isinstance(ranked.outcome, Ordering)
    assert [type(query.outcome) for query in ranked.queries] == [Invalid, Ordering]


@pytest.mark.parametrize("said", ["none", "A = B = C"])
def test_doubt_is_not_pressed_for_a_winner(said: str):
    assert len(ranker(lambda prompt: said).rank(question()).queries) == 1


def test_a_transport_failure_is_tried_again_with_growing_pauses():
    clock = Clock()
    script = {Slot.SEEING: [DOWN, DOWN, "A"]}
    ranked = ranker(script, clock=clock, backoff_s=0.5).rank(question())
    assert isinstance(ranked.outcome, Ordering)
    assert clock.slept_s == [0.5, 1.0]
    assert len(ranked.queries) == 3


def test_a_transport_failure_that_outlives_its_retries_is_an_error():
    with pytest.raises(RankerUnavailable, match=r"seeing question, came: HTTP 500.*resume"):
        ranker(lambda prompt: DOWN, retries=2).rank(question())


@pytest.mark.parametrize("wanted_s", [None, 3600.0])
def test_no_retry_where_it_cannot_help_or_takes_too_long(wanted_s: float | None):
    asked: list[Prompt] = []

    def say(prompt: Prompt) -> Reply:
        asked.append(prompt)
        return Reply(outcome=TransportFailure("busy"), retry_after_s=wanted_s)

    with pytest.raises(RankerUnavailable):
        ranker(say).rank(question())
    assert len(asked) == 1


def test_a_server_s_retry_after_is_kept():
    clock = Clock()
    busy = Reply(outcome=TransportFailure("busy"), retry_after_s=7.0)
    ranker({Slot.SEEING: [busy, "A"]}, clock=clock).rank(question())
    assert clock.slept_s == [7.0]


def test_only_the_failed_order_of_a_pair_is_asked_again():
    answers = {Slot.GROUND: [DOWN, best_first("here"), best_first("here")]}
    said = iter(answers[Slot.GROUND])

    def say(prompt: Prompt):
        this = next(said)
        return this if isinstance(this, Reply) else this(prompt)

    ranked = ranker(say).rank(question(Slot.GROUND))
    assert [query.prompt.order for query in ranked.queries] == [0, 1, 0]
    assert ranked.outcome == Ordering.of("here", "ahead")


def test_a_person_is_asked_once():
    person = Scripted(lambda prompt: Ordering.of("here", "ahead"), asks_once=True)
    ranked = ranker(person).rank(question(Slot.GROUND))
    assert len(ranked.queries) == 1
    assert ranked.outcome == Ordering.of("here", "ahead")


def test_an_ordering_cannot_answer_an_inversion_nor_a_number_a_comparison():
    ordered = ranker(lambda prompt: Ordering.of("left", "front", "right"))
    assert isinstance(ordered.rank(question(form=Form.DEGREES)).outcome, Invalid)
    assert isinstance(ranker(lambda prompt: "45").rank(question()).outcome, Invalid)


def test_the_query_budget_stops_the_run_before_it_is_overdrawn():
    asking = ranker(lambda prompt: "A", max_queries=3)
    asking.rank(question(Slot.GROUND))
    with pytest.raises(RankerStopped, match="3 queries"):
        asking.rank(question(Slot.GROUND))
    assert asking.spent.queries == 2


def test_the_cost_budget_stops_the_run():
    asking = ranker(lambda prompt: Reply(text="A", cost_usd=0.6), max_cost_usd=1.0)
    asking.rank(question())
    asking.rank(question())
    with pytest.raises(RankerStopped, match=r"1\.0 USD"):
        asking.rank(question())


def test_latency_tokens_and_cost_are_counted():
    asking = ranker(lambda prompt: Reply(text="A", tokens_in=10, tokens_out=2, cost_usd=0.5))
    ranked = asking.rank(question())
    assert ranked.queries[0].reply.latency_s == 0.25
    spent = asking.spent
    assert (spent.queries, spent.tokens_in, spent.tokens_out) == (1, 10, 2)
    assert (spent.cost_usd, spent.latency_s) == (0.5, 0.25)


def test_orders_asked_at_once_are_recorded_in_order():
    for _ in range(5):
        ranked = ranker(best_first("front"), concurrency=4).rank(question(orders=Orders.CYCLIC))
        assert [query.prompt.order for query in ranked.queries] == [0, 1, 2]
        assert isinstance(ranked.outcome, Ordering)


def test_the_record_keeps_every_query_and_who_answered():
    ranked = ranker(Scripted(lambda prompt: "nonsense", name="probe")).rank(question())
    assert ranked.ranker == "probe"
    assert [query.reply.text for query in ranked.queries] == ["nonsense", "nonsense"]
    assert not ranked.privileged


def test_it_tells_how_many_queries_are_answered_and_counts_repairs_but_no_failed_tries():
    said = iter([DOWN, "dunno", "B > A > C"])
    told: list[tuple[int, int]] = []
    ranked = ranker(lambda prompt: next(said)).rank_telling(
        question(), lambda answered, wanted: told.append((answered, wanted))
    )
    assert isinstance(ranked.outcome, Ordering)
    assert list(dict.fromkeys(told)) == [(0, 1), (1, 1), (1, 2), (2, 2)]


def test_queries_that_are_open_side_by_side_are_counted_as_they_come():
    told: list[tuple[int, int]] = []
    ranker(best_first("here"), concurrency=2).rank_telling(
        question(Slot.GROUND), lambda answered, wanted: told.append((answered, wanted))
    )
    assert list(dict.fromkeys(told)) == [(0, 2), (1, 2), (2, 2)]
