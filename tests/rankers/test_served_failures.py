"""What a failing server does to a robot: nothing, over whole episodes and over HTTP.

Every failure has its named outcome and leads to the paper's fallback; none turns or moves the
body as an election would, takes the first alternative, draws one, or stops.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager

import pytest
from pytest_httpserver import HTTPServer
from werkzeug import Request, Response

from c2nav_engine.contract.outcome import Answered, Empty, Invalid, Refused, Truncated
from c2nav_engine.errors import RankerStopped, RankerUnavailable
from c2nav_engine.navigator.requests import Ask, Move
from c2nav_engine.navigator.state import Ending
from c2nav_engine.rankers.accounting import AskingConfig
from c2nav_engine.rankers.openai_chat import OpenAIChat
from c2nav_engine.rankers.wrapper import AskingRanker
from tests.helpers.model_server import completion, dropping_server, error
from tests.helpers.open_floor import Tale, drive, task

PATH = "/v1/chat/completions"


@contextmanager
def asking(base_url: str, *, timeout_s: str = "30") -> Generator[AskingRanker]:
    """A ranker on that server that waits for nobody."""
    options = {"base_url": base_url, "model": "made-up", "probe": "false", "timeout_s": timeout_s}
    adapter = OpenAIChat.from_options(options)
    yield AskingRanker(adapter, AskingConfig(retries=2), sleep=lambda _: None)
    adapter.close()


def episode(ranker: AskingRanker, seen: list[Answered]) -> Tale:
    """An episode on an open floor, where every direction is free."""

    def answer(ask: Ask) -> Answered:
        ranked = ranker.rank(ask.question)
        seen.extend(query.outcome for query in ranked.queries)
        return ranked.outcome

    return drive(task(), answer, asks=200)


UNUSABLE: dict[str, tuple[dict[str, object], Answered]] = {
    "refusal": (completion(None, refusal="I will not"), Refused()),
    "filtered": (completion("", finish="content_filter"), Refused()),
    "cut off": (completion("A > B", finish="length"), Truncated()),
    "empty": (completion(""), Empty()),
    "no choices": ({**completion("A"), "choices": []}, Empty()),
    "prose": (completion("Turn left at the sofa and go on"), Invalid("no label")),
    "stop": (completion("STOP"), Invalid("no label")),
    "two answers": (completion("A > B > C, or rather B > A > C"), Invalid("two answers")),
    "duplicates": (completion("A > A"), Invalid("duplicate label")),
    "unoffered": (completion("Z"), Invalid("unoffered label Z")),
    "fenced": (completion('```json\n{"ranking": ["Z"]}\n```'), Invalid("unoffered label Z")),
    "a number": (completion("0.87"), Invalid("a number")),
    "an index": (completion("0"), Invalid("a number")),
    "degrees": (completion("Turn 35 degrees"), Invalid("degrees")),
}


@pytest.mark.parametrize("name", UNUSABLE)
def test_an_unusable_answer_falls_back_until_the_episode_stalls(httpserver: HTTPServer, name: str):
    body, outcome = UNUSABLE[name]
    httpserver.expect_request(PATH).respond_with_json(body)
    seen: list[Answered] = []
    with asking(httpserver.url_for("/v1")) as ranker:
        tale = episode(ranker, seen)
    assert set(seen) == {outcome}
    assert tale.ending is Ending.STALLED and not tale.stopped
    assert len(tale.events("fallback")) == 12
    assert not [r for r in tale.requests if isinstance(r, Move) and r.actions]


def slow(_request: Request) -> Response:
    time.sleep(0.5)
    return Response("{}")


def status(code: int, **headers: str) -> Callable[[Request], Response]:
    body = json.dumps(error("boom"))
    return lambda _: Response(body, code, headers, content_type="application/json")


UNREACHED: dict[str, tuple[Callable[[Request], Response], str, int]] = {
    "500": (status(500), "HTTP 500", 3),
    "429": (status(429, **{"Retry-After": "1"}), "HTTP 429", 3),
    "429 for an hour": (status(429, **{"Retry-After": "3600"}), "HTTP 429", 1),
    "404": (status(404), "HTTP 404", 1),
    "slow": (slow, "no answer within 0.1 s", 3),
}
"""Failure → handler, words of the error, tries of one query."""


@pytest.mark.parametrize("name", UNREACHED)
def test_a_failing_server_ends_the_task_and_moves_nothing(httpserver: HTTPServer, name: str):
    handler, words, tries = UNREACHED[name]
    httpserver.expect_request(PATH).respond_with_handler(handler)
    seen: list[Answered] = []
    with asking(httpserver.url_for("/v1"), timeout_s="0.1") as ranker:
        with pytest.raises(RankerUnavailable, match=words):
            episode(ranker, seen)
        # The first election of a leg is asked in three orders.
        assert ranker.spent.queries == 3 * tries
    assert seen == []


def test_a_dropped_connection_ends_the_task():
    with dropping_server() as url, asking(url) as ranker:
        with pytest.raises(RankerUnavailable, match="the connection broke"):
            episode(ranker, [])
        assert ranker.spent.queries == 9


def test_an_exhausted_quota_stops_the_run_at_once(httpserver: HTTPServer):
    body = error("no money", code="insufficient_quota")
    httpserver.expect_request(PATH).respond_with_json(body, status=429)
    with asking(httpserver.url_for("/v1")) as ranker, pytest.raises(RankerStopped, match="quota"):
        episode(ranker, [])


def test_a_server_that_recovers_is_not_noticed(httpserver: HTTPServer):
    """Every second query fails once: the episode is the one of a sound server."""
    tales: list[Tale] = []
    for fails in (False, True):
        asked: list[int] = []

        def answer(_request: Request, fails: bool = fails, asked: list[int] = asked) -> Response:
            asked.append(1)
            if fails and len(asked) % 2:
                return Response(json.dumps(error("boom")), 503)
            return Response(json.dumps(completion("A")), content_type="application/json")

        httpserver.clear()
        httpserver.expect_request(PATH).respond_with_handler(answer)
        with asking(httpserver.url_for("/v1")) as ranker:
            tales.append(drive(task(), lambda ask, r=ranker: r.rank(ask.question).outcome, asks=8))
    assert tales[0].answers == tales[1].answers
