"""Keys act where they are meant to: never behind the palette or a modal."""

from __future__ import annotations

import pytest

from app.session.worker import Session
from tests.helpers.page import Visit

pytestmark = pytest.mark.browser

Opened = tuple[Visit, Session]


def said(seen: Visit) -> object:
    """What a key might have changed."""
    seen.page.wait_for_timeout(400)
    state = seen.state()
    return state["judgement"], state["draft"], state["place"], state["view"], state["notice"]


@pytest.mark.parametrize("delay_ms", [0, 30, 80])
def test_what_is_typed_after_ctrl_k_reaches_the_palette_whole(recorded: Opened, delay_ms: int):
    seen, _ = recorded
    seen.page.wait_for_timeout(1_000)
    before = said(seen)
    seen.page.keyboard.press("Control+k")
    seen.page.keyboard.type("camera", delay=delay_ms)
    field = seen.page.get_by_placeholder("Search commands...")
    field.wait_for(timeout=10_000)
    seen.page.wait_for_function("document.activeElement?.value === 'camera'", timeout=10_000)
    # The list follows what was typed.
    seen.page.get_by_text("Camera: top-down").wait_for(timeout=10_000)
    assert seen.page.get_by_text("Next decision").count() == 0
    assert said(seen) == before
    seen.page.keyboard.press("Escape")
    field.wait_for(state="detached", timeout=10_000)
    seen.page.keyboard.press("w")
    seen.until("s.judgement.verdict === 'wrong'", 5_000)


@pytest.mark.parametrize("closing", ["Escape", "?"])
def test_no_key_acts_behind_the_sheet_and_it_closes_by_key(recorded: Opened, closing: str):
    seen, _ = recorded
    before = said(seen)
    sheet = seen.page.locator("#c2-sheet")
    seen.page.keyboard.press("?")
    sheet.wait_for(state="visible")
    for key in ("w", "1", "n", "g", "f"):
        seen.page.keyboard.press(key)
    assert said(seen) == before
    seen.page.keyboard.press(closing)
    sheet.wait_for(state="hidden", timeout=5_000)
    seen.page.keyboard.press("w")
    seen.until("s.judgement.verdict === 'wrong'", 5_000)


def test_ctrl_k_on_the_sheet_opens_the_palette_in_its_place(recorded: Opened):
    seen, _ = recorded
    seen.page.keyboard.press("?")
    seen.page.locator("#c2-sheet").wait_for(state="visible")
    seen.page.keyboard.press("Control+k")
    seen.page.keyboard.type("camera")
    seen.page.wait_for_function("document.activeElement?.value === 'camera'", timeout=10_000)
    assert seen.page.locator("#c2-sheet").is_hidden()
