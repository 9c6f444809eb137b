"""viser behind our port, without a browser: page, assets and websocket, as the pin promises."""

from __future__ import annotations

import gzip
import http.client
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from email.message import Message
from urllib.parse import urlsplit

import pytest
import viser
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Origin, Subprotocol

from app.gateway.doors import STRICT_POLICY, VISER_POLICY
from app.gateway.page import viser_page
from tests.helpers import stage
from tests.helpers.page import inspector

PROTOCOL = Subprotocol(f"viser-v{viser.__version__}")


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with inspector(stage.opened_recording(cycles=4)) as (url, _):
        yield urlsplit(url).netloc


@dataclass
class Answer:
    """An answer, read to its end."""

    status: int
    headers: Message
    body: bytes


def get(address: str, path: str, **headers: str) -> Answer:
    """Ask over a connection of its own; the path goes out as it is."""
    with closing(http.client.HTTPConnection(address, timeout=20.0)) as connection:
        connection.request("GET", path, headers=headers)
        found = connection.getresponse()
        return Answer(found.status, found.headers, found.read())


def test_the_page_is_visers_with_our_tags_and_its_policy(address: str):
    answer = get(address, "/")
    page = answer.body
    assert page.count(b'src="web_assets/app.js"') == 1
    assert page.index(b"web_assets/boot.js") < page.rindex(b"</head>")
    assert answer.headers["Content-Security-Policy"] == VISER_POLICY
    assert answer.headers["Cache-Control"] == "no-cache"


def test_the_page_in_the_package_is_the_one_that_viser_serves():
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    try:
        assert viser_page().read_bytes() == get(f"127.0.0.1:{server.get_port()}", "/").body
    finally:
        server.stop()


def test_the_page_is_packed_for_those_who_ask(address: str):
    answer = get(address, "/", **{"Accept-Encoding": "gzip"})
    assert gzip.decompress(answer.body) == get(address, "/").body


def test_our_files_come_with_the_strict_policy(address: str):
    answer = get(address, "/web_assets/app.js")
    assert answer.status == 200
    assert answer.headers["Content-Security-Policy"] == STRICT_POLICY
    again = get(address, "/web_assets/app.js", **{"If-None-Match": answer.headers["ETag"]})
    assert again.status == 304


@pytest.mark.parametrize(
    "path", ["/web_assets/../pyproject.toml", "/web_assets/%2e%2e/pyproject.toml", "/index.html"]
)
def test_nothing_else_is_served(address: str, path: str):
    assert get(address, path).status == 404


def test_our_own_websocket_speaks_visers_protocol(address: str):
    with connect(
        f"ws://{address}/",
        subprotocols=[PROTOCOL],
        origin=Origin(f"http://{address}"),
        max_size=None,
        proxy=None,
    ) as wire:
        assert wire.subprotocol == PROTOCOL
        assert isinstance(wire.recv(timeout=20.0), bytes)


@pytest.mark.parametrize("origin", ["https://evil.example", "null"])
def test_a_foreign_websocket_is_refused(address: str, origin: str):
    with (
        pytest.raises(InvalidStatus) as refused,
        connect(f"ws://{address}/", subprotocols=[PROTOCOL], origin=Origin(origin), proxy=None),
    ):
        pass
    assert refused.value.response.status_code == 403


def test_the_description_of_the_api_is_served(address: str):
    assert b"/api/commands" in get(address, "/api/openapi.json").body
