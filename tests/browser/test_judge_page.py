"""Two people judge at once in two browsers, by keyboard alone; one tab is killed midway."""

from __future__ import annotations

import base64
import json
from collections.abc import Generator, Iterable
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import uvicorn
from playwright.sync_api import Browser, Page
from scipy.stats import kendalltau
from statsmodels.stats.inter_rater import aggregate_raters, fleiss_kappa

from app.gateway.judging import desks_of, judging_application
from app.reviews.agreement import agreements
from app.reviews.questions import prompt_at
from app.reviews.reading import read_answers
from app.reviews.state import standing
from app.reviews.store import export_lines, store_of
from app.reviews.study import Person, Study
from c2nav_engine.contract.prompt import Prompt
from tests.helpers.judged import judged_run, study_with
from tests.helpers.loopback import on_loopback

pytestmark = pytest.mark.browser

TAU: Any = kendalltau
SHOWN = "n => document.body.dataset.shown === String(n)"


@contextmanager
def served(run: Path) -> Generator[str]:
    app = judging_application(desks_of([run]))
    server = uvicorn.Server(uvicorn.Config(app, ws="none", log_level="warning"))
    with on_loopback(server) as address:
        yield f"{address}judge?token="


@pytest.fixture
def study(tmp_path: Path) -> tuple[Study, list[tuple[Person, str]]]:
    run = judged_run(tmp_path, episodes=10, cycles=3)
    return study_with(run, "ann", "bob", per_slot=5)


def rank(page: Page, order: Iterable[int]) -> None:
    """Rank the question on the page: `order` draws from the labels that it has; then submit."""
    count = page.locator("#choices button").count()
    for place in [each for each in order if each < count]:
        page.keyboard.press(str(place + 1))
    page.keyboard.press("Enter")


