"""A running inspector and a real browser before it."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Generator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Locator, Page, sync_playwright

from app.gateway.front import Front, Server, settings_of
from app.gateway.runs import RunPages
from app.gateway.serving import application, menu_of, mount_pages
from app.inspector.shell import Shell
from app.session.opened import Opened
from app.session.worker import Session
from tests.helpers.loopback import on_loopback

FLAGS = [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
"""Software WebGL, and no traffic of the browser's own."""

PATIENCE_MS = 120_000

MOST_BYTES = 250_000
"""Of one picture that is kept."""


@contextmanager
def inspector(opened: Opened, runs: RunPages | None = None) -> Generator[tuple[str, Session]]:
    """Serve what was opened on a free loopback port; with pages about runs where they are given."""
    session = Session(opened)
    shell = Shell(session)
    session.start()
    app = application(session, shell, menu=menu_of(opened, runs) if runs else ())
    if runs is not None:
        mount_pages(app, opened, runs)
    front = Front(lambda _: nullcontext(app))
    try:
        with on_loopback(Server(settings_of(front), front)) as address:
            yield address, session
    finally:
        session.close()
        shell.close()


@contextmanager
def chromium() -> Generator[Browser]:
    """System Chromium, or the one in CHROMIUM; skips where there is none."""
    path = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("chrome")
    if path is None:
        pytest.skip("no Chromium on PATH; set CHROMIUM to one")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=FLAGS)
        yield browser
        browser.close()


@dataclass
class Visit:
    """One open page: what it asked for, and what went wrong in it."""

    page: Page
    errors: list[str] = field(default_factory=list)
    hosts: set[str] = field(default_factory=set)

    def state(self) -> dict[str, Any]:
        """The state as the page knows it."""
        return json.loads(self.page.evaluate("JSON.stringify(window.c2nav.state)"))

    def until(self, script: str, patience_ms: int = PATIENCE_MS) -> None:
        """Wait until an expression over the page's state `s` holds."""
        self.page.wait_for_function(
            f"() => {{ const s = window.c2nav?.state; return Boolean(s?.schema && ({script})); }}",
            timeout=patience_ms,
        )

    def card(self, key: str) -> Locator:
        """An alternative of the strip."""
        return self.page.locator(f"rank-strip [data-key={key}]")

    def drag(self, key: str, before: str) -> None:
        """Drag one card to the left edge of another."""
        start, end = self.card(key).bounding_box(), self.card(before).bounding_box()
        assert start is not None
        assert end is not None
        mouse = self.page.mouse
        mouse.move(start["x"] + start["width"] / 2, start["y"] + 40)
        mouse.down()
        mouse.move(end["x"] + end["width"] * 0.5, end["y"] + 40, steps=5)
        mouse.move(end["x"] + end["width"] * 0.12, end["y"] + 40, steps=5)
        mouse.up()

    def nodes(self) -> set[str]:
        """Names in viser's scene tree."""
        names: list[str] = self.page.evaluate("Object.keys(window.__viserSceneTree.getState())")
        return set(names)

    def until_node(self, name: str) -> None:
        """Wait until a name stands in viser's scene tree."""
        self.page.wait_for_function(
            "name => window.__viserSceneTree && name in window.__viserSceneTree.getState()",
            arg=name,
            timeout=PATIENCE_MS,
        )


@contextmanager
def visit(
    browser: Browser,
    url: str,
    *,
    size: tuple[int, int] = (1600, 900),
    dark: bool = False,
) -> Generator[Visit]:
    """Open a page and wait until the map and the strip are there."""
    page = browser.new_page(
        viewport={"width": size[0], "height": size[1]}, color_scheme="dark" if dark else "light"
    )
    seen = Visit(page)
    page.on("pageerror", lambda error: seen.errors.append(str(error)))
    page.on(
        "request",
        lambda request: (
            seen.hosts.add(request.url.split("/")[2])
            if request.url.startswith(("http", "ws"))
            else None
        ),
    )
    page.on("websocket", lambda wire: seen.hosts.add(wire.url.split("/")[2]))
    page.goto(url, timeout=PATIENCE_MS)
    page.wait_for_selector("canvas[data-engine]", state="attached", timeout=PATIENCE_MS)
    page.wait_for_selector("rank-strip", state="attached", timeout=PATIENCE_MS)
    seen.until("s.decision")
    yield seen
    page.close()


def picture(
    folder: Path,
    name: str,
    seen: Visit,
    *,
    settle_ms: int = 1500,
    arrange: Callable[[Visit], None] | None = None,
) -> Path:
    """A screenshot for the gallery and the README, once the map has drawn."""
    if arrange is not None:
        arrange(seen)
    seen.page.wait_for_timeout(settle_ms)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.jpg"
    for quality in (76, 68, 60, 50, 40):
        seen.page.screenshot(path=path, type="jpeg", quality=quality)
        if path.stat().st_size < MOST_BYTES:
            break
    return path
