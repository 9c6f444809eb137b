"""A packed page in a real browser: from disk, offline, and back as a file of answers."""

from __future__ import annotations

import json
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page

from app.cli import main
from app.reviews.state import standing
from app.reviews.store import store_of
from app.reviews.study import Study
from tests.helpers.judged import ANSWER, GOAL_M, RANKER, SERVED, judged_run, study_with

pytestmark = pytest.mark.browser

SHOWN = "n => document.body.dataset.shown === String(n)"


def command(*words: str | Path) -> int:
    with pytest.raises(SystemExit) as stopped:
        main([str(word) for word in words])
    return int(stopped.value.code or 0)


@pytest.fixture
def packed(tmp_path: Path) -> tuple[Study, Path]:
    """A study of one person, and their page."""
    run = judged_run(tmp_path, episodes=3, cycles=3)
    study, _ = study_with(run, "ann", per_slot=2)
    assert command("study", "pack", run, "--name", "first", "--out", tmp_path / "out") == 0
    return study, tmp_path / "out" / "first.P1.html"


@contextmanager
def opened(browser: Browser, path: Path) -> Generator[Page]:
    """The page from disk; anything that it asks of any network fails the test."""
    context = browser.new_context(offline=True)
    page = context.new_page()
    asked: list[str] = []
    problems: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.on("pageerror", lambda error: problems.append(str(error)))
    page.on("console", lambda said: problems.append(said.text) if said.type == "error" else None)
    page.goto(path.as_uri())
    yield page
    context.close()
    assert {url for url in asked if not url.startswith(("data:", "blob:"))} == {path.as_uri()}
    assert problems == []


def judge_on(page: Page, start: int, end: int) -> None:
    for number in range(start, end):
        page.wait_for_function(SHOWN, arg=number)
        page.keyboard.press("2")
        page.keyboard.press("Enter")


def saved(page: Page, path: Path) -> Path:
    with page.expect_download() as download:
        page.click("#save")
    assert download.value.suggested_filename == "first.P1.jsonl"
    download.value.save_as(path)
    return path


def test_answers_given_offline_come_back_once(
    browser: Browser, packed: tuple[Study, Path], tmp_path: Path
):
    study, path = packed
    total = len(study.queue("P1"))
    with opened(browser, path) as page:
        judge_on(page, 0, 2)
        page.wait_for_function(SHOWN, arg=2)
        page.keyboard.press("u")
        page.wait_for_function(SHOWN, arg=1)
        page.keyboard.press("x")
        page.keyboard.press("Enter")
        page.wait_for_function(SHOWN, arg=2)
        # Closed and opened again: it goes on where it stood.
        page.reload()
        judge_on(page, 2, total)
        page.wait_for_function(SHOWN, arg="done")
        out = saved(page, tmp_path / "back.jsonl")
    assert len(out.read_text("utf-8").splitlines()) == total + 2
    assert command("study", "import", study.run, out, "--name", "first") == 0
    with store_of(study.run) as store:
        answers = standing(store.events())
    assert sorted(int(event.extra["place"]) for event in answers) == list(range(total))
    assert {event.author for event in answers} == {"ann"}
    assert all(event.blind for event in answers)
    second = next(event for event in answers if event.extra["place"] == "1")
    assert type(second.said).__name__ == "Abstention"
    assert command("study", "import", study.run, out, "--name", "first") == 2


def test_the_file_tells_no_more_than_the_questions(packed: tuple[Study, Path]):
    study, path = packed
    text = path.read_text("utf-8")
    hidden = [ANSWER, RANKER, SERVED, str(GOAL_M), "potoroo", "numbat", str(study.folder), '"ann"']
    hidden += [item.trace_sha256 for item in study.items]
    hidden += ['"slot"', '"keys"', '"seed"', '"decision"', '"episode"', '"success"', ".mcap"]
    for secret in hidden:
        assert secret not in text, secret


def test_a_page_packed_later_passes_over_what_is_answered(
    browser: Browser, packed: tuple[Study, Path], tmp_path: Path
):
    study, path = packed
    with opened(browser, path) as page:
        judge_on(page, 0, 2)
        page.wait_for_function(SHOWN, arg=2)
        out = saved(page, tmp_path / "part.jsonl")
    assert command("study", "import", study.run, out, "--name", "first") == 0
    assert command("study", "pack", study.run, "--name", "first", "--out", tmp_path / "rest") == 0
    with opened(browser, tmp_path / "rest" / path.name) as page:
        page.wait_for_function(SHOWN, arg=2)
        assert page.inner_text("#progress").startswith("2 of ")


def test_every_line_holds_what_its_import_checks(browser: Browser, packed, tmp_path: Path):
    """Whatever of a line is changed, the whole file is refused and nothing is stored."""
    study, path = packed
    with opened(browser, path) as page:
        judge_on(page, 0, 2)
        page.wait_for_function(SHOWN, arg=2)
        out = saved(page, tmp_path / "good.jsonl")
    first, second = map(json.loads, out.read_text("utf-8").splitlines())
    changes = [
        {"study_sha256": "0" * 64},
        {"person": "P9"},
        {"question_sha256": first["question_sha256"]},
        {"place": 0, "question_sha256": first["question_sha256"]},
        {"place": 9_999},
        {"id": first["id"]},
        {"tiers": [["Q"]]},
        {"tiers": "A"},
        {"packed": 2},
        {"more": 1},
    ]
    for number, change in enumerate(changes):
        odd = tmp_path / f"odd{number}.jsonl"
        odd.write_text(f"{json.dumps(first)}\n{json.dumps(second | change)}\n", encoding="utf-8")
        assert command("study", "import", study.run, odd, "--name", "first") == 2, change
    with store_of(study.run) as store:
        assert store.events() == []
    assert command("study", "import", study.run, out, "--name", "first") == 0
