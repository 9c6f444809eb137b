from __future__ import annotations

import json
from collections.abc import Callable, Iterator

import pytest
from pytest_httpserver import HTTPServer

from c2nav_engine.contract.outcome import (
    Empty,
    Invalid,
    Ordering,
    Refused,
    TransportFailure,
    Truncated,
)
from c2nav_engine.contract.render import render
from c2nav_engine.rankers.openai_responses import OpenAIResponses
from c2nav_engine.rankers.reading import read
from tests.helpers.model_server import CANARY, response
from tests.helpers.questions import question

PATH = "/v1/responses"
Build = Callable[..., OpenAIResponses]


@pytest.fixture
def responses(httpserver: HTTPServer, monkeypatch: pytest.MonkeyPatch) -> Iterator[Build]:
    monkeypatch.setenv("OPENAI_API_KEY", CANARY)
    built: list[OpenAIResponses] = []

    def build(**options: str) -> OpenAIResponses:
        defaults = {"base_url": httpserver.url_for("/v1"), "probe": "false"}
        built.append(OpenAIResponses.from_options({**defaults, **options}, name="gpt-5.5"))
        return built[-1]

    yield build
    for adapter in built:
        adapter.close()


def test_the_preset_pins_the_dated_model_and_stores_nothing(httpserver, responses: Build):
    httpserver.expect_request(PATH).respond_with_json(response('{"ranking": "B > A > C"}'))
    prompt = render(question())
    reply = responses().answer(prompt)
    body = json.loads(httpserver.log[0][0].data)
    assert body["model"] == "gpt-5.5-2026-04-23"
    assert body["store"] is False
    assert body["reasoning"] == {"effort": "low"}
    assert body["text"]["format"]["strict"] is True
    assert {"temperature", "max_tokens"}.isdisjoint(body)
    assert body["max_output_tokens"] == 2000
    types = [part["type"] for part in body["input"][0]["content"]]
    assert types.count("input_image") == 3
    assert isinstance(read(prompt, reply), Ordering)
    assert reply.cost_usd == pytest.approx((100 * 5 + 7 * 30) / 1e6)


@pytest.mark.parametrize(
    ("body", "outcome"),
    [
        (response(None), Empty()),
        (response("B > A > C", status="incomplete"), Truncated()),
        (
            response(None, status="incomplete", incomplete_details={"reason": "max_output_tokens"}),
            Truncated(),
        ),
        (
            response(None, status="incomplete", incomplete_details={"reason": "content_filter"}),
            Refused(),
        ),
        (
            response(None, output=[{"type": "message", "content": [{"refusal": "I will not"}]}]),
            Refused(),
        ),
        (response(None, output=[]), Empty()),
        (response(None, output=None, usage=None), Empty()),
        (
            response(None, status="failed", error={"message": "overloaded"}),
            TransportFailure("overloaded"),
        ),
        (response("0.87"), Invalid("a number")),
    ],
)
def test_every_bad_response_has_its_name(httpserver, responses: Build, body, outcome):
    httpserver.expect_request(PATH).respond_with_json(body)
    prompt = render(question())
    assert read(prompt, responses().answer(prompt)) == outcome
