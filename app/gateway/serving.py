"""Start everything behind the one port, and stop it again."""

from __future__ import annotations

import logging
import os
import socket
import threading
import webbrowser
from collections.abc import AsyncGenerator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass

import uvicorn
from fastapi import FastAPI, Request
from fastapi.responses import Response

from app.gateway.api import api
from app.gateway.assets import Asset, assets
from app.gateway.doors import Doors
from app.gateway.feed import Feed
from app.gateway.judging import mount_judging
from app.gateway.shell_page import ShellPage
from app.inspector.shell import Shell
from app.session.opened import Opened
from app.session.worker import Session
from c2nav_engine.errors import UsageError

log = logging.getLogger(__name__)

_NO_LIMIT = 1 << 40
"""Bytes of one websocket frame: a scene arrives as one."""


_WAITING = 64
"""Connections that may wait while the server starts."""


@dataclass(frozen=True, slots=True)
class Address:
    """Where a running inspector is reached."""

    host: str
    port: int

    @property
    def url(self) -> str:
        """What to open in a browser."""
        return f"http://{self.host}:{self.port}/"


def application(session: Session, shell: Shell, *, names: tuple[str, ...] = ()) -> FastAPI:
    """The gateway as an ASGI application.

    Args:
        session: What is shown; must be started by the caller.
        shell: Its viser page.
        names: Host names that pass beside loopback.
    """
    feed = Feed(session)
    page = ShellPage(shell.port)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncGenerator[None]:
        feed.attach()
        await page.fetch()
        yield
        feed.close()

    app = FastAPI(
        title="C²Nav inspector",
        lifespan=lifespan,
        openapi_url="/api/openapi.json",
        docs_url=None,
        redoc_url=None,
    )
    app.state.feed = feed
    app.include_router(api(session, feed))
    app.include_router(page.router())
    _serve_assets(app, assets())
    app.add_middleware(Doors, names=names)
    return app


class Server(uvicorn.Server):
    """Ends the event streams before it waits for connections to close: they never would."""

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Stop serving."""
        feed = getattr(getattr(self.config.app, "state", None), "feed", None)
        if isinstance(feed, Feed):
            feed.close()
        await super().shutdown(sockets)


def _serve_assets(app: FastAPI, files: dict[str, Asset]) -> None:
    @app.get("/web_assets/{name:path}", include_in_schema=False)
    def asset(name: str, request: Request) -> Response:
        found = files.get(name)
        if found is None:
            return Response(status_code=404)
        headers = {"ETag": found.etag, "Cache-Control": "no-cache"}
        if request.headers.get("if-none-match") == found.etag:
            return Response(status_code=304, headers=headers)
        return Response(found.body, media_type=found.media_type, headers=headers)


def serve(
    opened: Opened,
    *,
    host: str = "127.0.0.1",
    port: int = 8080,
    no_browser: bool = False,
    ready: Callable[[Address], None] | None = None,
) -> None:
    """Show what was opened until interrupted.

    Args:
        opened: What to show.
        host: Address to bind; loopback unless the user says otherwise.
        port: Port to bind; 0 takes a free one.
        no_browser: Do not open a browser.
        ready: Called once with the address, before the first request is served.

    Raises:
        C2NavError: When the source's first entry cannot be opened, or the port is taken.
    """
    listener = _listen(host, port)
    address = Address(host, listener.getsockname()[1])
    session = Session(opened)
    shell = Shell(session)
    session.start()
    try:
        app = application(session, shell, names=_names(host))
        mount_judging(app, [entry.entry_id for entry in opened.entries])
        config = uvicorn.Config(
            app,
            ws="websockets-sansio",
            ws_max_size=_NO_LIMIT,
            ws_per_message_deflate=False,
            log_level="warning",
            access_log=False,
            timeout_graceful_shutdown=1,
            server_header=False,
        )
        if ready is not None:
            ready(address)
        if not no_browser and _has_display():
            threading.Timer(0.5, webbrowser.open, (address.url,)).start()
        Server(config).run(sockets=[listener])
    finally:
        session.close()
        shell.close()


def _listen(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listener = socket.socket(family)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((host, port))
    except OSError as error:
        listener.close()
        message = f"expected a free port, came {host}:{port} ({error}); choose another with --port"
        raise UsageError(message) from error
    # Whoever comes between the printed address and the first answer waits, and is not refused.
    listener.listen(_WAITING)
    return listener


def _names(host: str) -> tuple[str, ...]:
    """Names under which a gateway that is bound beyond loopback may be reached."""
    if host in ("127.0.0.1", "localhost", "::1"):
        return ()
    return (host, socket.gethostname(), socket.getfqdn())


def _has_display() -> bool:
    return os.name != "posix" or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )


def tunnel_line(address: Address) -> str:
    """How to reach an inspector that runs on a machine without a display; "" on a desktop."""
    if _has_display():
        return ""
    return f"ssh -N -L {address.port}:127.0.0.1:{address.port} {socket.gethostname()}"
