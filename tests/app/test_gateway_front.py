"""The first door: the page is there before the rest, which all else waits for."""

from __future__ import annotations

import asyncio
import socket
import threading
from collections.abc import Generator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import httpx
import pytest
from fastapi import FastAPI

from app.cli import main
from app.gateway.alone import listen
from app.gateway.doors import STRICT_POLICY, VISER_POLICY
from app.gateway.feed import Feed
from app.gateway.front import Address, Front, Server, serve, settings_of
from app.session.first_page import FirstPage
from app.session.worker import Session
from c2nav_engine.errors import InputError
from tests.helpers import stage
from tests.helpers.loopback import on_loopback

PATIENCE_S = 20.0


class Rest:
    """What is loaded behind a front: only once it may, and closed at the end."""

    def __init__(self) -> None:
        self.may = threading.Event()
        self.begun = threading.Event()
        self.closed = False

    @contextmanager
    def load(self, _: FirstPage) -> Generator[FastAPI]:
        self.begun.set()
        assert self.may.wait(PATIENCE_S)
        app = FastAPI()
        app.state.feed = Feed(Session(stage.opened_recording(cycles=2)))
        app.get("/api/hello")(lambda: "hello")
        try:
            yield app
        finally:
            self.closed = True


def test_the_page_and_its_files_are_there_before_the_rest():
    rest = Rest()
    front = Front(rest.load)
    with on_loopback(Server(settings_of(front), front)) as address, ThreadPoolExecutor() as beside:
        page = httpx.get(address, timeout=PATIENCE_S)
        assert b"web_assets/boot.js" in page.content
        assert page.headers["content-security-policy"] == VISER_POLICY
        script = httpx.get(f"{address}web_assets/app.js", timeout=PATIENCE_S)
        assert script.headers["content-security-policy"] == STRICT_POLICY
        assert httpx.get(f"{address}web_assets/none.js", timeout=PATIENCE_S).status_code == 404
        assert rest.begun.wait(PATIENCE_S)
        waiting = beside.submit(httpx.get, f"{address}api/hello", timeout=PATIENCE_S)
        assert not waiting.done()
        rest.may.set()
        assert waiting.result().json() == "hello"
    front.close()
    assert rest.closed


def test_whoever_asks_for_the_page_is_known_to_the_rest(monkeypatch: pytest.MonkeyPatch):
    asked = threading.Event()
    monkeypatch.setattr(FirstPage, "asked", lambda _: asked.set())
    rest = Rest()
    rest.may.set()
    front = Front(rest.load)
    with on_loopback(Server(settings_of(front), front)) as address:
        assert httpx.get(f"{address}web_assets/app.js", timeout=PATIENCE_S).status_code == 200
        assert not asked.is_set()
        assert httpx.get(address, timeout=PATIENCE_S).status_code == 200
        assert asked.is_set()
    front.close()


def test_the_end_of_an_answer_does_not_wait_for_an_acknowledgement():
    async def undelayed() -> int:
        accepted = asyncio.Future[int]()

        async def take(_: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            taken = writer.get_extra_info("socket")
            accepted.set_result(taken.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY))
            writer.close()

        listener = listen("127.0.0.1", 0)
        async with await asyncio.start_server(take, sock=listener):
            _, writer = await asyncio.open_connection(*listener.getsockname())
            writer.close()
            return await accepted

    assert asyncio.run(undelayed())


@pytest.mark.parametrize("path", ["", "web_assets/app.js", "api/hello"])
def test_the_first_door_is_guarded_too(path: str):
    rest = Rest()
    rest.may.set()
    front = Front(rest.load)
    with on_loopback(Server(settings_of(front), front)) as address:
        foreign = {"Host": "evil.example"}
        assert httpx.get(f"{address}{path}", headers=foreign).status_code == 403
    front.close()


def test_what_cannot_be_loaded_ends_the_server_and_is_raised():
    told: list[Address] = []

    def load(_: FirstPage):
        message = "expected a trace, came nothing"
        raise InputError(message)

    with pytest.raises(InputError, match="came nothing"):
        serve(
            load,
            listen("127.0.0.1", 0),
            host="127.0.0.1",
            ready=told.append,
            no_browser=True,
        )
    assert told


def test_a_broken_trace_is_refused_in_words(tmp_path, capsys):
    path = tmp_path / "broken.mcap"
    path.write_bytes(b"no trace at all")
    with pytest.raises(SystemExit) as ended:
        main(["inspect", str(path), "--port", "0", "--no-browser"])
    assert ended.value.code == 2
    assert str(path) in capsys.readouterr().err
