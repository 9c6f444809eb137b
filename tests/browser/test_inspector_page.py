from __future__ import annotations

import threading

import pytest
from playwright.sync_api import Browser

from app.session.worker import Session
from c2nav_engine.contract.outcome import Ordering
from tests.helpers import stage
from tests.helpers.page import Visit, inspector, visit

pytestmark = pytest.mark.browser

Live = tuple[Visit, Session]


def proposal(number: int) -> str:
    return f"s.decision?.number === {number} && s.decision.source === 'proposal'"


def test_three_steps_an_override_by_dragging_and_one_port(live: Live):
    seen, session = live
    seen.until(proposal(0))
    seen.until_node("/fan/left")
    assert {"/fan/front", "/fan/right", "/body"} <= seen.nodes()
    for number in (1, 2, 3):
        seen.page.get_by_role("button", name="Step", exact=True).click()
        seen.until(proposal(number))
    seen.drag("left", before="front")
    seen.until("s.decision.source === 'draft' && s.decision.cards[0].rank === 1")
    seen.page.keyboard.press("Enter")
    seen.until(proposal(4))
    made = session.snapshot.story.decisions[3]
    assert made.override is not None
    assert isinstance(made.override.outcome, Ordering)
    assert made.override.outcome.winner == "left"
    assert made.ranked is not None
    assert made.ranked.outcome != made.override.outcome
    assert not seen.errors
    assert len(seen.hosts) == 1


def test_the_strip_shows_what_was_sent_and_greys_what_was_vetoed(live: Live):
    seen, _ = live
    seen.until(proposal(0))
    sizes = seen.page.evaluate(
        "[...document.querySelector('rank-strip').shadowRoot.querySelectorAll('img.picture')]"
        ".map(i => [i.naturalWidth, i.naturalHeight, i.clientWidth, i.clientHeight])"
    )
    assert len(sizes) == 3
    for natural_width, natural_height, width, height in sizes:
        assert natural_width >= 160
        assert min(width, height) >= 150  # 160 px with the winner's border
        assert abs(width / height - natural_width / natural_height) < 0.02  # never cropped
    assert "vetoed" in seen.card("right").inner_text()
    seen.card("right").click()
    assert seen.state()["draft"]["tiers"] == []


def test_digits_rank_in_the_order_pressed(live: Live):
    seen, _ = live
    seen.until(proposal(0))
    first = next(c["key"] for c in seen.state()["decision"]["cards"] if c["letter"] == "A")
    second = next(c["key"] for c in seen.state()["decision"]["cards"] if c["letter"] == "B")
    for key in ("2", "1"):
        seen.page.keyboard.press(key)
    seen.until("s.draft.tiers.length === 2")
    assert seen.state()["draft"]["tiers"] == [[second], [first]]
    seen.page.keyboard.press("Backspace")
    seen.until("s.draft.tiers.length === 1")
    seen.page.keyboard.press("x")
    seen.until("s.draft.none")
    seen.page.keyboard.press("Escape")
    seen.until("!s.draft.none && s.draft.tiers.length === 0")


def test_a_past_override_forks_and_the_banner_says_so(recorded: Live):
    seen, _ = recorded
    seen.page.evaluate("c2nav.send('go', {decision: 3})")
    seen.until("s.place.decision === 3")
    seen.drag("left", before="front")
    seen.until("s.decision.source === 'draft'")
    seen.page.keyboard.press("Enter")
    seen.until("s.offer")
    assert "Forks here: about 14 decisions" in seen.page.locator("wait-card .card").inner_text()
    seen.page.keyboard.press("Enter")
    seen.until("s.branch.differs && s.decision.source === 'proposal'")
    banner = seen.page.locator("#c2-banner")
    assert banner.inner_text().startswith("override at decision 3")
    assert banner.evaluate("node => getComputedStyle(node).borderStyle") == "dashed"


def test_a_second_tab_shows_the_same_and_a_reload_loses_nothing(browser: Browser):
    with (
        inspector(stage.opened_recording()) as (url, _),
        visit(browser, url) as one,
        visit(browser, url) as two,
    ):
        one.page.evaluate("c2nav.send('go', {decision: 5})")
        two.until("s.place.decision === 5 && s.pages === 2")
        one.page.reload()
        one.until("s.place.decision === 5")
        assert "2 pages open" in two.page.locator("#c2-tabs").inner_text()
        assert not one.errors + two.errors


def test_the_address_restores_the_view(browser: Browser):
    with inspector(stage.opened_recording()) as (url, _):
        with visit(browser, f"{url}?decision=7") as seen:
            seen.until("s.place.decision === 7")
        with visit(browser, f"{url}?step=11&camera=top") as seen:
            seen.until("s.place.step === 11 && s.view.camera === 'top'")
            seen.page.evaluate("c2nav.send('layer', {name: 'goal', on: true})")
            seen.page.wait_for_url("**layers=**")
            kept = seen.page.url
            seen.page.evaluate("c2nav.send('layer', {name: 'goal', on: false})")
            seen.until("!s.view.layers.includes('goal')")
        with visit(browser, kept) as seen:
            seen.until("s.view.layers.includes('goal') && s.view.layers.includes('fan')")


