"""Reviewing a recording in the browser: keys, the panel, a leg's end dragged on the timeline."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser

from app.reviews.audit import AuditBook
from app.reviews.events import Kind
from app.reviews.store import Store
from tests.helpers import stage
from tests.helpers.page import inspector, visit

pytestmark = pytest.mark.browser


def test_what_is_said_by_keys_and_mouse_is_stored_and_shown_again(browser: Browser, tmp_path: Path):
    file = tmp_path / "reviews.sqlite"
    source = stage.opened_recording(book=lambda _, sha: AuditBook(file, sha))
    with inspector(source) as (url, _):
        with visit(browser, url) as seen:
            page = seen.page
            page.evaluate("c2nav.send('go', {decision: 2})")
            seen.until("s.place.decision === 2")
            page.keyboard.press("w")
            cards = [card for card in seen.state()["decision"]["cards"] if card["letter"]]
            digits = {card["rank"]: "ABC".index(card["letter"]) + 1 for card in cards}
            page.keyboard.press(f"Shift+Digit{digits[1]}")
            seen.until("s.notice.text.endsWith('another one can be better')")
            page.keyboard.press(f"Shift+Digit{digits[2]}")
            seen.until("s.judgement.verdict === 'wrong' && s.judgement.better !== ''")
            page.get_by_role("tab", name="Review", exact=True).click()
            page.get_by_role("button", name="wrong object").click()
            seen.until("s.judgement.tags.length === 1")
            page.get_by_role("button", name="ends here").first.click()
            seen.until("s.timeline.leg_ends.length === 1")
            flag = page.locator("timeline-bar .flag text").bounding_box()
            assert flag is not None
            page.mouse.move(flag["x"] + 3, flag["y"] + 5)
            page.mouse.down()
            page.mouse.move(flag["x"] + 203, flag["y"] + 5, steps=4)
            page.mouse.up()
            first = seen.state()["place"]["step"]
            seen.until(f"s.timeline.leg_ends[0].step > {first}")
            page.keyboard.press("u")
            seen.until(f"s.timeline.leg_ends[0].step === {first}")
            assert seen.errors == []
        with visit(browser, url) as seen:
            seen.page.evaluate("c2nav.send('go', {decision: 2})")
            seen.until("s.judgement.verdict === 'wrong' && s.judgement.tags.length === 1")
    with Store(file) as store:
        kinds = [event.kind for event in store.events()]
    assert kinds == [Kind.WRONG, Kind.BETTER, Kind.TAG, Kind.LEG_END, Kind.LEG_END, Kind.UNDO]


def test_v_shows_a_covered_answer(browser: Browser, tmp_path: Path):
    file = tmp_path / "reviews.sqlite"
    source = stage.opened_recording(blind=True, book=lambda _, sha: AuditBook(file, sha))
    with inspector(source) as (url, _), visit(browser, url) as seen:
        seen.until("s.covered && s.decision.outcome === ''")
        assert seen.page.locator("rank-strip .rank").count() == 0
        assert seen.page.locator("#c2-banner").inner_text() == "blind · the answer is covered"
        seen.page.keyboard.press("v")
        seen.until("!s.covered && s.decision.outcome !== ''")
        seen.page.keyboard.press("n")
        seen.until("s.covered && s.place.decision === 1")
        assert seen.errors == []
    with Store(file) as store:
        assert [event.kind for event in store.events()] == [Kind.REVEAL]
