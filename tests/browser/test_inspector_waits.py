"""While a question is out: buttons that stay, counts that are true, and a way on after a cancel."""

from __future__ import annotations

import threading
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import pytest
from playwright.sync_api import Browser, Locator

from tests.helpers import stage
from tests.helpers.page import Visit, inspector, visit

pytestmark = pytest.mark.browser


@dataclass
class Waiting:
    """A page whose questions are answered once the gate opens."""

    seen: Visit
    run: stage.PlayRun
    gate: threading.Event

    def press(self, button: Locator, hold_ms: int) -> None:
        """Press a button for some time at one place, as a hand does."""
        box = button.bounding_box()
        assert box is not None
        mouse = self.seen.page.mouse
        mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        mouse.down()
        self.seen.page.wait_for_timeout(hold_ms)
        mouse.up()

    def button(self, name: str) -> Locator:
        return self.seen.page.locator("wait-card").get_by_role("button", name=name, exact=True)

    def words(self) -> str:
        return self.seen.page.locator("wait-card .card").inner_text()


@contextmanager
def waiting(browser: Browser) -> Generator[Waiting]:
    gate = threading.Event()
    opened, run = stage.opened_live(), stage.live_run(gate=gate)
    begin = opened.open
    opened = replace(opened, open=lambda choice: replace(begin(choice), run=run))
    try:
        with inspector(opened) as (url, _), visit(browser, url) as seen:
            seen.until("s.asking")
            seen.page.wait_for_selector("wait-card button")
            yield Waiting(seen, run, gate)
            assert not seen.errors
    finally:
        gate.set()


def test_a_long_press_cancels_and_the_question_can_be_asked_again(browser: Browser):
    with waiting(browser) as page:
        page.press(page.button("Cancel"), 600)
        page.seen.until("!s.asking", 5_000)
        page.seen.page.wait_for_selector("wait-card button:text-is('Ask again')")
        assert page.words().startswith("Cancelled: rank the views yourself, or ask again")
        commit = page.seen.page.locator("rank-strip").get_by_role("button", name="Commit")
        assert commit.is_disabled()
        assert commit.get_attribute("title") == "rank the views first"
        assert "waits for your ranking" in page.seen.page.locator("rank-strip .rail").inner_text()
        page.seen.page.keyboard.press("1")
        page.seen.until("s.decision.source === 'draft'")
        assert commit.is_enabled()
        page.seen.page.keyboard.press("Escape")
        page.seen.until("s.decision.source === 'waiting'")
        page.press(page.button("Ask again"), 600)
        page.seen.until("s.asking", 5_000)
        page.gate.set()
        page.seen.until("s.decision.source === 'proposal' && !s.let_go")


def test_focus_stays_on_a_button_while_the_seconds_go_on(browser: Browser):
    with waiting(browser) as page:
        page.button("Cancel").focus()
        before = page.words()
        page.seen.page.wait_for_timeout(900)
        page.seen.page.evaluate("c2nav.send('hover', {key: 'front'})")
        page.seen.until("s.view.hovered === 'front'")
        assert page.words() != before
        focus = "document.querySelector('wait-card').shadowRoot.activeElement?.textContent"
        assert page.seen.page.evaluate(focus) == "Cancel"
        page.seen.page.keyboard.press("Enter")
        page.seen.until("!s.asking", 5_000)


def test_an_offer_keeps_its_buttons_while_a_question_is_out(browser: Browser):
    with waiting(browser) as page:
        fork = "document.querySelector('wait-card').shadowRoot.querySelector('button.go')"
        page.seen.page.evaluate(
            """() => {
              const card = document.querySelector("wait-card");
              const offer = { decision: 0, decisions: 2, queries: 3, seconds: 4, dollars: 0 };
              card.state = { ...card.state, offer };
              card.draw();
            }"""
        )
        page.seen.page.evaluate(f"window.fork = {fork}")
        page.seen.page.wait_for_timeout(700)
        assert page.seen.page.evaluate(f"fork.textContent === 'Fork' && fork === {fork}")


def test_the_strip_keeps_its_nodes_while_states_come(browser: Browser):
    with waiting(browser) as page:
        root = "document.querySelector('rank-strip').shadowRoot"
        nodes = f"[...{root}.querySelectorAll('button, img')]"
        page.seen.page.evaluate(f"window.before = {nodes}")
        for key in ("front", "left", ""):
            page.seen.page.evaluate("key => c2nav.send('hover', {key})", key)
            page.seen.until(f"s.view.hovered === '{key}'")
        assert page.seen.page.evaluate(f"{nodes}.length === before.length")
        assert page.seen.page.evaluate(f"{nodes}.every((one, i) => one === before[i])")


def test_what_is_said_of_the_queries_is_what_came(browser: Browser):
    with waiting(browser) as page:
        told = page.run.told
        assert told is not None
        told(0, 3)
        page.seen.until("s.asking.queries === 3")
        page.seen.page.wait_for_timeout(1_500)
        assert "0 of 3 queries answered" in page.words()
        told(2, 3)
        page.seen.until("s.asking.answered === 2")
        page.seen.page.wait_for_timeout(300)
        assert "2 of 3 queries answered" in page.words()


def test_a_wait_beyond_the_usual_reads_sensibly(browser: Browser):
    with waiting(browser) as page:
        words = page.seen.page.evaluate(
            """() => {
              const card = document.querySelector("wait-card");
              const since_s = Date.now() / 1000 - 4.6;
              const asking = { ...card.state.asking, since_s, usual_s: 0.7 };
              return card.asking({ ...asking, queries: 2, answered: 0 }).innerText;
            }"""
        )
        assert "0 of 2 queries answered · 4.6 s, usually 0.7 s" in words
