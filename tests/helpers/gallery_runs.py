"""The pages about runs in light and dark, as pictures for the docs.

python -m tests.helpers.gallery_runs RUNS --out docs/gallery
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import uvicorn
from playwright.sync_api import Browser

from app.gateway.runs import RunPages, runs_application
from app.pages.library import Library
from app.pages.matrix import arms, matrix_of
from app.pages.page import MENU
from tests.helpers.loopback import on_loopback
from tests.helpers.page import chromium

SIZE = (1600, 900)


def pages(library: Library) -> Iterator[tuple[str, str]]:
    """Name → address, of what the folder holds."""
    known = arms(library)
    yield "run", f"run?run={known[0].run}"
    yield "cases", "cases?sort=-ne_m"
    if len(known) < 2:
        return
    yield "compare", f"compare?a={known[0].name}&b={known[1].name}"
    matrix = matrix_of(library, known[0], known[1])
    pair = next(pairs[0] for pairs in matrix.cells.values() if pairs)
    yield "pair", f"compare?a={pair[0].sha256}&b={pair[1].sha256}"


def shoot(browser: Browser, url: str, path: Path, *, dark: bool) -> None:
    """One picture of the visible page."""
    page = browser.new_page(
        viewport={"width": SIZE[0], "height": SIZE[1]}, color_scheme="dark" if dark else "light"
    )
    page.goto(url)
    page.wait_for_load_state("networkidle")
    page.screenshot(path=path, type="jpeg", quality=80)
    page.close()


def main() -> None:
    """Make the pictures."""
    reader = argparse.ArgumentParser(description=__doc__)
    reader.add_argument("runs", type=Path)
    reader.add_argument("--out", type=Path, required=True)
    given = reader.parse_args()
    library = Library(given.runs)
    library.refresh()
    app = runs_application(RunPages(library, menu=tuple(MENU)))
    server = uvicorn.Server(uvicorn.Config(app, ws="none", log_level="warning", lifespan="off"))
    given.out.mkdir(parents=True, exist_ok=True)
    with on_loopback(server) as base, chromium() as browser:
        for name, address in pages(library):
            for dark in (False, True):
                path = given.out / f"{name}-{'dark' if dark else 'light'}.jpg"
                shoot(browser, base + address, path, dark=dark)
    library.close()


if __name__ == "__main__":
    main()
