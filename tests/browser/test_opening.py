"""A page that comes before the inspector is loaded: it says so, and then becomes the inspector."""

from __future__ import annotations

import threading
from collections.abc import Generator
from contextlib import contextmanager

import pytest
from fastapi import FastAPI
from playwright.sync_api import Browser, expect

from app.gateway.front import Front, Server, settings_of
from app.gateway.serving import inspector
from app.session.first_page import FirstPage
from c2nav_engine.errors import InputError
from tests.helpers import stage
from tests.helpers.loopback import on_loopback
from tests.helpers.page import PATIENCE_MS

OPENING = "document.documentElement.classList.contains('c2-opening')"


class Late:
    """An inspector that is loaded when a test says so."""

    def __init__(self, *, broken: bool = False) -> None:
        self._broken = broken
        self.may = threading.Event()

    @contextmanager
    def load(self, first_page: FirstPage) -> Generator[FastAPI]:
        assert self.may.wait(PATIENCE_MS / 1e3)
        if self._broken:
            message = "expected a trace, came nothing"
            raise InputError(message)
        with inspector(stage.opened_recording(), first_page) as app:
            yield app


@pytest.mark.parametrize("dark", [False, True])
def test_an_early_page_says_opening_and_becomes_the_inspector(browser: Browser, dark: bool):
    late = Late()
    front = Front(late.load)
    errors: list[str] = []
    with on_loopback(Server(settings_of(front), front)) as url:
        page = browser.new_page(color_scheme="dark" if dark else "light")
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(url, timeout=PATIENCE_MS)
        assert page.evaluate(OPENING)
        said = "getComputedStyle(document.body, '::after').content"
        assert page.evaluate(said) == '"opening…"'
        ground = "getComputedStyle(document.documentElement).backgroundColor"
        assert (page.evaluate(ground) == "rgb(16, 18, 21)") is dark
        late.may.set()
        page.wait_for_function(f"!({OPENING})", timeout=PATIENCE_MS)
        page.wait_for_selector("rank-strip [data-key=front] img", timeout=PATIENCE_MS)
        # The map waits in a corner until then, and takes its place after it.
        canvas = page.locator("canvas[data-engine]")
        expect(canvas).to_be_visible(timeout=PATIENCE_MS)
        page.wait_for_function(
            "document.querySelector('canvas[data-engine]').clientWidth > 200", timeout=PATIENCE_MS
        )
        assert page.locator("[data-dock-resizing]").count() == 0
        page.close()
    front.close()
    assert errors == []


def test_a_page_of_an_inspector_that_could_not_open_says_that_nobody_answers(browser: Browser):
    late = Late(broken=True)
    front = Front(late.load)
    with on_loopback(Server(settings_of(front), front)) as url:
        page = browser.new_page()
        page.goto(url, timeout=PATIENCE_MS)
        lost = page.locator("#c2-lost")
        expect(lost).to_be_hidden()
        late.may.set()
        expect(lost).to_be_visible(timeout=PATIENCE_MS)
        page.close()
    front.close()
    assert isinstance(front.failure, InputError)