def test_timeline_marks_are_large_enough_to_hit_and_go_there(recorded: Live):
    seen, _ = recorded
    boxes = seen.page.evaluate(
        "[...document.querySelector('timeline-bar').shadowRoot.querySelectorAll('.mark rect')]"
        ".map(r => [r.getBoundingClientRect().width, r.getBoundingClientRect().height])"
    )
    assert boxes
    assert all(width >= 12 and height >= 24 for width, height in boxes)
    marks = seen.page.locator("timeline-bar .mark")
    marks.nth(2).dispatch_event("pointerdown")
    seen.until("s.place.decision === 2")


@pytest.mark.parametrize("size", [(1280, 720), (1920, 1080)])
def test_nothing_overflows(browser: Browser, size: tuple[int, int]):
    with inspector(stage.opened_live()) as (url, _), visit(browser, url, size=size) as seen:
        seen.until(proposal(0))
        seen.page.wait_for_timeout(500)
        over = seen.page.evaluate(
            """() => [...document.querySelectorAll(
                'route-strip, timeline-bar, rank-strip, .c2-pane')]
              .filter(node => node.scrollWidth > node.clientWidth + 1 && node.clientWidth > 0)
              .map(node => `${node.tagName} ${node.scrollWidth} > ${node.clientWidth}`)"""
        )
        assert over == []
        bar = seen.page.locator("timeline-bar").bounding_box()
        assert bar is not None
        assert (bar["x"], bar["width"], bar["height"]) == (0, size[0], 112)


def test_dark_follows_the_system(browser: Browser):
    with inspector(stage.opened_live()) as (url, _), visit(browser, url, dark=True) as seen:
        scheme = seen.page.evaluate("document.documentElement.dataset.mantineColorScheme")
        assert scheme == "dark"


def test_the_page_says_what_it_waits_for_and_stays_alive(browser: Browser):
    gate = threading.Event()
    with (
        inspector(stage.opened_live(gate=gate)) as (url, _),
        visit(browser, url) as seen,
    ):
        seen.until("s.asking")
        seen.page.wait_for_selector("wait-card .card", timeout=10_000)
        assert "query 1 of" in seen.page.locator("wait-card .card").inner_text()
        seen.page.evaluate("c2nav.send('layer', {name: 'goal', on: true})")
        seen.until("s.asking && s.view.layers.includes('goal')")
        seen.until_node("/goal/disc")
        gate.set()
        seen.until(proposal(0))


TIMELINE = "document.querySelector('timeline-bar')"
DRAWN = f"""[...{TIMELINE}.shadowRoot.querySelectorAll('svg *')].map((node) => [
  node.tagName, [...node.classList].sort().join(' '), node.textContent,
  ...['x', 'y', 'x1', 'text-anchor', 'd'].map((name) => node.getAttribute(name)),
].join('|'))"""


def test_a_timeline_that_follows_looks_like_one_that_is_drawn_anew(recorded: Live):
    seen, _ = recorded
    for decision in (9, 3, 6):
        seen.page.evaluate(f"c2nav.send('go', {{decision: {decision}}})")
        words = f"{TIMELINE}.shadowRoot.querySelector('.heretext').textContent"
        seen.page.wait_for_function(f"{words}.endsWith('decision {decision}')")
        followed = seen.page.evaluate(DRAWN)
        seen.page.evaluate(f"{TIMELINE}.draw({TIMELINE}.timeline)")
        assert followed == seen.page.evaluate(DRAWN)
        assert len(seen.page.locator("timeline-bar .mark.now").all()) == 1


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_the_label_of_the_place_in_view_does_not_lie_on_the_curve(recorded: Live, share: float):
    seen, _ = recorded
    between = seen.page.evaluate(
        """share => {
          const bar = document.querySelector("timeline-bar");
          const most = Math.max(...bar.timeline.curve.map(([, distance]) => distance));
          const curve = bar.timeline.curve.map(([step]) => [step, share * most]);
          curve.push([bar.timeline.last + 1, most]);
          bar.draw({ ...bar.timeline, curve, ghost: null, legs: [] });
          const text = bar.shadowRoot.querySelector(".heretext").getBBox();
          const line = bar.y(share * most);
          return Math.max(line - text.y - text.height, text.y - line);
        }""",
        share,
    )
    assert between >= 0.0


SCRUB = """
async () => {
  const bar = document.querySelector("timeline-bar"), box = bar.getBoundingClientRect();
  const marks = c2nav.state.timeline.marks, target = marks[marks.length - 3];
  const fire = (node, type, step) => node.dispatchEvent(new PointerEvent(type, {
    bubbles: true, clientX: box.left + bar.x(step), clientY: box.top + 60, button: 0,
  }));
  fire(bar.shadowRoot.querySelector("svg"), "pointerdown", 0);
  for (let step = 1; step <= target.step; step++) fire(window, "pointermove", step);
  fire(window, "pointerup", target.step);
  return target;
}
"""


def test_a_scrub_ends_where_the_pointer_was_let_go_with_all_its_pictures(recorded: Live):
    seen, session = recorded
    target = seen.page.evaluate(SCRUB)
    seen.until(f"s.place.step === {target['step']}")
    assert session.snapshot.here.step == target["step"]
    seen.page.wait_for_function(
        """words => {
          const root = document.querySelector('rank-strip').shadowRoot;
          return root.querySelector('.chip').textContent.startsWith(words)
            && [...root.querySelectorAll('img')].every(one => one.complete && one.naturalWidth > 0);
        }""",
        arg=f"decision {target['decision']} ",
    )
    seen.page.reload()
    seen.until(f"s.place.step === {target['step']} && s.decision.number === {target['decision']}")
