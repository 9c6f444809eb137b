from __future__ import annotations

import base64
import json
import time
from collections.abc import Callable, Iterator

import pytest
from pytest_httpserver import HTTPServer
from werkzeug import Response

from c2nav_engine.contract.outcome import (
    Empty,
    Invalid,
    Ordering,
    Refused,
    TransportFailure,
    Truncated,
)
from c2nav_engine.contract.question import Orders, Picture, Slot
from c2nav_engine.contract.render import render
from c2nav_engine.errors import RankerStopped, RankerUnavailable, UsageError
from c2nav_engine.rankers.accounting import AskingConfig
from c2nav_engine.rankers.openai_chat import OpenAIChat
from c2nav_engine.rankers.reading import read
from c2nav_engine.rankers.wrapper import AskingRanker
from tests.helpers.model_server import (
    CANARY,
    CANARY_ENV,
    completion,
    dropping_server,
    error,
    unused_port,
)
from tests.helpers.questions import question

PATH = "/v1/chat/completions"
Build = Callable[..., OpenAIChat]


@pytest.fixture
def chat(httpserver: HTTPServer, monkeypatch: pytest.MonkeyPatch) -> Iterator[Build]:
    """Builds adapters towards the scripted server, and closes them."""
    monkeypatch.setenv(CANARY_ENV, CANARY)
    built: list[OpenAIChat] = []

    def build(**options: str) -> OpenAIChat:
        defaults = {
            "base_url": httpserver.url_for("/v1"),
            "model": "Qwen/Qwen3-VL-8B-Instruct",
            "key_env": CANARY_ENV,
            "probe": "false",
        }
        built.append(OpenAIChat.from_options({**defaults, **options}))
        return built[-1]

    yield build
    for adapter in built:
        adapter.close()


def asked(httpserver: HTTPServer, index: int = -1) -> dict[str, object]:
    return json.loads(httpserver.log[index][0].data)


def test_words_and_pictures_go_out_as_they_are(httpserver: HTTPServer, chat: Build):
    httpserver.expect_request(PATH).respond_with_json(completion("B > A > C"))
    prompt = render(question())
    reply = chat().answer(prompt)
    content = asked(httpserver)["messages"][0]["content"]  # pyright: ignore
    for sent, part in zip(content, prompt.parts, strict=True):
        if isinstance(part, Picture):
            assert base64.b64decode(sent["image_url"]["url"].split(",")[1]) == part.jpeg
        else:
            assert sent["text"] == part
    assert isinstance(read(prompt, reply), Ordering)
    assert (reply.tokens_in, reply.tokens_out, reply.model) == (100, 7, "served-model")


def test_a_qwen_request_is_greedy_bounded_and_enumerates_the_permutations(
    httpserver: HTTPServer, chat: Build
):
    httpserver.expect_request(PATH).respond_with_json(completion("A"))
    chat().answer(render(question(Slot.GROUND)))
    body = asked(httpserver)
    schema = body["response_format"]["json_schema"]["schema"]  # pyright: ignore
    assert schema["properties"]["ranking"]["enum"] == ["A > B", "B > A"]
    assert (body["temperature"], body["max_tokens"]) == (0.0, 200)
    assert "reasoning_effort" not in body
    assert httpserver.log[0][0].headers["Authorization"] == f"Bearer {CANARY}"


def test_a_reasoning_model_is_sent_effort_and_no_sampling(httpserver: HTTPServer, chat: Build):
    httpserver.expect_request(PATH).respond_with_json(completion("A"))
    reply = chat(model="gpt-5.5-2026-04-23", effort="high").answer(render(question()))
    body = asked(httpserver)
    assert {"temperature", "max_tokens"}.isdisjoint(body)
    assert body["reasoning_effort"] == "high"
    assert body["max_completion_tokens"] == 2000
    assert reply.cost_usd == pytest.approx((100 * 5 + 7 * 30) / 1e6)


def test_sampling_schema_and_image_size_are_options(httpserver: HTTPServer, chat: Build):
    httpserver.expect_request(PATH).respond_with_json(completion("A"))
    adapter = chat(sampling="qwen", schema="false", image_px="32", detail="low")
    big = question(pictures={key: _wide_picture() for key in ("left", "front", "right")})
    adapter.answer(render(big))
    body = asked(httpserver)
    assert (body["temperature"], body["top_k"]) == (0.7, 20)
    assert "response_format" not in body
    image = body["messages"][0]["content"][1]["image_url"]  # pyright: ignore
    assert image["detail"] == "low"
    assert len(image["url"]) < len(base64.b64encode(_wide_picture().jpeg))


