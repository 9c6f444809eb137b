"""From the inspector to the pages beside it and back, by its menu."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser

from app.commands.sources import opened_traces
from app.gateway.runs import RunPages
from app.pages.library import Library
from c2nav_engine.experiments.spec import Setting
from tests.helpers.judged import judged_run
from tests.helpers.layout import problems
from tests.helpers.page import PATIENCE_MS, inspector, visit

pytestmark = pytest.mark.browser

BESIDE = ["Run", "Cases", "Compare", "Agreement"]


def test_the_menu_leads_to_every_page_and_back(browser: Browser, tmp_path: Path):
    run = judged_run(tmp_path, episodes=1, cycles=2)
    library = Library(run)
    library.refresh()
    opened = opened_traces(sorted((run / "traces").glob("*.mcap")), Setting(source="builtin"))
    with (
        inspector(opened, RunPages(library)) as (url, _),
        visit(browser, url, size=(1280, 720)) as seen,
    ):
        menu = seen.page.get_by_role("navigation", name="pages")
        assert menu.get_by_role("link").all_inner_texts() == BESIDE
        assert problems(seen) == []
        seen.page.evaluate("c2nav.send('cover', {on: true})")
        menu.wait_for(state="hidden")  # those pages say how episodes ended
        seen.page.evaluate("c2nav.send('cover', {on: false})")
        for name in BESIDE:
            menu.get_by_role("link", name=name, exact=True).click()
            seen.page.wait_for_url(f"**/{name.lower()}")
            here = menu.get_by_role("link", name=name, exact=True)
            assert here.get_attribute("aria-current") == "page"
        menu.get_by_role("link", name="Inspector").click()
        seen.page.wait_for_selector("rank-strip", state="attached", timeout=PATIENCE_MS)
        assert seen.errors == []
    library.close()
