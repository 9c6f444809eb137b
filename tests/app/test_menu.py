"""The menu: every page links to all that are served beside it, and to nothing else."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from fastapi import FastAPI
from starlette.testclient import TestClient

from app.commands.sources import opened_traces
from app.gateway.runs import RunPages, runs_application
from app.gateway.serving import application, menu_of, mount_pages
from app.inspector.shell import Shell
from app.pages.library import Library
from app.session.opened import Opened
from app.session.worker import Session
from c2nav_engine.experiments.spec import Setting
from tests.helpers import stage
from tests.helpers.judged import judged_run

PAGES = ("run", "cases", "compare", "agreement", "inspector")


def linked(page: str) -> list[str]:
    """Addresses in a page's menu."""
    menu = re.search(r'<nav aria-label="pages">(.*?)</nav>', page, re.DOTALL)
    assert menu is not None
    return re.findall(r'href="([^"]+)"', menu[1])


def told(opened: Opened, menu: tuple[str, ...]) -> dict[str, str]:
    """What the inspector's page asks for."""
    session = Session(opened)
    shell = Shell(session)
    try:
        app = application(session, shell, menu=menu)
        return TestClient(app, base_url="http://127.0.0.1").get("/api/menu").json()
    finally:
        session.close()
        shell.close()


@pytest.fixture
def opened(tmp_path: Path) -> tuple[Opened, RunPages]:
    run = judged_run(tmp_path, episodes=2, cycles=2)
    library = Library(run)
    library.refresh()
    traces = sorted((run / "traces").glob("*.mcap"))
    return opened_traces(traces, Setting(source="builtin")), RunPages(library)


def served(opened: Opened, runs: RunPages | None) -> TestClient:
    """What stands beside the inspector, and a page in its place."""
    app = FastAPI()
    mount_pages(app, opened, runs)
    app.get("/")(lambda: "the inspector")
    return TestClient(app, base_url="http://127.0.0.1")


def test_every_page_of_a_run_leads_to_every_other(opened: tuple[Opened, RunPages]):
    client = served(*opened)
    for name in PAGES[:-1]:
        found = linked(client.get(f"/{name}").text)
        assert found == [*PAGES[:-1], "."]
        assert all(client.get(f"/{address.strip('.')}").status_code == 200 for address in found)


def test_traces_without_a_run_have_agreement_alone(opened: tuple[Opened, RunPages]):
    client = served(opened[0], None)
    assert linked(client.get("/agreement").text) == ["agreement", "."]
    assert client.get("/run").status_code == 404


def test_pages_alone_name_no_inspector_and_open_nothing_in_it(opened: tuple[Opened, RunPages]):
    client = TestClient(runs_application(opened[1]), base_url="http://127.0.0.1")
    for name in ("run", "cases", "compare"):
        page = client.get(f"/{name}").text
        found = linked(page)
        assert found == ["run", "cases", "compare"]
        assert all(client.get(f"/{address}").status_code == 200 for address in found)
        assert "data-open" not in page


def test_the_inspector_page_is_told_what_stands_beside_it(opened: tuple[Opened, RunPages]):
    beside = {"run": "Run", "cases": "Cases", "compare": "Compare", "agreement": "Agreement"}
    assert told(opened[0], menu_of(*opened)) == beside
    live = stage.opened_live()
    assert told(live, menu_of(live, None)) == {}
