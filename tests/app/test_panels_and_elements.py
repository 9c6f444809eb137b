from __future__ import annotations

import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

from app.gateway.assets import assets
from app.inspector import markup
from app.inspector.palette import ACTIONS
from app.inspector.panels import branches, decision, export, ladder, review, run, sketch
from app.session import commands as c
from app.session.opened import Opening
from app.session.snapshot import Assessment, Snapshot
from app.session.worker import Session
from c2nav_engine.contract.question import Slot
from tests.helpers import stage

WEB = Path(__file__).parents[2] / "web_assets"
EVIL = '<script>alert(1)</script> & "quotes" <img src=x onerror=alert(2)>'


class Tags(HTMLParser):
    """Every tag with its attributes."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))


@pytest.fixture(scope="module")
def evil() -> Snapshot:
    """A recording whose every word tries to break out."""
    run_ = stage.finished_run(6)
    episode = replace(run_.header.episode, instruction=EVIL)
    header = replace(run_.header, episode=episode, legs=(EVIL, EVIL, EVIL), ranker=EVIL, run=EVIL)
    opened = replace(
        stage.opened_recording(),
        open=lambda _: Opening(header, run_.exchanges, run_.footer, source=EVIL),
    )
    return Session(opened).snapshot


BLOCKS = [
    decision._below,
    sketch._block,
    ladder._block,
    lambda snapshot: branches._block(snapshot, branches.Costs().of(snapshot.branches)),
    review._block,
    run._block,
    export._block,
]


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.__module__)
def test_no_word_of_a_recording_becomes_markup(block, evil: Snapshot):
    tags = Tags(block(evil)).found
    assert tags
    assert not {"script", "iframe"} & {tag for tag, _ in tags}
    for _, attributes in tags:
        assert not [name for name in attributes if name.startswith("on")]
        assert (attributes.get("src") or "api/").startswith("api/")


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.__module__)
def test_every_button_carries_a_command_that_the_server_reads(block, evil: Snapshot):
    for tag, attributes in Tags(block(evil)).found:
        if tag == "button" and "data-command" in attributes:
            c.COMMAND.validate_json(attributes["data-command"] or "")


def test_labels_are_calm(evil: Snapshot):
    """No Title Case, no trailing period on short labels."""
    for label, _, _ in ACTIONS:
        assert not label.endswith(".")
        words = re.sub(r"Seeing|Transition|Arriving", "", label).split()[1:]
        assert not [word for word in words if word[0].isupper()], label


def test_the_palette_has_every_kind_of_command_without_arguments():
    named = {type(command) for _, _, command in ACTIONS}
    plain = {
        kind
        for kind in c.Command.__subclasses__() + c.Answering.__subclasses__()
        if all(not field.is_required() for field in kind.model_fields.values())
    }
    by_hand = {c.Answering, c.Go, c.Press, c.Open, c.Hover, c.Place}
    assert plain - by_hand <= named


def test_the_ladder_and_sketch_follow_where_one_stands():
    session = Session(stage.opened_recording())
    whole = session.snapshot
    last = replace(whole, stop=len(whole.story.stops) - 1)
    assert len(sketch.sketches_in_view(last)) > len(sketch.sketches_in_view(whole))


def test_every_suspect_is_listed_and_counted():
    snapshot = Session(stage.opened_recording()).snapshot
    numbers = range(len(snapshot.story.decisions))
    assert len(numbers) > 6
    words = "controller: nothing good offered"
    assessed = {number: Assessment(number, 1.0 + number, words) for number in numbers}
    shown = run._block(replace(snapshot, assessed={snapshot.branch.branch_id: assessed}))
    assert f"{len(numbers)} suspects, worst first" in shown
    listed = [int(number) for number in re.findall(r">decision (\d+)<", shown)]
    assert listed == sorted(numbers, reverse=True)
    assert shown.count(f"</b><small>{words}</small></li>") == len(numbers)


def test_a_transition_shows_its_disagreeing_orders():
    session = Session(stage.opened_recording())
    story = session.snapshot.story
    number = next(d.number for d in story.decisions if d.slot is Slot.TRANSITION)
    here = replace(session.snapshot, stop=story.stop_of_decision(number))
    assert "orders disagree" in decision._below(here)
    assert "✕" in decision._below(here)


def test_markup_escapes_what_it_is_given():
    assert "<script>" not in markup.note(EVIL)
    assert "<script>" not in markup.table([EVIL], [[EVIL]])
    assert "<script>" not in markup.action(EVIL, c.Step(), title=EVIL)


# ---------------------------------------------------------------- what the browser gets


def test_assets_are_a_closed_list():
    found = assets()
    assert {"app.js", "app.css", "boot.js", "rank-strip.js", "timeline-bar.js"} <= found.keys()
    assert not [name for name in found if ".." in name or name.startswith("/")]


def test_modules_import_only_what_lies_beside_them():
    for path in WEB.glob("*.js"):
        for target in re.findall(r'from "(.+?)"|import "(.+?)"', path.read_text(encoding="utf-8")):
            name = "".join(target)
            assert name.startswith("./")
            assert (WEB / name).is_file()


def test_nothing_is_fetched_from_elsewhere():
    for path in [*WEB.glob("*.js"), *WEB.glob("*.css")]:
        text = path.read_text(encoding="utf-8").replace("http://www.w3.org/2000/svg", "")
        assert not re.search(r"https?://", text), path.name


def test_elements_set_no_html_from_data():
    for path in WEB.glob("*.js"):
        text = path.read_text(encoding="utf-8")
        assert not re.search(r"innerHTML|outerHTML|insertAdjacentHTML|eval\(", text), path.name
