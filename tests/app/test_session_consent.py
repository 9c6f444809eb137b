"""Pictures leave the machine after a yes alone, and the trace says who said it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import cast

import pytest

from app.session import commands as c
from app.session.consent import CONSENT_FILE, Consent
from app.session.worker import Session
from c2nav_engine.runner.opening import OpenSpec
from c2nav_engine.runner.recorded import open_trace
from c2nav_engine.traces import check, recover
from tests.helpers import stage
from tests.helpers.benches import workbench
from tests.helpers.watched import Watched

HOST = "models.example"
YES = Consent(HOST, "Ann", 1_700_000_000.0)


@pytest.fixture
def abroad() -> Iterator[Watched]:
    session = Session(stage.opened_live(sends_to=HOST))
    yield Watched(session)
    session.close()


def kept(watched: Watched) -> list[dict[str, str]]:
    runs = cast("dict[str, stage.PlayRun]", watched.session._desk.runs).values()
    return [json.loads(run.kept[CONSENT_FILE]) for run in runs if CONSENT_FILE in run.kept]


def test_nothing_is_asked_or_kept_before_the_yes(abroad: Watched):
    abroad.until(lambda s: s.consent_to == HOST)
    assert abroad.session.snapshot.asking is None
    abroad.do(c.Consent(allow=False))
    abroad.until(lambda s: not s.consent_to)
    assert abroad.session.snapshot.asking is None
    assert not kept(abroad)


def test_the_yes_names_host_licence_and_person(abroad: Watched):
    abroad.until(lambda s: s.consent_to == HOST)
    abroad.do(c.Name(who="Ann"))
    abroad.do(c.Consent(allow=True))
    abroad.until(lambda s: s.proposal is not None)
    (said,) = kept(abroad)
    assert said["pictures_go_to"] == HOST
    assert said["scene_licence"] == "unknown"
    assert said["allowed_by"] == "Ann"


def test_it_is_asked_once_and_kept_in_every_run_that_it_covers(abroad: Watched):
    abroad.until(lambda s: s.consent_to == HOST)
    abroad.do(c.Consent(allow=True))
    abroad.until(lambda s: s.proposal is not None)
    abroad.do(c.Open(entry="2"))
    later = abroad.until(lambda s: s.chooser.choice.entry_id == "2" and s.proposal is not None)
    assert not later.consent_to
    assert len(kept(abroad)) == 1


def test_a_recorded_yes_is_read_back_and_survives_a_kill(tmp_path: Path):
    run = workbench(ranker="scripted").open(OpenSpec("1", trace=tmp_path / "run.mcap"))
    for _ in range(3):
        run.advance()
    YES.keep(run)
    YES.keep(run)
    run.advance()
    run.close()
    recover(tmp_path / "run.mcap.part", tmp_path / "kept.mcap")
    assert check(tmp_path / "kept.mcap") == []
    with open_trace(tmp_path / "kept.mcap") as trace:
        assert trace.file.attachments.count(CONSENT_FILE) == 1
        said = json.loads(trace.file.attachment(CONSENT_FILE))
        licence = trace.header.scene_licence
    assert licence
    assert said == {
        "pictures_go_to": HOST,
        "scene_licence": licence,
        "allowed_by": "Ann",
        "at": "2023-11-14T22:13:20+00:00",
    }
