from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from typing import Any, cast

import pytest
from fastapi import FastAPI
from starlette.testclient import TestClient
from starlette.websockets import WebSocket, WebSocketDisconnect

from app.gateway.api import api
from app.gateway.doors import STRICT_POLICY, Doors, is_loopback
from app.gateway.feed import Feed
from app.gateway.page import with_tags
from app.session.worker import Session
from c2nav_engine.errors import InternalError
from tests.helpers import stage


@pytest.fixture(scope="module")
def client() -> Iterator[TestClient]:
    session = Session(stage.opened_recording(cycles=5))
    session.start()
    app = FastAPI()
    app.include_router(api(session, Feed(session)))

    @app.websocket("/ws")
    async def echo(socket: WebSocket) -> None:
        await socket.accept()
        await socket.close()

    app.add_middleware(Doors)
    with TestClient(app, base_url="http://127.0.0.1:8080") as client:
        yield client
    session.close()


@pytest.mark.parametrize(
    "host",
    ["evil.example", "127.0.0.1.evil.example", "localhost.evil.example:8080", "10.0.0.7", ""],
)
def test_a_foreign_host_is_refused(client: TestClient, host: str):
    assert client.get("/api/state", headers={"Host": host}).status_code == 403


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost:9999", "[::1]:80", "127.8.8.8:1"])
def test_loopback_passes_with_any_port(client: TestClient, host: str):
    assert client.get("/api/state", headers={"Host": host}).status_code == 200


@pytest.mark.parametrize(
    "origin",
    ["https://evil.example", "null", "file://", "http://localhost@evil.example", "http://["],
)
def test_a_foreign_origin_is_refused_everywhere(client: TestClient, origin: str):
    assert client.get("/api/state", headers={"Origin": origin}).status_code == 403
    assert client.post("/api/commands", headers={"Origin": origin}, json={}).status_code == 403
    with (
        pytest.raises(WebSocketDisconnect),
        client.websocket_connect("/ws", headers={"Origin": origin, "Host": "127.0.0.1"}),
    ):
        pass


def test_our_own_origin_passes(client: TestClient):
    origin = {"Origin": "http://localhost:1234", "Host": "127.0.0.1"}
    assert client.get("/api/state", headers=origin).status_code == 200
    with client.websocket_connect("/ws", headers=origin):
        pass


@pytest.mark.parametrize("path", ["/api/state", "/api/image/x.jpg", "/nothing", "/web_assets/../x"])
def test_every_answer_carries_the_strict_policy(client: TestClient, path: str):
    answer = client.get(path)
    assert answer.headers["content-security-policy"] == STRICT_POLICY
    assert answer.headers["x-content-type-options"] == "nosniff"


def test_refusals_carry_the_policy_too(client: TestClient):
    answer = client.get("/api/state", headers={"Host": "evil.example"})
    assert "content-security-policy" in answer.headers


@pytest.mark.parametrize("path", ["/api/image/..%2f..%2fetc%2fhostname", "/api/image/abc.jpg"])
def test_only_digests_are_pictures(client: TestClient, path: str):
    assert client.get(path).status_code in (404, 422)


def test_the_state_names_its_schema(client: TestClient):
    state = client.get("/api/state").json()
    assert state["schema"] == 1
    assert {"episode", "decision", "pending", "branch", "id"} <= state.keys()


def test_pictures_are_the_bytes_that_were_sent(client: TestClient):
    decision = stage.finished_run(5).exchanges[1]
    pictures = [c.picture for c in decision.request.facts.candidates]  # type: ignore[union-attr]
    for picture in pictures:
        assert picture is not None
        answer = client.get(f"/api/image/{picture.sha256}.jpg")
        assert answer.content == picture.jpeg
        assert "immutable" in answer.headers["cache-control"]


def test_a_stale_id_is_a_conflict(client: TestClient):
    answer = client.post("/api/commands", json={"type": "commit", "id": "gone"})
    assert answer.status_code == 409
    assert "read /api/state again" in answer.json()["detail"]


def test_an_answer_without_an_id_is_refused(client: TestClient):
    assert client.post("/api/commands", json={"type": "commit"}).status_code == 422


def test_an_unknown_command_is_refused(client: TestClient):
    assert client.post("/api/commands", json={"type": "rm"}).status_code == 422


@pytest.mark.parametrize(
    "body",
    [
        '{"type": "move", "by": "step", "count": NaN}',
        '{"type": "move", "by": "step", "count": 1e999}',
        '{"type": "place", "sha256": "", "column": 1, "row": NaN}',
        '{"type": "place", "goal": false, "point_m": [0, 1e999, 0]}',
        '{"type": "hover", "key": "\\ud800"}',
        '{"type": "name", "who": "\\ud800"}',
        '{"type": "\\ud800"}',
        '{"type": "arrange", "id": "b0.0.0", "tiers": [["left"], ["left"]]}',
    ],
)
def test_what_is_no_command_is_told_and_harms_nothing(client: TestClient, body: str):
    answer = client.post(
        "/api/commands", content=body, headers={"Content-Type": "application/json"}
    )
    assert answer.status_code == 422
    assert answer.json()["detail"]
    assert client.get("/api/state").status_code == 200


def test_a_known_command_is_accepted(client: TestClient):
    state = client.get("/api/state").json()
    body = {"type": "move", "by": "decision", "count": 1, "id": state["id"]}
    assert client.post("/api/commands", json=body).status_code == 202


def test_the_event_stream_begins_with_the_whole_state():
    session = Session(stage.opened_recording(cycles=3))
    feed = Feed(session)

    async def first() -> str:
        events = feed.events()
        try:
            return await anext(events)
        finally:
            await cast("Any", events).aclose()

    name, data = asyncio.run(first()).strip().split("\n")
    assert name == "event: state"
    assert json.loads(data.removeprefix("data: "))["schema"] == 1
    session.close()


def test_our_tags_go_to_the_end_of_the_real_head():
    page = b'<head><script>"</head>"</script></head><body>'
    assert with_tags(page).count(b"web_assets/app.js") == 1
    assert with_tags(page).index(b"web_assets/app.js") > page.index(b"</script>")


def test_a_page_without_a_head_is_a_broken_promise():
    with pytest.raises(InternalError, match="pinned"):
        with_tags(b"<html>")


@pytest.mark.parametrize("name", ["localhost", "a.localhost", "127.0.0.1", "127.9.9.9", "::1"])
def test_loopback_names(name: str):
    assert is_loopback(name)


@pytest.mark.parametrize("name", ["", "localhost.", "0.0.0.0", "128.0.0.1", "localhost.com"])
def test_other_names(name: str):
    assert not is_loopback(name)
