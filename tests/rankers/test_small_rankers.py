from __future__ import annotations

from collections import Counter
from threading import Thread

import pytest

from c2nav_engine.contract.outcome import Abstention, Ordering, TransportFailure
from c2nav_engine.contract.question import Orders, Slot
from c2nav_engine.contract.render import render
from c2nav_engine.errors import RankerStopped, RankerUnavailable, UsageError
from c2nav_engine.rankers.accounting import AskingConfig
from c2nav_engine.rankers.human import PASSED, HandOver, Human
from c2nav_engine.rankers.random_order import RandomOrder
from c2nav_engine.rankers.replay import Replay, recorded_replies
from c2nav_engine.rankers.scripted import Scripted
from c2nav_engine.rankers.wrapper import AskingRanker
from tests.helpers.questions import question


def test_the_random_ranker_is_uniform_over_orders():
    orders = Counter(RandomOrder(seed).answer(render(question())).outcome for seed in range(1200))
    assert len(orders) == 6
    assert min(orders.values()) > 150


def test_the_random_ranker_is_keyed_by_seed_question_and_presentation():
    pair = question(Slot.GROUND, orders=Orders.BOTH)

    def say(seed: int, **kwargs) -> object:
        return RandomOrder(seed).answer(render(pair, **kwargs)).outcome

    assert say(3) == say(3)
    assert len({(say(seed), say(seed, order=1)) for seed in range(40)}) == 4
    outcomes = [AskingRanker(RandomOrder(seed)).rank(pair).outcome for seed in range(60)]
    agreed = sum(isinstance(outcome, Ordering) for outcome in outcomes)
    assert 15 <= agreed <= 45


def test_a_script_that_runs_out_stops_and_says_for_which_slot():
    scripted = Scripted({Slot.SEEING: ["A"]})
    scripted.answer(render(question()))
    with pytest.raises(RankerStopped, match="seeing"):
        scripted.answer(render(question()))


def test_options_nobody_knows_are_named():
    with pytest.raises(UsageError, match=r"no option temperature; its options are: seed"):
        RandomOrder.from_options({"temperature": "1"})
    with pytest.raises(UsageError, match="'x'"):
        RandomOrder.from_options({"seed": "x"})


def test_a_person_answers_from_another_thread():
    desk = HandOver()
    outcomes: list[object] = []
    asking = AskingRanker(Human(desk, who="p1"))
    thread = Thread(target=lambda: outcomes.append(asking.rank(question(Slot.GROUND)).outcome))
    thread.start()
    prompt = desk.wait_pending(10.0)
    assert prompt is not None
    order = Ordering.of("here", "ahead")
    assert not desk.submit(order, request_sha256="stale")
    assert desk.submit(order, request_sha256=prompt.request_sha256)
    thread.join(10.0)
    assert outcomes == [order]
    assert desk.pending is None
    assert not desk.submit(order, request_sha256=prompt.request_sha256)


def test_a_person_may_pass_and_may_leave():
    desk = HandOver()
    seen: list[object] = []

    def ask_twice() -> None:
        try:
            for _ in range(2):
                seen.append(desk.ask(render(question())))
        except RankerStopped as stopped:
            seen.append(stopped)

    thread = Thread(target=ask_twice)
    thread.start()
    prompt = desk.wait_pending(10.0)
    assert prompt is not None
    assert desk.skip(request_sha256=prompt.request_sha256)
    desk.cancel()
    thread.join(10.0)
    assert seen[0] == Abstention(PASSED)
    assert isinstance(seen[1], RankerStopped)


def test_a_replay_plays_what_was_recorded_and_keeps_what_it_missed():
    asked = [question(Slot.GROUND, seed=seed) for seed in range(4)]
    recorded = [AskingRanker(RandomOrder(seed=5)).rank(one) for one in asked]
    replay = Replay(recorded_replies(recorded))
    again = AskingRanker(replay)
    assert [again.rank(one).outcome for one in asked] == [one.outcome for one in recorded]
    assert replay.misses == []
    with pytest.raises(RankerUnavailable, match="not in the record"):
        AskingRanker(replay, AskingConfig(concurrency=1)).rank(question(Slot.JOURNEY))
    assert {prompt.order for prompt in replay.misses} == {0, 1}


def test_failed_transports_are_not_replayed():
    said = iter([TransportFailure("HTTP 500"), "A"])
    asking = AskingRanker(Scripted(lambda prompt: next(said)), sleep=lambda _: None)
    replies = recorded_replies([asking.rank(question())])
    assert [reply.text for (reply,) in replies.values()] == ["A"]
