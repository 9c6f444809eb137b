from __future__ import annotations

import threading
from dataclasses import replace

import pytest
from playwright.sync_api import Browser

from app.session.opened import Opened, Opening
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
        assert min(width, height) >= 160
        assert abs(width / height - natural_width / natural_height) < 0.02  # never cropped
    assert "vetoed" in seen.card("right").inner_text()
    seen.card("right").click()
    assert seen.state()["draft"]["tiers"] == []


PICTURES = """[...document.querySelector('rank-strip').shadowRoot.querySelectorAll('img.picture')]
  .map((node) => node.getBoundingClientRect())
  .map((box) => [box.x, box.y, box.width, box.height])
  .map((box) => box.map((length) => Math.round(10 * length) / 10))"""


@pytest.mark.parametrize("size", [(1280, 720), (1920, 1080)])
def test_pictures_keep_their_size_and_place_whatever_their_rank(
    browser: Browser, size: tuple[int, int]
):
    with inspector(stage.opened_live()) as (url, _), visit(browser, url, size=size) as seen:
        seen.until(proposal(0))
        before = seen.page.evaluate(PICTURES)
        assert len({(width, height) for _, _, width, height in before}) == 1
        assert min(min(box[2:]) for box in before) >= 160
        for key in ("2", "1"):
            seen.page.keyboard.press(key)
        seen.until("s.draft.tiers.length === 2")
        weights = seen.page.evaluate(
            "[...document.querySelector('rank-strip').shadowRoot.querySelectorAll('.card')]"
            ".map(node => getComputedStyle(node).boxShadow)"
        )
        assert len(set(weights)) == 3
        moved = [[x, y - before[0][1], *rest] for x, y, *rest in seen.page.evaluate(PICTURES)]
        assert moved == [[x, y - before[0][1], *rest] for x, y, *rest in before]


ENLARGED = """() => {
  const big = document.querySelector('enlarged-views').shadowRoot;
  const boxes = [...big.querySelectorAll('img')].map((node) => {
    const { left, top, right, bottom, width } = node.getBoundingClientRect();
    return { left, top, right, bottom, times: width / node.naturalWidth };
  });
  return { boxes, said: big.querySelector('.times')?.textContent };
}"""


@pytest.mark.parametrize(("size", "times"), [((1280, 720), "1.8×"), ((1920, 1080), "2×")])
def test_z_shows_all_alternatives_beside_each_other(
    browser: Browser, size: tuple[int, int], times: str
):
    with inspector(stage.opened_live()) as (url, _), visit(browser, url, size=size) as seen:
        seen.until(proposal(0))
        seen.page.keyboard.down("z")
        seen.page.wait_for_function(
            "() => [...document.querySelectorAll('enlarged-views')]"
            ".some(one => [...one.shadowRoot.querySelectorAll('img')].every(i => i.naturalWidth))"
        )
        shown = seen.page.evaluate(ENLARGED)
        assert len(shown["boxes"]) == 3
        assert len({box["top"] for box in shown["boxes"]}) == 1
        for box in shown["boxes"]:
            assert box["left"] >= 0
            assert box["top"] >= 0
            assert box["right"] <= size[0]
            assert box["bottom"] <= size[1]
            assert box["times"] == pytest.approx(float(times[:-1]), abs=0.01)
        assert shown["said"] == times
        seen.page.keyboard.press("1")
        seen.until("s.draft.tiers.length === 1")
        assert "1st" in seen.page.locator("enlarged-views .rank").all_inner_texts()
        seen.page.keyboard.up("z")
        assert not seen.page.locator("enlarged-views").is_visible()


def test_z_sets_a_dozen_views_in_a_grid_that_needs_no_scrolling(live: Live):
    seen, _ = live
    seen.until(proposal(0))
    seen.page.keyboard.down("z")
    seen.page.evaluate(
        """() => {
          const big = document.querySelector('enlarged-views');
          const [card] = big.state.decision.cards;
          const cards = Array.from({ length: 12 }, (_, n) => ({ ...card, key: `${n}` }));
          big.state = { ...big.state, decision: { ...big.state.decision, cards } };
          big.draw();
        }"""
    )
    shown = seen.page.evaluate(ENLARGED)
    assert len(shown["boxes"]) == 12
    assert len({box["top"] for box in shown["boxes"]}) > 1
    room = "(() => { const n = document.querySelector('enlarged-views'); "
    assert seen.page.evaluate(room + "return n.scrollHeight - n.clientHeight })()") <= 0


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


