"""Failures are gathered in the browser, and two of them compared, by mouse and keyboard."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
import uvicorn
from playwright.sync_api import Browser, Locator, Page

from app.exports.case_sets.unpacking import unpack_set
from app.gateway.runs import RunPages, runs_application
from app.pages.index import curation
from app.pages.library import Library
from tests.helpers.cases import fake_run
from tests.helpers.loopback import on_loopback

pytestmark = pytest.mark.browser

PATIENCE_MS = 180_000
"""Figures are drawn by a library that takes seconds to load, more on a busy machine."""


@contextmanager
def served(library: Library) -> Generator[str]:
    config = uvicorn.Config(runs_application(RunPages(library)), ws="none", log_level="warning")
    with on_loopback(uvicorn.Server(config)) as address:
        yield address


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    page = browser.new_page(viewport={"width": 1280, "height": 720})
    problems: list[str] = []
    page.on("pageerror", lambda error: problems.append(str(error)))
    page.on("console", lambda m: problems.append(m.text) if m.type == "error" else None)
    yield page
    page.close()
    assert problems == []


def choose(page: Page, *places: int) -> None:
    for place in places:
        page.locator(".p-case input[type=checkbox]").nth(place).check()


def follow(page: Page, there: Locator) -> None:
    """Click what leads to another page, and be on it."""
    with page.expect_navigation():
        there.click()


def answer(page: Page, button: str, name: str) -> None:
    """Press a button of the bar and answer its dialog."""
    page.get_by_role("button", name=button).click()
    page.locator("#p-ask input").fill(name)
    with page.expect_navigation():
        page.keyboard.press("Enter")


def test_a_set_is_gathered_captioned_and_compared(page: Page, tmp_path: Path):
    fake_run(tmp_path / "one", episodes=3)
    library = Library(tmp_path)
    library.refresh()
    with served(library) as url:
        page.goto(f"{url}cases")
        choose(page, 0, 2)
        answer(page, "Tag…", "glass door")
        page.get_by_role("button", name="Clear").click()
        follow(page, page.get_by_role("button", name="glass door", exact=True))
        page.locator("[data-all]").check()
        assert page.locator("[data-picked]").inner_text() == "2 chosen"
        answer(page, "Add to set…", "failures")
        follow(page, page.get_by_role("link", name="failures", exact=True))
        assert page.locator(".p-case").count() == 2
        page.locator("[data-caption]").first.fill("Walks into glass.")
        with page.expect_response("**/cases/caption"):
            page.keyboard.press("Tab")
        with page.expect_response("**/cases/export", timeout=PATIENCE_MS) as exported:
            page.get_by_role("button", name="Export").click()
        folder = Path(exported.value.json()["folder"])
        page.get_by_text(f"exported to {folder}").wait_for()
        page.get_by_role("button", name="Compare the two").click()
        page.wait_for_selector(".p-parted h1")
        before = page.locator("output").inner_text()
        page.keyboard.press("ArrowLeft")
        assert page.locator("output").inner_text() != before
        page.locator("[data-axis]").select_option("leg")
        image = page.locator(".p-walk img").first
        page.wait_for_function("() => document.querySelector('.p-walk img').naturalWidth > 0")
        assert image.get_attribute("src")
        members = curation.members(library.store, "failures")
        assert [caption for _, _, caption in members] == ["Walks into glass.", ""]
        assert all(case is not None and case.marks == ("glass door",) for case, _, _ in members)
    _opens_offline(page, folder)
    _opens_elsewhere(page, folder, tmp_path / "elsewhere")


def _opens_offline(page: Page, folder: Path) -> None:
    """The page of an exported set asks nothing of any network, and its files are as they were."""
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto((folder / "index.html").as_uri())
    page.wait_for_load_state("networkidle")
    widths = page.evaluate("[...document.images].map((image) => image.naturalWidth)")
    assert len(widths) == 2
    assert min(widths) > 0
    assert "Walks into glass." in page.inner_text("figure")
    assert all(address.startswith(folder.as_uri()) for address in asked)
    held = json.loads((folder / "manifest.json").read_text("utf-8"))["files"]
    files = {path for path in folder.rglob("*") if path.is_file()} - {folder / "manifest.json"}
    assert held == {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in files
    }


def _opens_elsewhere(page: Page, folder: Path, there: Path) -> None:
    """Another folder of runs takes the set in, with its tag and its caption."""
    unpack_set(folder, there)
    library = Library(there)
    library.refresh()
    with served(library) as url:
        page.goto(f"{url}cases")
        follow(page, page.get_by_role("link", name="failures", exact=True))
        assert page.locator(".p-case").count() == 2
        assert page.locator(".p-mark").all_inner_texts() == ["glass door"] * 2
        assert page.locator("[data-caption]").first.input_value() == "Walks into glass."


@pytest.mark.parametrize("size", [(1280, 720), (1920, 1080)])
def test_no_page_overflows_sideways(page: Page, tmp_path: Path, size: tuple[int, int]):
    fake_run(tmp_path, episodes=2)
    library = Library(tmp_path)
    library.refresh()
    page.set_viewport_size({"width": size[0], "height": size[1]})
    digests = library.store.column("select trace_sha256 from episodes")
    with served(library) as url:
        for path in ("run", "cases", "compare", f"compare?a={digests[0]}&b={digests[1]}"):
            page.goto(f"{url}{path}")
            wide, room = page.evaluate("[document.body.scrollWidth, window.innerWidth]")
            assert wide <= room, path