@pytest.mark.parametrize(
    ("body", "outcome"),
    [
        (completion(None, refusal="I will not"), Refused()),
        (completion("B >", finish="length"), Truncated()),
        (completion("B > A > C", finish="length"), Truncated()),
        (completion("", finish="length"), Truncated()),
        (completion("", finish="content_filter"), Refused()),
        (completion(None), Empty()),
        (completion(""), Empty()),
        ({**completion("A"), "choices": []}, Empty()),
        ({"id": "x", "object": "chat.completion"}, Empty()),
        ({**completion("A"), "choices": None, "usage": None}, Empty()),
        (completion("Turn 35 degrees left and move 2 m."), Invalid("degrees")),
        (completion("0.87"), Invalid("a number")),
        (completion("A > A > C"), Invalid("duplicate label")),
        (completion('```json\n{"ranking": ["Q"]}\n```'), Invalid("unoffered label Q")),
        (completion("A and also B, or maybe C > A"), Invalid("two answers")),
        (completion("STOP"), Invalid("no label")),
        (completion("B" * 5000), Invalid("too long")),
    ],
)
def test_every_bad_answer_has_its_name(httpserver: HTTPServer, chat: Build, body, outcome):
    httpserver.expect_request(PATH).respond_with_json(body)
    prompt = render(question())
    assert read(prompt, chat().answer(prompt)) == outcome


def test_missing_usage_is_unknown_and_not_zero(httpserver: HTTPServer, chat: Build):
    httpserver.expect_request(PATH).respond_with_json({**completion("A"), "usage": None})
    reply = chat(model="gpt-5.5-2026-04-23").answer(render(question()))
    assert (reply.tokens_in, reply.tokens_out, reply.cost_usd) == (None, None, None)


@pytest.mark.parametrize(
    ("status", "body", "words"),
    [
        (401, error(f"bad key {CANARY}"), "rejected the key"),
        (403, error("forbidden"), CANARY_ENV),
        (429, error("no money", code="insufficient_quota"), "quota"),
        (429, error("no money", kind="insufficient_quota"), "resume"),
    ],
)
def test_a_rejected_key_or_quota_stops_the_run(httpserver, chat, status, body, words):
    httpserver.expect_request(PATH).respond_with_json(body, status=status)
    with pytest.raises(RankerStopped, match=words) as stopped:
        chat().answer(render(question()))
    assert CANARY not in str(stopped.value)
    assert stopped.value.__cause__ is None
    assert len(httpserver.log) == 1


@pytest.mark.parametrize(
    ("status", "headers", "pause_s"),
    [
        (500, {}, 0.0),
        (503, {}, 0.0),
        (429, {"Retry-After": "7"}, 7.0),
        (429, {"Retry-After-Ms": "250"}, 0.25),
        (429, {"Retry-After": "soon"}, 0.0),
        (400, {}, None),
        (404, {}, None),
    ],
)
def test_a_failing_server_is_a_transport_failure(httpserver, chat, status, headers, pause_s):
    httpserver.expect_request(PATH).respond_with_json(
        error(f"boom {CANARY}"), status=status, headers=headers
    )
    reply = chat().answer(render(question()))
    assert isinstance(reply.outcome, TransportFailure)
    assert f"HTTP {status}" in reply.outcome.reason
    assert CANARY not in reply.outcome.reason
    assert reply.retry_after_s == pause_s


def test_a_filtered_request_is_a_refusal(httpserver: HTTPServer, chat: Build):
    httpserver.expect_request(PATH).respond_with_json(
        error("filtered", code="content_filter"), status=400
    )
    assert chat().answer(render(question())).outcome == Refused()


@pytest.mark.parametrize(
    ("body", "content_type"),
    [("{not json", "application/json"), ("<html>", "text/html"), ("[1]", "application/json")],
)
def test_an_answer_that_is_no_json_object_is_a_transport_failure(
    httpserver: HTTPServer, chat: Build, body: str, content_type: str
):
    httpserver.expect_request(PATH).respond_with_data(body, content_type=content_type)
    reply = chat().answer(render(question()))
    assert reply.outcome == TransportFailure("the server's answer is no JSON object")


def test_a_slow_server_is_a_transport_failure(httpserver: HTTPServer, chat: Build):
    def slow(_request: object) -> Response:
        time.sleep(0.6)
        return Response("{}")

    httpserver.expect_request(PATH).respond_with_handler(slow)
    reply = chat(timeout_s="0.1").answer(render(question()))
    assert reply.outcome == TransportFailure("no answer within 0.1 s")


def test_a_dropped_connection_is_a_transport_failure(chat: Build):
    with dropping_server() as url:
        reply = chat(base_url=url).answer(render(question()))
    assert isinstance(reply.outcome, TransportFailure)
    assert reply.retry_after_s == 0.0