SCHEME = "document.documentElement.dataset.mantineColorScheme"
PAPER = "getComputedStyle(document.body).backgroundColor"


def test_dark_follows_the_system(browser: Browser):
    with inspector(stage.opened_live()) as (url, _), visit(browser, url, dark=True) as seen:
        assert seen.page.evaluate(SCHEME) == "dark"
        dark = seen.page.evaluate(PAPER)
        seen.page.emulate_media(color_scheme="light")
        seen.page.wait_for_function(f"{SCHEME} === 'light'", timeout=5_000)
        assert seen.page.evaluate(PAPER) != dark
        assert "darkMode" not in seen.page.url
        seen.page.emulate_media(color_scheme="dark")
        seen.page.wait_for_function(f"{SCHEME} === 'dark'", timeout=5_000)
        assert seen.page.evaluate(PAPER) == dark


def test_a_theme_that_was_asked_for_stays(browser: Browser):
    with inspector(stage.opened_live()) as (url, _), visit(browser, f"{url}?theme=light") as seen:
        seen.page.emulate_media(color_scheme="dark")
        seen.page.wait_for_timeout(300)
        assert seen.page.evaluate(SCHEME) == "light"


def test_the_page_says_what_it_waits_for_and_stays_alive(browser: Browser):
    gate = threading.Event()
    with (
        inspector(stage.opened_live(gate=gate)) as (url, _),
        visit(browser, url) as seen,
    ):
        seen.until("s.asking")
        seen.page.wait_for_selector("wait-card .card", timeout=10_000)
        assert "ranks decision 0" in seen.page.locator("wait-card .card").inner_text()
        seen.page.evaluate("c2nav.send('layer', {name: 'goal', on: true})")
        seen.until("s.asking && s.view.layers.includes('goal')")
        seen.until_node("/goal/disc")
        gate.set()
        seen.until(proposal(0))


def many_legs() -> Opened:
    """A recording whose first two legs, which are walked, stand far down in a long instruction."""
    run = stage.finished_run()
    walked = tuple(
        f"{leg} {'and on through the next room ' * 3}".strip() for leg in run.header.legs
    )
    text = f"{'It is quiet here. ' * 60} {', '.join(walked)}. {'It is quiet there. ' * 40}"
    episode = replace(run.header.episode, instruction=text)
    header = replace(run.header, episode=episode, legs=walked)
    return replace(
        stage.opened_recording(),
        open=lambda _: Opening(header, run.exchanges, run.footer, source="play.mcap"),
    )


STRIP = """() => {
  const strip = document.querySelector('route-strip');
  const box = (node) => node.getBoundingClientRect();
  const [now, all] = [box(strip.shadowRoot.querySelector('.now')), box(strip)];
  const signs = [...strip.shadowRoot.querySelectorAll('.more')];
  const shown = signs.map((node) => getComputedStyle(node).opacity);
  return { above: now.top - all.top, below: all.bottom - now.bottom, shown };
}"""


@pytest.mark.parametrize("size", [(1280, 720), (1100, 700), (1024, 576)])
def test_the_active_leg_is_in_view_and_more_text_is_announced(
    browser: Browser, size: tuple[int, int]
):
    with inspector(many_legs()) as (url, _), visit(browser, url, size=size) as seen:
        for leg, start in enumerate(seen.state()["timeline"]["legs"]):
            seen.page.evaluate(f"c2nav.send('go', {{step: {start['step'] + 1}}})")
            seen.until(f"s.episode.leg === {leg}")
            seen.page.wait_for_timeout(300)
            strip = seen.page.evaluate(STRIP)
            assert strip["above"] >= 0
            assert size == (1024, 576) or strip["below"] >= 0  # there it is too long to fit
            assert strip["shown"] == ["1", "1"]


def test_who_reads_another_leg_is_left_alone(browser: Browser):
    with inspector(many_legs()) as (url, _), visit(browser, url, size=(1280, 720)) as seen:
        seen.page.wait_for_timeout(500)
        text = seen.page.locator("route-strip .text")
        text.evaluate("node => { node.scrollTop = 0; }")
        seen.page.evaluate("c2nav.send('go', {decision: 1})")
        seen.until("s.place.decision === 1 && s.episode.leg === 0")
        seen.page.wait_for_timeout(300)
        assert text.evaluate("node => node.scrollTop") == 0
