"""viser's page with our script and style, and its websocket, behind our own doors."""

from __future__ import annotations

import asyncio
import contextlib
import gzip
import http.client
import json
from collections.abc import Callable, Sequence

from fastapi import APIRouter, Request
from fastapi.responses import Response
from starlette.websockets import WebSocket, WebSocketDisconnect
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed
from websockets.typing import Subprotocol

from app.gateway.doors import VISER_POLICY
from app.pages.page import MENU
from c2nav_engine.errors import InternalError

_TAGS = (
    b'<script src="web_assets/boot.js"></script>'
    b'<link rel="stylesheet" href="web_assets/app.css">'
    b'<script type="module" src="web_assets/app.js"></script>'
)
"""Relative addresses, so that a path prefix works. `boot.js` is not a module: it must run before
viser's own script reads the address."""

_PROTOCOL = "viser-v"

_SHARE = b"ShareUrlRequest"
"""viser lets any client open a public tunnel; that message never gets through."""


class ShellPage:
    """Proxies one viser server on a loopback port."""

    def __init__(
        self, port: int, menu: Sequence[str] = (), *, asked: Callable[[], None] = lambda: None
    ) -> None:
        """Nothing is fetched yet.

        Args:
            port: Where viser listens.
            menu: Which pages of `MENU` stand beside it.
            asked: Called whenever somebody asks for the page.
        """
        self._port = port
        self._menu = menu
        self._asked = asked
        self._page = b""
        self._packed = b""

    async def fetch(self) -> None:
        """Fetch viser's page once and add our tags."""
        self._page = with_tags(await asyncio.to_thread(self._fetched), self._menu)
        self._packed = await asyncio.to_thread(gzip.compress, self._page, 6)

    def _fetched(self) -> bytes:
        connection = http.client.HTTPConnection("127.0.0.1", self._port, timeout=30.0)
        try:
            connection.request("GET", "/")
            return connection.getresponse().read()
        finally:
            connection.close()

    def router(self) -> APIRouter:
        """The page and its websocket, both at the root."""
        router = APIRouter()
        router.add_api_route("/", self._get, methods=["GET", "HEAD"], include_in_schema=False)
        router.add_api_websocket_route("/", self._socket)
        return router

    async def _get(self, request: Request) -> Response:
        self._asked()
        headers = {
            "Cache-Control": "no-cache",
            "Content-Security-Policy": VISER_POLICY,
            "Vary": "Accept-Encoding",
        }
        if "gzip" in request.headers.get("accept-encoding", ""):
            headers["Content-Encoding"] = "gzip"
            return Response(self._packed, media_type="text/html", headers=headers)
        return Response(self._page, media_type="text/html", headers=headers)

    async def _socket(self, page: WebSocket) -> None:
        wanted: list[str] = page.scope.get("subprotocols", [])
        protocol = next((name for name in wanted if name.startswith(_PROTOCOL)), None)
        if protocol is None:
            await page.close(code=1002)
            return
        uri = f"ws://127.0.0.1:{self._port}/"
        async with connect(
            uri,
            subprotocols=[Subprotocol(protocol)],
            max_size=None,
            compression=None,
            proxy=None,
        ) as viser:
            await page.accept(subprotocol=protocol)
            await _relay(page, viser)


async def _relay(page: WebSocket, viser: ClientConnection) -> None:
    ways = [asyncio.create_task(_to_viser(page, viser)), asyncio.create_task(_to_page(page, viser))]
    try:
        await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for way in ways:
            way.cancel()
        await asyncio.gather(*ways, return_exceptions=True)
        with contextlib.suppress(RuntimeError, WebSocketDisconnect):
            await page.close()


async def _to_viser(page: WebSocket, viser: ClientConnection) -> None:
    with contextlib.suppress(WebSocketDisconnect, ConnectionClosed):
        while True:
            frame = await page.receive_bytes()
            if _SHARE not in frame[:4096]:
                await viser.send(frame)


async def _to_page(page: WebSocket, viser: ClientConnection) -> None:
    with contextlib.suppress(WebSocketDisconnect, ConnectionClosed, RuntimeError):
        async for frame in viser:
            await (page.send_bytes(frame) if isinstance(frame, bytes) else page.send_text(frame))


def with_tags(page: bytes, menu: Sequence[str] = ()) -> bytes:
    """Our tags and the menu's words at the end of the head.

    viser's page carries its code inside the head, which may hold the same letters; so the last
    closing tag counts.
    """
    end = page.rfind(b"</head>")
    if end < 0:
        message = "expected viser's page to have a head; its version is not the pinned one"
        raise InternalError(message)
    beside = {name: MENU[name] for name in menu if name != "inspector"}
    words = f'<script type="application/json" id="c2-menu-words">{json.dumps(beside)}</script>'
    return page[:end] + words.encode() + _TAGS + page[end:]
