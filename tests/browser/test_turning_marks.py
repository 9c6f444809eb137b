"""Turning points clicked in the browser: a star of the timeline opens the branch that succeeds."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from app.commands.sources import opened_traces
from app.session import searching
from c2nav_engine.experiments.spec import Setting
from c2nav_engine.experiments.turning.flips import Budget
from tests.helpers.page import PATIENCE_MS, Visit, inspector, visit
from tests.helpers.planted import SHORT, decision_of, flawless

pytestmark = pytest.mark.browser


@pytest.fixture
def wrong(tmp_path: Path) -> int:
    """A trace with one planted wrong answer at failure.mcap; that decision's number."""
    whole = flawless(SHORT)
    recording = whole.with_mistakes(whole.mistakes[0], trace=tmp_path / "failure.mcap")
    return decision_of(recording, whole.mistakes[0])


@pytest.fixture
def seen(browser: Browser, wrong: int, tmp_path: Path, monkeypatch) -> Iterator[Visit]:
    """That failure in the inspector, at its planted answer."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(searching, "SUSPECTS", 1)
    monkeypatch.setattr(searching, "BUDGET", Budget(repeats=1))
    opened = opened_traces([tmp_path / "failure.mcap"], Setting(source="builtin"))
    with inspector(opened) as (url, _), visit(browser, url) as seen:
        seen.page.evaluate("decision => window.c2nav.send('go', { decision })", wrong)
        seen.until(f"s.place.decision === {wrong}")
        yield seen


def test_a_star_of_the_timeline_opens_the_branch_that_succeeds(seen: Visit, wrong: int):
    page = seen.page
    page.get_by_role("tab", name="Turning").click()
    page.get_by_role("button", name="Measure").click()
    page.get_by_role("button", name="Try other answers").click(timeout=PATIENCE_MS)
    star = page.locator("timeline-bar .mark", has_text="★")
    expect(star).to_have_count(1, timeout=PATIENCE_MS)
    # One stands at the very decision: neither the line there nor its words may take the click.
    star.hover()
    tip = page.locator("timeline-bar .tip")
    expect(tip).to_contain_text(f"decision {wrong} · one answer away")
    star.click()
    seen.until(f"s.branch.differs && s.branch.fork === {wrong} && s.branch.ended !== ''")
    assert "✓" in seen.state()["branch"]["ended"]

    page.get_by_role("button", name=f"Back to the failure, decision {wrong}").click()
    seen.until("!s.branch.differs")
    page.locator("timeline-bar .mark", has_text="⇥").click()
    seen.until(f"!s.branch.differs && s.place.decision === {wrong}")
    assert not seen.errors
