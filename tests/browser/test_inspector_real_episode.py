from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser

from app.commands.sources import INSPECTED, opened_source
from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.experiments.spec import Setting
from c2nav_engine.runner.recorded import open_trace
from c2nav_engine.traces.recover import recover
from tests.helpers.page import inspector, visit

pytestmark = pytest.mark.browser


def test_the_furnished_house_is_stepped_overridden_and_recorded(
    browser: Browser, shared: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.chdir(tmp_path)
    setting = Setting(
        source=str(shared / "data" / "furnished_house_8.json.gz"),
        scenes=str(shared / "scenes"),
        profile="vlnce",
    )
    with inspector(opened_source(setting)) as (url, _), visit(browser, url) as seen:
        seen.until("s.decision.source === 'proposal'")
        seen.until_node("/scene/part0")
        seen.until_node("/fan/front")
        for _ in range(3):
            number = seen.state()["place"]["decision"]
            seen.page.keyboard.press("Enter")
            seen.until(f"s.place.decision > {number} && s.decision.source === 'proposal'")
        while seen.state()["decision"]["slot"] != "seeing":
            number = seen.state()["place"]["decision"]
            seen.page.keyboard.press("Enter")
            seen.until(f"s.place.decision > {number} && s.decision.source === 'proposal'")
        decision = seen.state()["decision"]
        ranked = sorted((c for c in decision["cards"] if c["feasible"]), key=lambda c: c["rank"])
        best, last = ranked[0]["key"], ranked[-1]["key"]
        seen.drag(last, before=best)
        seen.until("s.decision.source === 'draft'")
        seen.page.keyboard.press("Enter")
        seen.until(f"s.place.decision > {decision['number']}")
        assert len(seen.hosts) == 1
        assert not seen.errors
    part = next((tmp_path / INSPECTED).glob("*.part"))
    recover(part, tmp_path / "kept.mcap")
    with open_trace(tmp_path / "kept.mcap") as trace:
        made = next(e for e in trace.decisions() if e.decision == decision["number"])
    assert made.override is not None
    assert isinstance(made.override.outcome, Ordering)
    assert made.override.outcome.winner == last
    assert made.ranked is not None
    assert isinstance(made.ranked.outcome, Ordering)
    assert made.ranked.outcome.winner == best
