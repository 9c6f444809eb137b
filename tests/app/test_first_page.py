from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace

import pytest
from fastapi import FastAPI
from starlette.testclient import TestClient

from app.gateway.api import api
from app.gateway.feed import Feed
from app.session.first_page import FirstPage
from app.session.worker import Session
from c2nav_engine.errors import SceneError
from c2nav_engine.world.surface import Surface
from tests.helpers import stage

NEVER_S = 60.0
AT_ONCE_S = 0.01


def begun(wait: Callable[[], None]) -> threading.Event:
    """Set once that wait is over."""
    event = threading.Event()

    def work() -> None:
        wait()
        event.set()

    threading.Thread(target=work, daemon=True).start()
    return event


def test_by_default_nothing_waits():
    FirstPage().wait()


def test_heavy_work_waits_until_a_page_stands():
    first = FirstPage(asked_within_s=NEVER_S, stands_within_s=NEVER_S)
    work = begun(first.wait)
    assert not work.wait(AT_ONCE_S)
    first.asked()
    assert not work.wait(AT_ONCE_S)
    first.stands()
    assert work.wait(NEVER_S)
    first.wait()  # and from then on nothing waits


def test_suspects_wait_for_the_scene_too_but_not_without_end():
    first = FirstPage(sent_within_s=NEVER_S)
    waiting = begun(first.wait_for_scene)
    assert not waiting.wait(AT_ONCE_S)
    first.sent()
    assert waiting.wait(NEVER_S)
    FirstPage(sent_within_s=AT_ONCE_S).wait_for_scene()


def test_suspects_wait_until_a_page_that_was_asked_for_shows_the_scene():
    first = FirstPage(sent_within_s=NEVER_S, shown_within_s=NEVER_S)
    first.asked()
    first.sent()
    waiting = begun(first.wait_for_scene)
    assert not waiting.wait(AT_ONCE_S)
    first.shown()
    assert waiting.wait(NEVER_S)
    hurried = FirstPage(sent_within_s=NEVER_S, shown_within_s=AT_ONCE_S)
    hurried.asked()
    hurried.sent()
    hurried.wait_for_scene()


@pytest.mark.parametrize(
    "come", [lambda _: None, FirstPage.asked], ids=["nobody comes", "a page that never stands"]
)
def test_nobody_is_waited_for_without_end(come: Callable[[FirstPage], None]):
    first = FirstPage(asked_within_s=AT_ONCE_S, stands_within_s=AT_ONCE_S)
    come(first)
    assert begun(first.wait).wait(NEVER_S)


def test_suspects_are_looked_for_after_the_page_that_says_it_stands():
    loaded = threading.Event()

    def load() -> Surface:
        loaded.set()
        raise SceneError("expected a floor, came none")

    first = FirstPage(asked_within_s=NEVER_S, stands_within_s=NEVER_S)
    recording = stage.opened_recording(cycles=2)
    opened = replace(recording, open=lambda c: replace(recording.open(c), surface=load))
    session = Session(opened, first_page=first)
    session.start()
    app = FastAPI()
    app.include_router(api(session, Feed(session)))
    assert not loaded.wait(AT_ONCE_S)
    assert TestClient(app).post("/api/standing").status_code == 204
    assert loaded.wait(NEVER_S)
    session.close()


def test_what_waits_for_a_page_is_let_go_and_not_done_when_the_session_ends():
    loaded = threading.Event()

    def load() -> Surface:
        loaded.set()
        raise SceneError("expected a floor, came none")

    class Noting(FirstPage):
        waiting = threading.Event()

        def wait_for_scene(self) -> None:
            self.waiting.set()
            super().wait_for_scene()

    first = Noting(asked_within_s=NEVER_S, stands_within_s=NEVER_S)
    recording = stage.opened_recording(cycles=2)
    opened = replace(recording, open=lambda c: replace(recording.open(c), surface=load))
    session = Session(opened, first_page=first)
    before = set(threading.enumerate())
    session.start()
    assert first.waiting.wait(NEVER_S)
    session.close()
    for thread in set(threading.enumerate()) - before:
        thread.join(NEVER_S)
    assert not loaded.is_set()


def test_a_page_says_that_it_shows_the_scene():
    first = FirstPage(sent_within_s=NEVER_S, shown_within_s=NEVER_S)
    session = Session(stage.opened_recording(cycles=1), first_page=first)
    app = FastAPI()
    app.include_router(api(session, Feed(session)))
    first.asked()
    first.sent()
    waiting = begun(first.wait_for_scene)
    assert TestClient(app).post("/api/standing/scene").status_code == 204
    assert waiting.wait(NEVER_S)
    session.close()
