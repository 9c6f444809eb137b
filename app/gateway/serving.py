"""Everything behind the one port, put together and taken apart again."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Generator, Sequence
from contextlib import asynccontextmanager, contextmanager
from dataclasses import replace
from pathlib import Path

from fastapi import FastAPI

from app.gateway.agreement import has_agreement, mount_agreement
from app.gateway.api import api
from app.gateway.feed import Feed
from app.gateway.figures import figures
from app.gateway.judging import mount_judging
from app.gateway.runs import RunPages, mount_runs
from app.gateway.viser_socket import viser_socket
from app.inspector.shell import Shell
from app.pages.page import ABOUT_RUNS, MENU
from app.session.first_page import FirstPage
from app.session.opened import Opened
from app.session.worker import Session


def menu_of(opened: Opened, runs: RunPages | None) -> tuple[str, ...]:
    """Names of `MENU` that are served for what was opened."""
    about = () if runs is None else ABOUT_RUNS
    return (*about, *(("agreement",) if has_agreement(opened) else ()), "inspector")


def application(session: Session, shell: Shell, *, menu: Sequence[str] = ()) -> FastAPI:
    """All but the page and its files, which `front.Front` answers for.

    Args:
        session: What is shown; must be started by the caller.
        shell: Its viser page.
        menu: Names of `MENU`: the pages behind the same port, which the caller mounts.
    """
    feed = Feed(session)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncGenerator[None]:
        feed.attach()
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
    app.include_router(viser_socket(shell.port))
    beside = {name: MENU[name] for name in menu if name != "inspector"}

    @app.get("/api/menu")
    def words() -> dict[str, str]:
        """The pages that stand beside the inspector, by address."""
        return beside

    return app


def mount_pages(
    app: FastAPI, opened: Opened, runs: RunPages | None, *, beside: Sequence[Path] = ()
) -> None:
    """Add every page that belongs to what was opened; arguments as in `inspector`."""
    menu = menu_of(opened, runs)
    mount_judging(app, [entry.entry_id for entry in opened.entries])
    mount_agreement(app, opened, menu=menu, beside=beside)
    if runs is not None:
        mount_runs(app, replace(runs, menu=menu))


@contextmanager
def inspector(
    opened: Opened,
    first_page: FirstPage,
    *,
    runs: RunPages | None = None,
    beside: Sequence[Path] = (),
) -> Generator[FastAPI]:
    """The inspector on what was opened, for as long as the context lasts.

    Args:
        opened: What to show.
        first_page: What the first page waits for.
        runs: Pages about the runs of a folder, beside the inspector.
        beside: Re-evaluations, whose rankers count on the agreement page too.

    Raises:
        C2NavError: When the source's first entry cannot be opened.
    """
    session = Session(opened, first_page=first_page)
    shell = Shell(session)
    session.start()
    try:
        app = application(session, shell, menu=menu_of(opened, runs))
        mount_pages(app, opened, runs, beside=beside)
        if runs is not None:
            runs.library.start()
        yield app
    finally:
        session.close()
        shell.close()
        if runs is not None:
            runs.library.close()
