"""Every panel on a recorded run and in the furnished house, in both lights and both windows."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from app.commands.sources import opened_source, opened_traces
from app.session.opened import Opened, Opening
from c2nav_engine.experiments.spec import Setting
from tests.helpers import stage
from tests.helpers.gallery import LARGE, SMALL, copy_of, shots, tab
from tests.helpers.layout import problems
from tests.helpers.page import Visit, inspector, visit

pytestmark = pytest.mark.browser

GOLDEN = Path(__file__).resolve().parents[1] / "golden" / "trace-v1.mcap"


def resized(seen: Visit, size: tuple[int, int]) -> None:
    seen.page.set_viewport_size({"width": size[0], "height": size[1]})
    seen.page.wait_for_function("width => innerWidth === width", arg=size[0])


def walk(seen: Visit) -> dict[str, list[str]]:
    """What is wrong with each view, in either window; names of flawless ones are left out."""
    found: dict[str, list[str]] = {}
    for name, arrange in shots(seen).items():
        arrange(seen)
        for size in (LARGE, SMALL):
            resized(seen, size)
            wrong = problems(seen)
            if wrong:
                found[f"{name} {size[0]}×{size[1]}"] = wrong
    return found


@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_a_recorded_run_fits_in_every_view(browser: Browser, dark: bool, tmp_path: Path):
    opened = opened_traces([copy_of(GOLDEN, tmp_path)], Setting(source="builtin"))
    with inspector(opened) as (url, _), visit(browser, url, size=SMALL, dark=dark) as seen:
        assert walk(seen) == {}
        assert not seen.errors


@pytest.mark.slow
@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_the_furnished_house_fits_in_every_view(
    browser: Browser, shared: Path, dark: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.chdir(tmp_path)
    source = str(shared / "data" / "furnished_house_8.json.gz")
    setting = Setting(source=source, scenes=str(shared / "scenes"), ranker="scripted")
    with (
        inspector(opened_source(setting)) as (url, _),
        visit(browser, url, size=SMALL, dark=dark) as seen,
    ):
        for _ in range(8):
            number = seen.state()["place"]["decision"]
            seen.until("s.decision.source === 'proposal'")
            seen.page.keyboard.press("Enter")
            seen.until(f"s.place.decision > {number}")
        assert walk(seen) == {}
        assert not seen.errors


def long_words() -> Opened:
    """A recording whose instruction fills half a page, with words that no line can hold."""
    run = stage.finished_run(6)
    legs = tuple(f"{leg} {'and on through the next room ' * 6}".strip() for leg in run.header.legs)
    text = ", ".join(legs) + f" {'x' * 160}"
    episode = replace(run.header.episode, instruction=text)
    header = replace(run.header, episode=episode, legs=legs, ranker="a-model/" + "name" * 30)
    return replace(
        stage.opened_recording(),
        open=lambda _: Opening(header, run.exchanges, run.footer, no_scene="no scene: " + text),
    )


STATES: dict[str, tuple[Callable[[], Opened], str]] = {
    "waiting": (lambda: stage.opened_live(gate=threading.Event()), "s.asking"),
    "consent": (lambda: stage.opened_live(sends_to=f"{'models.' * 9}example"), "s.consent_to"),
    "no decision was asked": (lambda: stage.opened_recording(cycles=1), "s.decision"),
    "long words": (long_words, "s.no_scene"),
}


@pytest.mark.parametrize("name", STATES)
def test_unusual_states_fit_too(browser: Browser, name: str):
    make, reached = STATES[name]
    with inspector(make()) as (url, _), visit(browser, url, size=SMALL) as seen:
        seen.until(reached)
        seen.page.wait_for_timeout(600)  # a wait is shown once it is long enough to be noticed
        found = {"at first": problems(seen)}
        for left, right in (("Look-back", "Branches"), ("Sketch", "Review"), ("Ladder", "Export")):
            tab(left, right)(seen)
            found[left] = problems(seen)
        assert {view: wrong for view, wrong in found.items() if wrong} == {}
        assert not seen.errors