def test_two_people_judge_sixty_decisions_at_once_and_one_tab_is_killed(
    browser: Browser, tmp_path: Path
):
    """Nothing is lost, nothing doubled; figures equal those counted from the plain export."""
    run = judged_run(tmp_path, episodes=22, cycles=3)
    study, ((ann, hers), (bob, his)) = study_with(run, "ann", "bob", per_slot=13, repeat=0.0)
    total = len(study.items)
    assert total >= 60
    generator = np.random.default_rng(11)
    orders = [generator.permutation(9).tolist() for _ in range(2 * total)]
    problems: list[str] = []
    with served(run) as url:
        pages = [browser.new_context().new_page() for _ in range(2)]
        for page, token in zip(pages, (hers, his), strict=True):
            page.on("pageerror", lambda error: problems.append(str(error)))
            page.on("console", lambda m: problems.append(m.text) if m.type == "error" else None)
            page.goto(url + token)
        for number in range(total // 2):
            for page in pages:
                page.wait_for_function(SHOWN, arg=number)
            for who, page in enumerate(pages):
                rank(page, orders[2 * number + who])
        # Killed with an answer on its way: it is stored or it is not, and never twice.
        pages[1].context.close()
        pages[1] = browser.new_context().new_page()
        pages[1].goto(url + his)
        pages[1].wait_for_function("() => document.body.dataset.shown !== undefined")
        resumed = int(pages[1].evaluate("document.body.dataset.shown"))
        assert resumed in (total // 2 - 1, total // 2)
        for page, start in zip(pages, (total // 2, resumed), strict=True):
            for number in range(start, total):
                page.wait_for_function(SHOWN, arg=number)
                rank(page, orders[2 * number + (page is pages[1])])
            page.wait_for_function(SHOWN, arg="done")
            page.context.close()
    assert problems == []
    with store_of(run) as store:
        answers = standing(store.events())
        lines = [json.loads(line) for line in export_lines(store)]
    given = sorted((event.author, int(event.extra["place"])) for event in answers)
    assert given == [(person.name, place) for person in (ann, bob) for place in range(total)]
    assert all(int(event.extra["response_ms"]) > 0 for event in answers)
    assert len(lines) == 2 * total
    _figures_equal_those_by_hand(run, lines)


def _figures_equal_those_by_hand(run: Path, lines: list[dict[str, Any]]) -> None:
    """Agreement of two people, counted from exported JSON with scipy and statsmodels."""
    said: dict[str, dict[str, dict[str, list[str]]]] = {}
    for line in lines:
        order = [key for tier in line["said"]["ordering"] for key in tier]
        extra = line["extra"]
        said.setdefault(extra["slot"], {}).setdefault(extra["question"], {})[line["author"]] = order
    rows = {row.slot: row for row in agreements(read_answers([run])) if row.kind == "human-human"}
    assert set(said) <= set(rows)
    for slot, questions in said.items():
        row = rows[slot]
        pairs = [(answer["P1"], answer["P2"]) for answer in questions.values()]
        equal = [a[0] == b[0] for a, b in pairs]
        taus = [
            TAU(*([order.index(key) for key in sorted(a)] for order in (a, b)))[0] for a, b in pairs
        ]
        names = sorted({winner for a, b in pairs for winner in (a[0], b[0])})
        table = np.array([[names.index(a[0]), names.index(b[0])] for a, b in pairs])
        kappa = fleiss_kappa(aggregate_raters(table)[0], method="fleiss")
        alpha = 1 - (1 - kappa) * (table.size - 1) / table.size
        assert row.questions == len(pairs)
        assert row.top1 is not None
        assert row.tau is not None
        assert row.alpha is not None
        assert row.top1.estimate == pytest.approx(np.mean(equal), abs=1e-9)
        assert row.chance == pytest.approx(np.mean([1 / len(a) for a, _ in pairs]), abs=1e-9)
        assert row.tau.estimate == pytest.approx(np.mean(taus), abs=1e-9)
        assert row.alpha.estimate == pytest.approx(alpha, abs=1e-9)


def test_ties_none_and_undo_by_keyboard(
    browser: Browser, study: tuple[Study, list[tuple[Person, str]]]
):
    frozen, ((ann, token), _) = study
    with served(frozen.run) as url:
        page = browser.new_context().new_page()
        page.goto(url + token)
        page.wait_for_function(SHOWN, arg=0)
        _shows(page, prompt_at(frozen, frozen.queue(ann.queue)[0]))
        for key in ("b", "=", "a"):
            page.keyboard.press(key)
        assert page.inner_text("#ranking") == "B = A"
        page.keyboard.press("Enter")
        page.wait_for_function(SHOWN, arg=1)
        page.keyboard.press("x")
        assert page.inner_text("#ranking") == "none"
        page.keyboard.press("Enter")
        page.wait_for_function(SHOWN, arg=2)
        page.keyboard.press("u")
        page.wait_for_function(SHOWN, arg=1)
        assert page.inner_text("#ranking") == ""
        picture = page.locator("main img").first
        if picture.count():
            assert picture.evaluate("e => getComputedStyle(e).imageRendering") == "pixelated"
            width = picture.evaluate("e => e.getBoundingClientRect().width / e.naturalWidth")
            assert width == round(width)
        page.context.close()
    with store_of(frozen.run) as store:
        first, none, undo = store.events()
    assert type(first.said).__name__ == "Tie"
    assert type(none.said).__name__ == "Abstention"
    assert undo.target == none.id


def _shows(page: Page, prompt: Prompt) -> None:
    """Every word and every picture of a prompt, in their order, and nothing else."""
    words = page.evaluate(
        "[...document.querySelectorAll('main .words')].map(n => n.textContent).join('')"
    )
    sources = page.evaluate("[...document.querySelectorAll('main img')].map(n => n.src)")
    assert words.split() == "".join(p for p in prompt.parts if isinstance(p, str)).split()
    pictures = [part.jpeg for part in prompt.parts if not isinstance(part, str)]
    assert [base64.b64decode(each.split(",")[1]) for each in sources] == pictures
