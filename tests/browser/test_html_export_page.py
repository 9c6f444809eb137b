"""The exported page in a real browser: from disk, with every network door shut."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Page

from app.exports.family import family_of
from app.exports.html import HtmlOptions, Setting, export_html
from app.figures.plan import Plan
from app.inspector.still.page import still_page
from c2nav_engine.runner.opening import OpenSpec
from c2nav_engine.runner.record import EpisodeOutcome, Footer
from c2nav_engine.runner.recorded import Trace, read_trace
from c2nav_engine.world.scene import Material, Piece, Scene, scene_of
from tests.helpers.benches import workbench
from tests.helpers.exchanges import write_fake
from tests.helpers.page import PATIENCE_MS
from tests.helpers.plays import fork, recording, story

pytestmark = pytest.mark.browser

ROOM = Plan(floor=(((-8.0, -2.0), (6.0, -2.0), (6.0, 2.0), (-8.0, 2.0)),))
MOST_BYTES = 15_000_000


def room() -> Scene:
    """A floor under the play, and one wall."""

    def square(name: str, corners: Sequence[Sequence[float]], colour: Sequence[float]) -> Piece:
        red, green, blue = colour
        triangles = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
        vertices = np.array(corners, np.float32)
        return Piece(name, Material(name, (red, green, blue, 1.0)), vertices, triangles)

    floor = [[-8, 0, -3], [7, 0, -3], [7, 0, 3], [-8, 0, 3]]
    wall = [[-8, 0, -3], [7, 0, -3], [7, 2.6, -3], [-8, 2.6, -3]]
    pieces = [square("floor", floor, (0.6, 0.5, 0.4)), square("wall", wall, (0.8, 0.8, 0.8))]
    return scene_of("room", pieces)


@dataclass
class Reading:
    """A page that somebody opened from disk."""

    page: Page
    errors: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def stand(self, stop: int) -> None:
        self.page.evaluate("stop => c2nav.stand(stop)", stop)

    def place(self) -> dict[str, Any]:
        return self.page.evaluate("c2nav.state.place")

    def tab(self, name: str) -> None:
        self.page.get_by_role("tab", name=name, exact=True).click()


@contextmanager
def reading(browser: Browser, path: Path, *, dark: bool = False) -> Generator[Reading]:
    context = browser.new_context(
        offline=True,
        viewport={"width": 1440, "height": 900},
        color_scheme="dark" if dark else "light",
    )
    seen = Reading(context.new_page())
    seen.page.on("pageerror", lambda error: seen.errors.append(str(error)))
    seen.page.on(
        "console",
        lambda said: seen.errors.append(said.text) if said.type == "error" else None,
    )
    seen.page.on("request", lambda request: seen.requests.append(request.url))
    seen.page.goto(path.as_uri())
    seen.page.wait_for_function("() => window.c2nav", timeout=PATIENCE_MS)
    yield seen
    context.close()
    assert seen.errors == []
    outside = [url for url in seen.requests if not url.startswith(("file:", "blob:", "data:"))]
    assert outside == []
    assert [url for url in seen.requests if url.startswith("file:")] == [path.as_uri()]


@pytest.fixture(scope="module")
def family_page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("pages") / "play.html"
    export_html([recording(), fork()], out, setting=Setting(plan=ROOM, why_not="none here"))
    return out


@pytest.fixture(scope="module")
def every_slot(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Trace]:
    folder = tmp_path_factory.mktemp("fake")
    write_fake(folder / "a.mcap", cycles=8, side_px=16)
    trace = read_trace(folder / "a.mcap")
    export_html([trace], folder / "a.html", options=HtmlOptions(no_scene=True))
    return folder / "a.html", trace


def test_every_place_shows_its_cards_and_every_answer(
    browser: Browser, every_slot: tuple[Path, Trace]
):
    path, trace = every_slot
    told = story(trace)
    with reading(browser, path) as seen:
        for decision in told.decisions:
            seen.stand(told.stop_of_decision(decision.number))
            cards = seen.page.locator("rank-strip .card")
            assert cards.count() == len(decision.facts.candidates)
            queries = decision.ranked.queries if decision.ranked else ()
            assert seen.page.locator(".x-left table.c2-table tbody tr").count() == len(queries)
            vetoed = [c.veto for c in decision.facts.candidates if c.veto]
            assert seen.page.locator("rank-strip .card.vetoed").count() == len(vetoed)
        assert "left out on request" in seen.page.locator(".x-note").inner_text()
        assert seen.page.get_by_role("tab", name="3-D").count() == 0


def test_pictures_are_drawn_in_their_own_pixels(browser: Browser, every_slot: tuple[Path, Trace]):
    path, _ = every_slot
    with reading(browser, path) as seen:
        seen.page.wait_for_function(
            "() => { const all = [...document.querySelector('rank-strip').shadowRoot"
            ".querySelectorAll('img.picture')];"
            " return all.length && all.every(i => i.naturalWidth) }"
        )
        widths = seen.page.evaluate(
            "[...document.querySelector('rank-strip').shadowRoot.querySelectorAll('img.picture')]"
            ".map(i => i.naturalWidth)"
        )
        assert set(widths) == {16}


def test_keys_buttons_and_the_timeline_go_through_it(browser: Browser, family_page: Path):
    with reading(browser, family_page) as seen:
        assert seen.place()["decision"] == 0
        seen.page.keyboard.press("n")
        assert seen.place()["decision"] == 1
        seen.page.keyboard.press("ArrowRight")
        assert seen.place()["step"] == 4
        seen.page.keyboard.press("p")
        assert seen.place()["decision"] == 1
        seen.page.get_by_title("next decision (N)").click()
        assert seen.place()["decision"] == 2
        bar = seen.page.locator("timeline-bar").bounding_box()
        assert bar is not None
        seen.page.mouse.click(bar["x"] + bar["width"] - 25, bar["y"] + 20)
        assert seen.place()["step"] == story(recording()).track.last_step


def test_a_recording_cannot_be_answered(browser: Browser, family_page: Path):
    with reading(browser, family_page) as seen:
        assert seen.page.locator("rank-strip .card").count() == 3
        buttons = seen.page.locator("rank-strip button:visible:not(.card)")
        assert buttons.count() == 0
        seen.page.locator("rank-strip .card").first.click(force=True)
        assert seen.page.evaluate("c2nav.state.draft.tiers.length") == 0


def test_the_body_walks_in_the_3d_view(browser: Browser, tmp_path: Path):
    traces = [recording(), fork()]
    world = still_page([(m.branch, m.story) for m in family_of(traces)], room())
    export_html(traces, tmp_path / "play.html", setting=Setting(plan=ROOM, world=world))
    with reading(browser, tmp_path / "play.html") as seen:
        frame = seen.page.wait_for_selector("iframe.x-world")
        assert frame is not None
        inside = frame.content_frame()
        assert inside is not None
        inside.wait_for_function(
            "() => window.__viserSceneTree && '/body' in window.__viserMutable.nodePoseData",
            timeout=PATIENCE_MS,
        )
        names = inside.evaluate("Object.keys(window.__viserSceneTree.getState())")
        wanted = {"/body", "/scene/part0", "/goal/disc", "/other/b1", "/way/number0"}
        assert wanted <= set(names)
        told = story(recording())
        step = told.track.last_step
        seen.stand(len(told.stops) - 1)
        inside.wait_for_function(
            "x => Math.abs(window.__viserMutable.nodePoseData['/body'].position[0] - x) < 0.01",
            arg=told.track.footsteps[step].pose.position_m[0],
            timeout=PATIENCE_MS,
        )


@pytest.mark.parametrize("dark", [False, True])
def test_light_and_dark_follow_the_reader(
    browser: Browser, every_slot: tuple[Path, Trace], dark: bool
):
    with reading(browser, every_slot[0], dark=dark) as seen:
        scheme = "document.documentElement.dataset.mantineColorScheme"
        assert seen.page.evaluate(scheme) == ("dark" if dark else "light")
        ground = seen.page.evaluate("getComputedStyle(document.body).backgroundColor")
        seen.page.get_by_role("button", name="Light" if dark else "Dark").click()
        assert seen.page.evaluate(scheme) == ("light" if dark else "dark")
        assert seen.page.evaluate("getComputedStyle(document.body).backgroundColor") != ground


def test_map_and_curves_are_drawn_for_every_branch(browser: Browser, family_page: Path):
    with reading(browser, family_page) as seen:
        for branch in range(2):
            seen.page.locator(".x-branches button").nth(branch).click()
            for tab in ("Map", "Curves"):
                seen.tab(tab)
                drawn = seen.page.locator(".x-middle [role=tabpanel]:visible svg path")
                assert drawn.count() >= 2
                assert "NaN" not in "".join(path.get_attribute("d") or "" for path in drawn.all())
        assert seen.page.evaluate("c2nav.state.branch.fork") == 6
        assert seen.place()["decision"] == 6


def test_a_link_opens_at_its_decision(browser: Browser, family_page: Path):
    with reading(browser, family_page) as seen:
        seen.page.goto(f"{family_page.as_uri()}#5")
        seen.page.reload()
        seen.page.wait_for_function("() => window.c2nav?.state.place?.decision === 5")
        seen.requests.clear()
        seen.requests.append(family_page.as_uri())


@pytest.mark.parametrize("size", [(1280, 720), (1920, 1080), (900, 1200)])
def test_nothing_overflows_sideways(browser: Browser, family_page: Path, size: tuple[int, int]):
    with reading(browser, family_page) as seen:
        seen.page.set_viewport_size({"width": size[0], "height": size[1]})
        for selector in ("body", ".x-left", ".x-right"):
            wide, room = seen.page.evaluate(
                "s => { const n = document.querySelector(s);"
                " return [n.scrollWidth, n.clientWidth] }",
                selector,
            )
            assert wide <= room + 1, (selector, wide, room)


@pytest.mark.slow
def test_thirty_one_decisions_of_a_built_in_episode_fit_and_open(browser: Browser, tmp_path: Path):
    bench = workbench()
    run = bench.open(OpenSpec("1"))
    while run.pending is not None and sum(e.decision is not None for e in run.exchanges) < 31:
        run.advance()
    count = sum(e.decision is not None for e in run.exchanges)
    footer = run.footer or Footer(EpisodeOutcome.INTERRUPTED, {})
    trace = Trace(run.header, tuple(run.exchanges), footer, "a" * 64, complete=True, path=tmp_path)
    run.close()
    members = family_of([trace])
    scene = bench.worlds.of(run.header.episode.scene_id).scene
    world = still_page([(m.branch, m.story) for m in members], scene)
    out = tmp_path / "builtin.html"
    page = export_html([trace], out, setting=Setting(world=world))
    assert count == 31
    assert page.size_bytes < MOST_BYTES
    with reading(browser, out) as seen:
        seen.stand(10)
        frame = seen.page.wait_for_selector("iframe.x-world")
        assert frame is not None
        inside = frame.content_frame()
        assert inside is not None
        inside.wait_for_function(
            "() => window.__viserSceneTree && '/scene/part0' in window.__viserSceneTree.getState()",
            timeout=PATIENCE_MS,
        )
