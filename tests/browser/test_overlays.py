"""What stands over the map covers no control, and says what is there."""

from __future__ import annotations

from dataclasses import replace

import pytest
from playwright.sync_api import Browser

from app.session.opened import Opened, Opening
from tests.helpers import stage
from tests.helpers.page import inspector, visit

pytestmark = pytest.mark.browser

SMALL = (1280, 720)
COVERS = """() => {
  const box = (node) => node.getBoundingClientRect();
  const notes = [...document.querySelectorAll('.c2-toast, #c2-lost')].map(box);
  const controls = document.querySelectorAll(
    '[data-dock-region], [data-floating-window], #c2-low, #c2-top > *');
  return [...controls].filter((node) => notes.some((note) => {
    const own = box(node);
    return own.width > 0 && own.left < note.right && note.left < own.right
      && own.top < note.bottom && note.top < own.bottom;
  })).map((node) => node.outerHTML.slice(0, 80));
}"""


@pytest.mark.parametrize("size", [SMALL, (1920, 1080)])
def test_a_notice_covers_no_control(browser: Browser, size: tuple[int, int]):
    with inspector(stage.opened_recording()) as (url, _), visit(browser, url, size=size) as seen:
        seen.page.wait_for_timeout(800)
        seen.page.evaluate("document.getElementById('c2-lost').hidden = false")
        assert seen.page.evaluate(COVERS) == []
        seen.page.evaluate("document.getElementById('c2-lost').hidden = true")
        text = (
            "expected a scene to drive the robot through again, came none; open with --scenes DIR"
        )
        seen.page.evaluate(
            "text => dispatchEvent(new CustomEvent('c2-toast', {detail: {text, fault: true}}))",
            text,
        )
        assert text in seen.page.locator(".c2-toast").inner_text()
        assert seen.page.evaluate(COVERS) == []


def without_scene() -> Opened:
    """A recording whose scene is not to be had."""
    opened = stage.opened_recording()
    return replace(opened, open=lambda choice: _bare(opened.open(choice)))


def _bare(opening: Opening) -> Opening:
    return replace(opening, no_scene="no scene of this name; open with --scenes DIR")


def test_without_the_scene_one_line_says_so_and_ego_promises_no_picture(browser: Browser):
    with inspector(without_scene()) as (url, _), visit(browser, url, size=SMALL) as seen:
        seen.until("s.no_scene")
        pills = seen.page.locator("#c2-pills > div:visible")
        boxes = [pill.bounding_box() for pill in pills.all()]
        assert len(boxes) == 2
        assert len({box["y"] for box in boxes if box}) == 1
        seen.page.evaluate("c2nav.send('camera', {mode: 'ego'})")
        seen.until("s.view.camera === 'ego'")
        said = seen.page.locator("#c2-pills").inner_text()
        assert "no mesh to look at; the cards show what the robot saw" in said
        assert "rendered here" not in said
        assert "no scene" not in said


def test_furniture_never_hides_the_body(browser: Browser):
    with inspector(stage.opened_recording()) as (url, _), visit(browser, url, size=SMALL) as seen:
        seen.until_node("/body")
        seen.page.wait_for_function(
            """() => {
              let over = false;
              window.__viserMutable?.nodeRefFromName['/body']?.traverse((part) => {
                if (part.isMesh) over = !part.material.depthTest && part.renderOrder > 0;
              });
              return over;
            }""",
            timeout=15_000,
        )
        assert seen.errors == []
