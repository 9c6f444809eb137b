from __future__ import annotations

import base64
import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from app.exports.family import family_of
from app.exports.html import HtmlOptions, Setting, export_html
from app.exports.licence import LicenceRule
from app.figures.plan import Plan
from app.session.snapshot import Assessment
from c2nav_engine.errors import UsageError
from c2nav_engine.runner.recorded import Trace, read_trace
from c2nav_engine.traces import TraceFile
from c2nav_engine.traces.exports import export_redacted
from tests.helpers.exchanges import write_fake
from tests.helpers.plays import FORK_SHA, ROOT_SHA, fork, recording, story

SQUARE = Plan(floor=(((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)),))
WORLD = "<html><head></head><body>world</body></html>"


@pytest.fixture(scope="module")
def fake(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("fake") / "a.mcap"
    write_fake(path, cycles=8, side_px=16)
    return path


def blocks(page: Path) -> dict[str, Any]:
    text = page.read_text("utf-8")
    block = re.compile(r'<script type="application/json" id="x-(\w+)">(.*?)</script>', re.DOTALL)
    return {name: json.loads(body) for name, body in block.findall(text)}


def exported(out: Path, *traces: Trace, **options: Any) -> dict[str, Any]:
    setting = options.pop("setting", Setting(plan=SQUARE, world=WORLD))
    export_html(traces, out, options=HtmlOptions(**options), setting=setting)
    return blocks(out)


# ---------------------------------------------------------------- what is in it


def test_every_decision_every_step_and_every_answer_is_told(fake: Path, tmp_path: Path):
    trace = read_trace(fake)
    told = story(trace)
    branch = exported(tmp_path / "a.html", trace)["tale"]["branches"][0]
    assert [d["decision"]["number"] for d in branch["decisions"]] == [
        d.number for d in told.decisions
    ]
    assert len(branch["track"]) == told.track.last_step + 1
    assert len(branch["stops"]) == len(told.stops)
    assert len(branch["ladders"]) == len(told.ladders)
    for shown, decision in zip(branch["decisions"], told.decisions, strict=True):
        queries = decision.ranked.queries if decision.ranked else ()
        assert [answer["raw"] for answer in shown["answers"]] == [q.reply.text for q in queries]
        assert [a["order"] for a in shown["answers"]] == [q.prompt.order for q in queries]


def test_the_question_stands_as_it_was_sent(fake: Path, tmp_path: Path):
    trace = read_trace(fake)
    branch = exported(tmp_path / "a.html", trace)["tale"]["branches"][0]
    asked = [d for d in story(trace).decisions if d.ranked]
    for decision in asked:
        assert decision.ranked is not None
        parts = decision.ranked.queries[0].prompt.parts
        expected = [part if isinstance(part, str) else {"sha": part.sha256} for part in parts]
        assert branch["decisions"][decision.number]["question"] == expected


def test_pictures_are_there_once_and_byte_for_byte(fake: Path, tmp_path: Path):
    trace = read_trace(fake)
    page = exported(tmp_path / "a.html", trace)
    named = set(re.findall(r'"sha": "([0-9a-f]{64})"', json.dumps(page["tale"])))
    assert set(page["pictures"]) == named
    sent = {
        part.sha256: part.jpeg
        for decision in story(trace).decisions
        for query in (decision.ranked.queries if decision.ranked else ())
        for part in query.prompt.parts
        if not isinstance(part, str)
    }
    assert sent
    for sha256, jpeg in sent.items():
        assert base64.b64decode(page["pictures"][sha256]) == jpeg


def test_the_same_runs_give_the_same_page(fake: Path, tmp_path: Path):
    trace = read_trace(fake)
    for name in ("a", "b"):
        exported(tmp_path / f"{name}.html", trace)
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()


def test_suspects_are_told_worst_first(tmp_path: Path):
    assessed = {
        ROOT_SHA: {
            1: Assessment(1, 0.4, "", None),
            2: Assessment(2, 2.5, "", None),
            3: Assessment(3, 0.01, "", None),
        }
    }
    setting = Setting(assessed=assessed)
    branch = exported(tmp_path / "a.html", recording(), setting=setting)["tale"]["branches"][0]
    assert [(s["decision"], s["words"]) for s in branch["suspects"]] == [
        (2, "+2.5 m"),
        (1, "+0.4 m"),
    ]


# ---------------------------------------------------------------- one closed file


def test_words_of_a_run_cannot_become_markup(tmp_path: Path):
    nasty = 'Go </script><script>alert(1)</script> "past" the <b>door</b>\u2028 & stop.'
    trace = recording()
    episode = replace(trace.header.episode, instruction=nasty)
    trace = replace(
        trace, header=replace(trace.header, episode=episode, legs=(nasty, *trace.header.legs[1:]))
    )
    out = tmp_path / "a.html"
    page = exported(out, trace)
    assert page["tale"]["branches"][0]["episode"]["instruction"] == nasty
    assert "alert(1)</script>" not in out.read_text("utf-8")


def test_names_in_braces_are_no_template(tmp_path: Path):
    trace = recording()
    episode = replace(trace.header.episode, instruction="Walk to {{pictures}} and stop.")
    page = exported(
        tmp_path / "a.html", replace(trace, header=replace(trace.header, episode=episode))
    )
    assert page["tale"]["branches"][0]["episode"]["instruction"] == "Walk to {{pictures}} and stop."


def test_every_module_finds_its_siblings_inside_the_page(tmp_path: Path):
    out = tmp_path / "a.html"
    exported(out, recording())
    found = re.search(r'<script type="importmap">(.*?)</script>', out.read_text("utf-8"), re.DOTALL)
    assert found is not None
    imports: dict[str, str] = json.loads(found[1])["imports"]
    for name, url in imports.items():
        source = base64.b64decode(url.removeprefix("data:text/javascript;base64,")).decode()
        wanted = re.findall(r"""(?:from|import)\s+["']([^"']+)["']""", source)
        assert set(wanted) <= set(imports), name


def test_nothing_in_the_page_points_outside(tmp_path: Path):
    out = tmp_path / "a.html"
    exported(out, recording())
    text = out.read_text("utf-8")
    assert "default-src 'none'" in text
    assert not re.search(r"""(?:src|href)\s*=\s*["'](?!data:)[^"']*//""", text)


# ---------------------------------------------------------------- licences


@pytest.mark.parametrize(
    ("scene", "licence", "licensed"),
    [
        ("builtin/house1", "CC0-1.0", False),
        ("house/mine.glb", "", False),
        ("house/mine.glb", "CC-BY-4.0", False),
        ("house/mine.glb", "CC BY-SA 4.0 (someone)", False),
        ("house/mine.glb", "MIT", False),
        ("house/mine.glb", "CC-BY-NC-4.0", True),
        ("house/mine.glb", "CC BY-ND 4.0", True),
        ("house/mine.glb", "All rights reserved, MIT campus", True),
        ("house/mine.glb", "Matterport3D terms of use", True),
        ("house/mine.glb", "ask the author", True),
        ("mp3d/17DRP5sb8fy/17DRP5sb8fy.glb", "", True),
        ("mp3d/17DRP5sb8fy/17DRP5sb8fy.glb", "CC0", True),
        ("hm3d/x.glb", "", True),
        ("mp3dish/x.glb", "", False),
    ],
)
def test_when_a_scene_counts_as_licensed(scene: str, licence: str, licensed: bool):
    header = recording().header
    episode = replace(header.episode, scene_id=scene)
    assert (
        LicenceRule().licensed(replace(header, episode=episode, scene_licence=licence)) is licensed
    )


def licensed_trace() -> Trace:
    trace = recording()
    episode = replace(trace.header.episode, scene_id="mp3d/scan/scan.glb")
    header = replace(trace.header, episode=episode, scene_licence="Matterport terms of use")
    return replace(trace, header=header)


def test_nothing_drawn_from_a_licensed_scene_leaves_by_default(tmp_path: Path):
    page = exported(tmp_path / "a.html", licensed_trace())
    assert page["pictures"] == {}
    assert page["world"] == ""
    assert page["tale"]["map"]["floor"] == []
    assert page["tale"]["licence"] == "Matterport terms of use"
    assert "Matterport terms of use" in page["tale"]["left_out"][0]
    assert page["tale"]["branches"][0]["decisions"]


def test_licensed_pictures_come_along_when_asked_for(tmp_path: Path):
    page = exported(tmp_path / "a.html", licensed_trace(), licensed_pictures=True)
    assert page["pictures"]
    assert page["world"] == WORLD
    assert page["tale"]["left_out"] == []
    assert page["tale"]["licence"] == "Matterport terms of use"


@pytest.mark.parametrize(
    ("options", "setting", "words"),
    [
        ({"no_scene": True}, Setting(), "left out on request"),
        ({}, Setting(why_not="no folder of scenes"), "no folder of scenes"),
    ],
)
def test_a_page_says_why_it_has_no_3d_view(
    options: dict[str, bool], setting: Setting, words: str, tmp_path: Path
):
    page = exported(tmp_path / "a.html", recording(), setting=setting, **options)
    assert words in " ".join(page["tale"]["left_out"])


def test_a_trace_without_pictures_says_so(fake: Path, tmp_path: Path):
    with TraceFile(fake) as file:
        export_redacted(file, tmp_path / "r.mcap")
    page = exported(tmp_path / "a.html", read_trace(tmp_path / "r.mcap"))
    assert page["pictures"] == {}
    assert "digests only" in " ".join(page["tale"]["left_out"])


# ---------------------------------------------------------------- families


@pytest.mark.parametrize("turned", [False, True])
def test_forks_stand_after_what_they_left(turned: bool):
    traces = [recording(), fork()]
    members = family_of(traces[::-1] if turned else traces)
    assert [m.branch.trace_sha256 for m in members] == [ROOT_SHA, FORK_SHA]
    assert [m.branch.parent for m in members] == ["", "b0"]


def test_siblings_without_their_parent_are_a_family():
    other = replace(fork(), sha256="c" * 64)
    members = family_of([fork(), other])
    assert {m.branch.trace_sha256 for m in members} == {FORK_SHA, "c" * 64}


def test_strangers_are_refused_by_name():
    with pytest.raises(UsageError, match=r"one family.*bbbb\.mcap"):
        family_of([recording(), replace(fork(), header=recording().header)])


def test_a_fork_carries_its_parent_as_a_ghost(tmp_path: Path):
    branches = exported(tmp_path / "a.html", recording(), fork())["tale"]["branches"]
    assert branches[0]["timeline"]["ghost"] is None
    assert branches[1]["timeline"]["ghost"]["curve"] == branches[0]["timeline"]["curve"]
