from __future__ import annotations

import json
from pathlib import Path

import pytest
from pytest_httpserver import HTTPServer

from c2nav_engine.contract.outcome import Refused, TransportFailure
from c2nav_engine.contract.prompt import Prompt, Reply
from c2nav_engine.contract.question import Slot
from c2nav_engine.errors import RankerStopped, RankerUnavailable, UsageError
from c2nav_engine.rankers.accounting import AskingConfig
from c2nav_engine.rankers.cache import AnswerCache
from c2nav_engine.rankers.completing import completion_through
from c2nav_engine.rankers.openai_chat import OpenAIChat
from c2nav_engine.rankers.openai_responses import OpenAIResponses
from c2nav_engine.rankers.random_order import RandomOrder
from c2nav_engine.rankers.scripted import Scripted
from c2nav_engine.rankers.wrapper import AskingRanker
from tests.helpers.model_server import CANARY, completion, error
from tests.helpers.questions import question

EFFORTS = ("low", "high")
ASKED = {"name": "scripted", "model": "m", "temperature": "0"}


def counting(said: str | Reply = "A") -> tuple[Scripted, list[Prompt]]:
    prompts: list[Prompt] = []

    def say(prompt: Prompt) -> str | Reply:
        prompts.append(prompt)
        return said

    return Scripted(say), prompts


def test_a_second_run_asks_nothing_and_says_so(tmp_path: Path):
    adapter, prompts = counting(Reply(text="A", tokens_in=9, cost_usd=0.5))
    config = AskingConfig(concurrency=1, cache=str(tmp_path))
    runs = [AskingRanker(adapter, config) for _ in range(2)]
    first, second = (run.rank(question(Slot.GROUND)) for run in runs)
    assert len(prompts) == 2
    assert second.outcome == first.outcome
    assert [query.reply.cached for query in second.queries] == [True, True]
    assert [query.reply.cached for query in first.queries] == [False, False]
    assert (runs[1].spent.cached, runs[1].spent.cost_usd) == (2, 0.0)
    assert second.queries[0].reply.tokens_in == 9


def test_another_request_or_another_setting_is_another_entry(tmp_path: Path):
    prompts = [
        AskingRanker(counting()[0]).rank(question(seed=seed)).queries[0].prompt for seed in (1, 2)
    ]
    cache = AnswerCache(tmp_path, ASKED)
    cache.put(prompts[0], Reply(text="A"))
    assert cache.get(prompts[0]) is not None
    assert cache.get(prompts[1]) is None
    assert AnswerCache(tmp_path, {**ASKED, "temperature": "0.7"}).get(prompts[0]) is None


def test_refusals_are_kept_and_failed_transports_are_not(tmp_path: Path):
    cache = AnswerCache(tmp_path, ASKED)
    (query,) = AskingRanker(counting()[0]).rank(question()).queries
    cache.put(query.prompt, Reply(outcome=TransportFailure("HTTP 500")))
    assert cache.get(query.prompt) is None
    cache.put(query.prompt, Reply(outcome=Refused(), text="I will not"))
    kept = cache.get(query.prompt)
    assert kept is not None
    assert (kept.outcome, kept.text, kept.cached) == (Refused(), "I will not", True)


@pytest.mark.parametrize("content", ["", "{", "[]", '{"text": 3}', '{"text": "A", "outcome": "?"}'])
def test_a_broken_entry_is_asked_again(tmp_path: Path, content: str):
    cache = AnswerCache(tmp_path, ASKED)
    (query,) = AskingRanker(counting()[0]).rank(question()).queries
    cache.put(query.prompt, query.reply)
    (entry,) = tmp_path.rglob("*.json")
    entry.write_text(content, encoding="utf-8")
    assert cache.get(query.prompt) is None


def test_cached_answers_do_not_use_up_the_budget(tmp_path: Path):
    adapter, _ = counting()
    for _ in range(3):
        config = AskingConfig(max_queries=1, cache=str(tmp_path))
        AskingRanker(adapter, config).rank(question())
    with pytest.raises(RankerStopped):
        AskingRanker(adapter, AskingConfig(max_queries=0)).rank(question())


def test_a_served_model_s_settings_are_in_its_key_and_its_key_is_not(monkeypatch):
    monkeypatch.setenv("OPENAI_API_KEY", CANARY)
    low, high = (OpenAIResponses.from_options({"effort": e}, name="gpt-5.5") for e in EFFORTS)
    assert low.fingerprint != high.fingerprint
    assert CANARY not in low.fingerprint
    low.close()
    high.close()


def test_a_route_is_completed_once_without_schema_or_pictures(httpserver: HTTPServer):
    httpserver.expect_ordered_request("/v1/chat/completions").respond_with_json(
        error("boom"), status=500
    )
    httpserver.expect_ordered_request("/v1/chat/completions").respond_with_json(
        completion("leg one\nleg two")
    )
    adapter = OpenAIChat.from_options({"base_url": httpserver.url_for("/v1"), "model": "m"})
    complete = completion_through(adapter, sleep=lambda _: None)
    assert complete("cut this") == complete("cut this") == "leg one\nleg two"
    body = json.loads(httpserver.log[-1][0].data)
    assert body["messages"][0]["content"] == [{"type": "text", "text": "cut this"}]
    assert "response_format" not in body
    assert len(httpserver.log) == 2
    adapter.close()


def test_a_server_without_an_answer_leaves_the_route_to_the_english_parser(httpserver: HTTPServer):
    httpserver.expect_request("/v1/chat/completions").respond_with_json(error("no"), status=404)
    adapter = OpenAIChat.from_options({"base_url": httpserver.url_for("/v1"), "model": "m"})
    with pytest.raises(RankerUnavailable, match="404"):
        completion_through(adapter)("cut this")
    adapter.close()
    with pytest.raises(UsageError, match="language model"):
        completion_through(RandomOrder())
