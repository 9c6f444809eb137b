"""Two people judge at once in two browsers, by keyboard alone; one tab is killed midway."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

import pytest
import uvicorn
from playwright.sync_api import Browser, Page

from app.gateway.judging import desks_of, judging_application
from app.reviews.state import standing
from app.reviews.store import store_of
from app.reviews.study import Person, Study
from tests.helpers.judged import judged_run, study_with

pytestmark = pytest.mark.browser

SHOWN = "n => document.body.dataset.shown === String(n)"


@contextmanager
def served(run: Path) -> Generator[str]:
    listener = socket.create_server(("127.0.0.1", 0))
    app = judging_application(desks_of([run]))
    server = uvicorn.Server(uvicorn.Config(app, ws="none", log_level="warning"))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, daemon=True)
    thread.start()
    while not server.started:
        time.sleep(0.02)
    try:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}/judge?token="
    finally:
        server.should_exit = True
        thread.join(timeout=10.0)


@pytest.fixture
def study(tmp_path: Path) -> tuple[Study, list[tuple[Person, str]]]:
    run = judged_run(tmp_path, episodes=10, cycles=3)
    return study_with(run, "ann", "bob", per_slot=5)


def judge_on(page: Page, start: int, end: int, *, keys: str = "12") -> None:
    """Answer the places from `start` up to `end` by keyboard."""
    for number in range(start, end):
        page.wait_for_function(SHOWN, arg=number)
        for key in keys:
            page.keyboard.press(key)
        page.keyboard.press("Enter")


def test_two_browsers_judge_at_once_and_nothing_is_lost(
    browser: Browser, study: tuple[Study, list[tuple[Person, str]]]
):
    frozen, ((ann, hers), (_, his)) = study
    total = len(frozen.queue(ann.queue))
    problems: list[str] = []
    with served(frozen.run) as url:
        pages = [browser.new_context().new_page() for _ in range(2)]
        for page, token in zip(pages, (hers, his), strict=True):
            page.on("pageerror", lambda error: problems.append(str(error)))
            page.on("console", lambda m: problems.append(m.text) if m.type == "error" else None)
            page.goto(url + token)
        for number in range(8):
            for page in pages:
                judge_on(page, number, number + 1)
        pages[1].wait_for_function(SHOWN, arg=8)
        pages[1].context.close()
        judge_on(pages[0], 8, total)
        pages[0].wait_for_function(SHOWN, arg="done")
        resumed = browser.new_context().new_page()
        resumed.goto(url + his)
        judge_on(resumed, 8, total)
        resumed.wait_for_function(SHOWN, arg="done")
    assert problems == []
    with store_of(frozen.run) as store:
        answers = standing(store.events())
    given = sorted((event.author, int(event.extra["place"])) for event in answers)
    assert given == [(name, place) for name in ("ann", "bob") for place in range(total)]
    assert all(int(event.extra["response_ms"]) > 0 for event in answers)


def test_ties_none_and_undo_by_keyboard(
    browser: Browser, study: tuple[Study, list[tuple[Person, str]]]
):
    frozen, ((_, token), _) = study
    with served(frozen.run) as url:
        page = browser.new_context().new_page()
        page.goto(url + token)
        page.wait_for_function(SHOWN, arg=0)
        for key in ("b", "=", "a"):
            page.keyboard.press(key)
        assert page.inner_text("#ranking") == "B = A"
        page.keyboard.press("Enter")
        page.wait_for_function(SHOWN, arg=1)
        page.keyboard.press("x")
        assert page.inner_text("#ranking") == "none"
        page.keyboard.press("Enter")
        page.wait_for_function(SHOWN, arg=2)
        page.keyboard.press("u")
        page.wait_for_function(SHOWN, arg=1)
        assert page.inner_text("#ranking") == ""
        picture = page.locator("main img").first
        if picture.count():
            assert picture.evaluate("e => getComputedStyle(e).imageRendering") == "pixelated"
            width = picture.evaluate("e => e.getBoundingClientRect().width / e.naturalWidth")
            assert width == round(width)
        page.context.close()
    with store_of(frozen.run) as store:
        first, none, undo = store.events()
    assert type(first.said).__name__ == "Tie"
    assert type(none.said).__name__ == "Abstention"
    assert undo.target == none.id