def test_a_refused_connection_stops_the_run(chat: Build):
    adapter = chat(base_url=f"http://127.0.0.1:{unused_port()}/v1")
    with pytest.raises(RankerStopped, match="refused"):
        adapter.answer(render(question()))


def test_one_500_in_ten_does_not_end_anything(httpserver: HTTPServer, chat: Build):
    def sometimes(_request: object) -> Response:
        if len(httpserver.log) % 10 == 9:
            return Response(json.dumps(error("boom")), status=500)
        return Response(json.dumps(completion("A > A > C")), content_type="application/json")

    httpserver.expect_request(PATH).respond_with_handler(sometimes)
    ranker = AskingRanker(chat(), sleep=lambda _: None)
    for seed in range(12):
        ranked = ranker.rank(question(orders=Orders.ONCE, seed=seed))
        assert ranked.outcome == Invalid("duplicate label")


def test_a_server_that_stays_down_ends_the_task(httpserver: HTTPServer, chat: Build):
    httpserver.expect_request(PATH).respond_with_json(error("boom"), status=500)
    ranker = AskingRanker(chat(), AskingConfig(retries=2), sleep=lambda _: None)
    with pytest.raises(RankerUnavailable, match="HTTP 500"):
        ranker.rank(question())
    assert len(httpserver.log) == 3


def test_the_key_appears_in_the_header_alone(httpserver: HTTPServer, chat: Build, caplog):
    caplog.set_level("DEBUG")
    httpserver.expect_request(PATH).respond_with_json(completion("A > B > C"))
    adapter = chat()
    ranked = AskingRanker(adapter).rank(question())
    request = httpserver.log[0][0]
    assert CANARY not in request.data.decode()
    assert CANARY not in repr(ranked) + repr(vars(adapter)["_settings"]) + adapter.name
    assert CANARY not in caplog.text


def test_a_missing_key_names_its_variable(chat: Build):
    with pytest.raises(UsageError, match="C2NAV_NOT_SET"):
        chat(key_env="C2NAV_NOT_SET")


@pytest.mark.parametrize(
    "options",
    [{"base_url": ""}, {"image_px": "100"}, {"effort": "huge"}, {"timeout_s": "soon"}, {"x": "1"}],
)
def test_unusable_options_are_usage_errors(chat: Build, options: dict[str, str]):
    with pytest.raises(UsageError):
        chat(**options)


def test_a_preset_fills_in_model_and_server(chat: Build, monkeypatch: pytest.MonkeyPatch):
    small = OpenAIChat.from_options({}, name="qwen3-vl-4b")
    assert small.name == "qwen3-vl-4b:Qwen/Qwen3-VL-4B-Instruct"
    small.close()


def test_a_record_says_how_a_model_was_asked_defaults_included(chat: Build):
    adapter = chat(image_px="64")
    told = adapter.options
    assert (told["sampling"], told["image_px"], told["answer_tokens"]) == ("greedy", "64", "200")
    assert told["key_env"] == CANARY_ENV and CANARY not in repr(told)
    again = OpenAIChat.from_options({**told, "probe": "false"})
    assert again.fingerprint == adapter.fingerprint
    again.close()


def test_the_probe_warns_and_the_run_goes_on(httpserver: HTTPServer, chat: Build, caplog):
    httpserver.expect_request(PATH).respond_with_json({**completion("A"), "usage": None})
    ranker = AskingRanker(chat(probe="true"))
    warnings = ranker.start()
    assert "JSON schema" in warnings[0]
    assert any("usage" in warning for warning in warnings)
    assert isinstance(ranker.rank(question()).outcome, Ordering)
    assert len(httpserver.log) == 2
    first = asked(httpserver, 0)["messages"][0]["content"]  # pyright: ignore
    assert [part["type"] for part in first].count("image_url") == 2


def test_a_capable_server_passes_the_probe(httpserver: HTTPServer, chat: Build):
    httpserver.expect_request(PATH).respond_with_json(completion('{"ranking": "B > A"}'))
    assert chat(probe="true").start() == ()


def test_the_probe_stops_on_a_rejected_key(httpserver: HTTPServer, chat: Build):
    httpserver.expect_request(PATH).respond_with_json(error("no"), status=401)
    with pytest.raises(RankerStopped):
        AskingRanker(chat(probe="true")).rank(question())


def _wide_picture() -> Picture:
    import numpy as np

    from tests.helpers.questions import encoded

    noise = np.random.default_rng(0).integers(0, 255, (96, 128, 3), dtype=np.uint8)
    return encoded(noise)
