"""Start everything behind the one port, and stop it again."""

from __future__ import annotations

import logging
import os
import socket
import threading
import webbrowser
from collections.abc import AsyncGenerator, Callable, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import uvicorn
from fastapi import FastAPI

from app.gateway.agreement import has_agreement, mount_agreement
from app.gateway.alone import names_of
from app.gateway.api import api
from app.gateway.assets import assets, serve_assets
from app.gateway.doors import Doors
from app.gateway.feed import Feed
from app.gateway.figures import figures
from app.gateway.judging import mount_judging
from app.gateway.runs import RunPages, mount_runs
from app.gateway.shell_page import ShellPage
from app.inspector.shell import Shell
from app.pages.page import ABOUT_RUNS
from app.session.first_page import FirstPage
from app.session.opened import Opened
from app.session.worker import Session

log = logging.getLogger(__name__)

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


def menu_of(opened: Opened, runs: RunPages | None) -> tuple[str, ...]:
    """Names of `MENU` that are served for what was opened."""
    about = () if runs is None else ABOUT_RUNS
    return (*about, *(("agreement",) if has_agreement(opened) else ()), "inspector")


def application(
    session: Session, shell: Shell, *, names: tuple[str, ...] = (), menu: tuple[str, ...] = ()
) -> FastAPI:
    """The gateway as an ASGI application.

    Args:
        session: What is shown; must be started by the caller.
        shell: Its viser page.
        names: Host names that pass beside loopback.
        menu: Names of `MENU`: the pages behind the same port, which the caller mounts.
    """
    feed = Feed(session)
    page = ShellPage(shell.port, menu, asked=session.first_page.asked)

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
    app.include_router(figures(session))
    app.include_router(page.router())
    serve_assets(app, assets())
    app.add_middleware(Doors, names=names)
    return app


def mount_pages(
    app: FastAPI, opened: Opened, runs: RunPages | None, *, beside: Sequence[Path] = ()
) -> None:
    """Add every page that belongs to what was opened; arguments as in `serve`."""
    menu = menu_of(opened, runs)
    mount_judging(app, [entry.entry_id for entry in opened.entries])
    mount_agreement(app, opened, menu=menu, beside=beside)
    if runs is not None:
        mount_runs(app, replace(runs, menu=menu))


class Server(uvicorn.Server):
    """Ends the event streams before it waits for connections to close: they never would."""

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Stop serving."""
        feed = getattr(getattr(self.config.app, "state", None), "feed", None)
        if isinstance(feed, Feed):
            feed.close()
        await super().shutdown(sockets)


def serve(
    opened: Opened,
    listener: socket.socket,
    *,
    host: str,
    no_browser: bool = False,
    ready: Callable[[Address], None] | None = None,
    runs: RunPages | None = None,
    beside: Sequence[Path] = (),
) -> None:
    """Show what was opened until interrupted.

    Args:
        opened: What to show.
        listener: Of `alone.listen`; closed at the end.
        host: The name or address that it was bound to.
        no_browser: Do not open a browser.
        ready: Called once with the address, before the first request is served.
        runs: Pages about the runs of a folder, beside the inspector and opened first.
        beside: Re-evaluations, whose rankers count on the agreement page too.

    Raises:
        C2NavError: When the source's first entry cannot be opened.
    """
    address = Address(host, listener.getsockname()[1])
    first_page = FirstPage(asked_within_s=2.0, stands_within_s=30.0, sent_within_s=10.0)
    session = Session(opened, first_page=first_page)
    shell = Shell(session)
    session.start()
    try:
        app = application(session, shell, names=names_of(host), menu=menu_of(opened, runs))
        mount_pages(app, opened, runs, beside=beside)
        if runs is not None:
            runs.library.start()
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
            first = f"{address.url}run" if runs is not None else address.url
            threading.Timer(0.5, webbrowser.open, (first,)).start()
        Server(config).run(sockets=[listener])
    finally:
        session.close()
        shell.close()
        if runs is not None:
            runs.library.close()


def _has_display() -> bool:
    return os.name != "posix" or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )


def tunnel_line(address: Address) -> str:
    """How to reach an inspector that runs on a machine without a display; "" on a desktop."""
    if _has_display():
        return ""
    return f"ssh -N -L {address.port}:127.0.0.1:{address.port} {socket.gethostname()}"
