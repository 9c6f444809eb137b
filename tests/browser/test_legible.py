"""What a page says can be read: size, contrast, and nothing wider than its panel."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser

from tests.helpers import stage
from tests.helpers.page import Visit, inspector, visit

pytestmark = pytest.mark.browser

LEGIBLE = (Path(__file__).parents[1] / "helpers" / "legible.js").read_text(encoding="utf-8")
OVER = """() => [...document.querySelectorAll('[data-dock-region] *')]
  .filter(node => node.scrollWidth > node.clientWidth + 1 && node.clientWidth > 0)
  .filter(node => /auto|scroll/.test(getComputedStyle(node).overflowX))
  .filter(node => !node.closest('.c2-wide') && !/INPUT|TEXTAREA/.test(node.tagName))
  .map(node => `${node.tagName}.${node.className} ${node.scrollWidth} > ${node.clientWidth}`)"""

LEFT = ("Look-back", "Sketch", "Ladder", "Turning", "Decision")
RIGHT = ("Branches", "Review", "Export", "Run")


def faults(seen: Visit) -> tuple[list[str], list[str]]:
    seen.page.wait_for_timeout(300)
    found = seen.page.evaluate(LEGIBLE)
    assert found["read"] > 20
    return found["faults"], seen.page.evaluate(OVER)


@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_all_text_is_large_enough_and_stands_out(browser: Browser, dark: bool):
    with (
        inspector(stage.opened_recording()) as (url, _),
        visit(browser, f"{url}?decision=3", size=(1280, 720), dark=dark) as seen,
    ):
        said = {}
        for tab in (*LEFT, *RIGHT):
            seen.page.get_by_role("tab", name=tab, exact=True).click()
            said[tab] = faults(seen)
        seen.page.get_by_text("Map", exact=True).first.click()
        said["Map"] = faults(seen)
        assert said == dict.fromkeys(said, ([], []))
