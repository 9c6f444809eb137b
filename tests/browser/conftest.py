"""A browser for each file of tests, and a running inspector for each test of the page."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser

from app.session.worker import Session
from tests.helpers import stage
from tests.helpers.page import Visit, chromium, inspector, visit


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    # Playwright keeps this thread's event loop for as long as it lasts: tests of other files that
    # run one of their own may follow in the same process.
    with chromium() as browser:
        yield browser


@pytest.fixture
def live(browser: Browser) -> Iterator[tuple[Visit, Session]]:
    with inspector(stage.opened_live()) as (url, session), visit(browser, url) as seen:
        yield seen, session


@pytest.fixture
def recorded(browser: Browser) -> Iterator[tuple[Visit, Session]]:
    with inspector(stage.opened_recording()) as (url, session), visit(browser, url) as seen:
        yield seen, session
