"""The door that opens first: viser's page and our files, while all else is still being loaded.

A browser takes a second to read that page, about as long as this program takes to load. Side by
side, a researcher waits for the slower of the two and not for both.
"""

from __future__ import annotations

import asyncio
import os
import socket
import threading
import webbrowser
from collections.abc import Callable
from contextlib import AbstractContextManager, AsyncExitStack, ExitStack
from dataclasses import dataclass

import uvicorn
from starlette.applications import Starlette
from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse, Response
from starlette.types import Receive, Scope, Send

from app.gateway.alone import names_of
from app.gateway.assets import asset_answer, assets
from app.gateway.doors import Doors
from app.gateway.page import Page
from app.session.first_page import FirstPage

Load = Callable[[FirstPage], AbstractContextManager[Starlette]]
"""Makes the application, told of what the first page waits for; closed again at the end."""

_NO_LIMIT = 1 << 40
"""Bytes of one websocket frame: a scene arrives as one."""


@dataclass(frozen=True, slots=True)
class Address:
    """Where a running inspector is reached."""

    host: str
    port: int

    @property
    def url(self) -> str:
        """What to open in a browser."""
        return f"http://{self.host}:{self.port}/"


class Front:
    """ASGI: answers for the page and its files at once, for all else once the rest is there."""

    def __init__(self, load: Load) -> None:
        """Nothing is loaded yet.

        Args:
            load: Makes the rest; called in a thread once the server runs.
        """
        self._load = load
        self._loading: asyncio.Task[Starlette] | None = None
        self._first_page = FirstPage(
            asked_within_s=2.0, stands_within_s=30.0, sent_within_s=10.0, shown_within_s=5.0
        )
        self._page, self._files = Page(), assets()
        self._made = ExitStack()

    @property
    def failure(self) -> BaseException | None:
        """Why the rest could not be loaded."""
        loading = self._loading
        return None if loading is None or not loading.done() else loading.exception()

    @property
    def rest(self) -> Starlette | None:
        """Everything else, once it is there."""
        loading = self._loading
        if loading is None or not loading.done() or loading.exception() is not None:
            return None
        return loading.result()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer, wait, or pass on."""
        if scope["type"] == "lifespan":
            await self._live(receive, send)
            return
        early = self._early(scope)
        if early is not None:
            await early(scope, receive, send)
            return
        if self._loading is not None:
            await asyncio.wait([self._loading])
        rest = self.rest
        if rest is not None:
            await rest(scope, receive, send)
        elif scope["type"] == "http":
            await PlainTextResponse("the inspector could not open", 503)(scope, receive, send)
        else:
            await receive()
            await send({"type": "websocket.close", "code": 1013})

    def _early(self, scope: Scope) -> Response | None:
        if scope["type"] != "http" or scope["method"] not in ("GET", "HEAD"):
            return None
        path = scope["path"].removeprefix(scope.get("root_path", ""))
        if path == "/":
            self._first_page.asked()
            return self._page.answer(Headers(scope=scope))
        name = path.removeprefix("/web_assets/")
        return None if name == path else asset_answer(self._files, name, Headers(scope=scope))

    async def _live(self, receive: Receive, send: Send) -> None:
        """Load beside serving; what the rest does at its start and end is done then."""
        await receive()
        async with AsyncExitStack() as life:
            self._loading = asyncio.create_task(self._open(life))
            await send({"type": "lifespan.startup.complete"})
            await receive()
            # A thread cannot be stopped half-way through its imports.
            await asyncio.wait([self._loading])
        await send({"type": "lifespan.shutdown.complete"})

    async def _open(self, life: AsyncExitStack) -> Starlette:
        rest = await asyncio.to_thread(self._make)
        await life.enter_async_context(rest.router.lifespan_context(rest))
        return rest

    def _make(self) -> Starlette:
        return self._made.enter_context(self._load(self._first_page))

    def end_streams(self) -> None:
        """Let event streams come to their end."""
        rest = self.rest
        if rest is not None:
            rest.state.feed.close()

    def close(self) -> None:
        """Close what was loaded."""
        self._made.close()


class Server(uvicorn.Server):
    """Ends where loading fails, and event streams before it waits for connections to close."""

    def __init__(self, config: uvicorn.Config, front: Front) -> None:
        """Serve nothing yet.

        Args:
            config: With the front as its application, doors around it.
            front: The same front.
        """
        super().__init__(config)
        self._front = front

    async def on_tick(self, counter: int) -> bool:
        """Called ten times a second."""
        return await super().on_tick(counter) or self._front.failure is not None

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Stop serving."""
        self._front.end_streams()
        await super().shutdown(sockets)


def serve(
    load: Load,
    listener: socket.socket,
    *,
    host: str,
    ready: Callable[[Address], None],
    first: str = "",
    no_browser: bool = False,
) -> None:
    """Serve what is loaded until interrupted.

    Args:
        load: Makes the application.
        listener: Of `alone.listen`; closed at the end.
        host: The name or address that it was bound to.
        ready: Called once with the address, before anything is loaded.
        first: Name of the page that a browser opens first, relative to the address.
        no_browser: Do not open a browser.

    Raises:
        C2NavError: What `load` raises.
    """
    front = Front(load)
    address = Address(host, listener.getsockname()[1])
    ready(address)
    if not no_browser and _has_display():
        threading.Timer(0.2, webbrowser.open, (address.url + first,)).start()
    try:
        Server(settings_of(front, names=names_of(host)), front).run(sockets=[listener])
    finally:
        front.close()
    if front.failure is not None:
        raise front.failure


def settings_of(front: Front, *, names: tuple[str, ...] = ()) -> uvicorn.Config:
    """How a front is served; `names` are host names that pass beside loopback."""
    return uvicorn.Config(
        Doors(front, names=names),
        lifespan="on",
        ws="websockets-sansio",
        ws_max_size=_NO_LIMIT,
        ws_per_message_deflate=False,
        log_level="warning",
        access_log=False,
        timeout_graceful_shutdown=1,
        server_header=False,
    )


def _has_display() -> bool:
    return os.name != "posix" or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )


def tunnel_line(address: Address) -> str:
    """How to reach an inspector that runs on a machine without a display; "" on a desktop."""
    if _has_display():
        return ""
    return f"ssh -N -L {address.port}:127.0.0.1:{address.port} {socket.gethostname()}"
