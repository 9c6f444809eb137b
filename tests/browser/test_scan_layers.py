"""A scan with stairs in the browser: the cut follows, floor and viewpoints lie over it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from app.commands.sources import opened_traces
from app.inspector.scene.storey import storey_m
from app.session import commands as c
from c2nav_engine.episodes.profile import VLNCE
from c2nav_engine.experiments.spec import Setting
from c2nav_engine.geometry import Pinhole
from c2nav_engine.runner.opening import OpenSpec
from c2nav_engine.runner.source import open_source
from tests.helpers.benches import workbench
from tests.helpers.page import inspector, visit
from tests.helpers.scans import NAMES, RISE_M, write_scans

pytestmark = pytest.mark.browser

STAIRS = 6
"""Index of a scan with a flight of stairs."""


def graph(folder: Path, name: str) -> None:
    """A viewpoint at the foot and one at the head of the stairs, in Matterport's axes."""
    entries = [
        {
            "image_id": image_id,
            "pose": [1, 0, 0, 1.0, 0, 1, 0, -z, 0, 0, 1, y + 1.5, 0, 0, 0, 1],
            "included": True,
            "unobstructed": [image_id != "foot", image_id != "head"],
            "height": 1.5,
        }
        for image_id, y, z in (("foot", 0.0, 2.0), ("head", RISE_M, 8.0))
    ]
    folder.mkdir()
    (folder / f"{name}_connectivity.json").write_text(json.dumps(entries), encoding="utf-8")


def climbed(folder: Path) -> Path:
    """A trace of the simulated observer walking up the stairs."""
    source = open_source(str(write_scans(folder)), scenes=folder)
    profile = replace(VLNCE, rgb=Pinhole(48, 48, 1.57), depth=Pinhole(48, 48, 1.57))
    bench = workbench(source, ranker="simulated", profile=profile, cache=folder / "cache")
    trace = folder / "climbed.mcap"
    run = bench.open(OpenSpec(str(STAIRS + 1), run="test", trace=trace))
    while run.pending is not None:
        run.advance()
    run.close()
    return trace


def test_stairs_are_walked_up_and_the_map_follows(browser: Browser, tmp_path: Path):
    trace = climbed(tmp_path)
    graph(tmp_path / "graphs", NAMES[STAIRS])
    setting = Setting(source="builtin", scenes=str(tmp_path))
    opened = opened_traces((trace,), setting, connectivity=tmp_path / "graphs")
    with inspector(opened) as (url, session), visit(browser, url) as seen:
        seen.until_node("/scene/part0")
        for layer, node in (("floor", "/walkable/sheet"), ("viewpoints", "/viewpoints/feet")):
            session.dispatch(c.Layer(name=layer, on=True))
            seen.until_node(node)
        # The head of the stairs lies below the cut of the ground floor here: both ends are joined.
        seen.until_node("/viewpoints/ways")
        last = session.snapshot.story.track.last_step
        seen.page.evaluate("step => window.c2nav.send('go', { step })", last)
        seen.until(f"s.place.step === {last}")
        way_m = [footstep.pose.position_m for footstep in session.snapshot.story.track.footsteps]
        assert storey_m(way_m) == pytest.approx(RISE_M, abs=0.2)
        assert not seen.errors
