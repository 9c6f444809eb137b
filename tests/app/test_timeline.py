from __future__ import annotations

from dataclasses import replace

import pytest

from app.session.draft import Draft
from app.session.snapshot import Assessment, Judgement, PlaceAnswer, Snapshot
from app.session.timeline import Timelines, timeline_of
from app.session.worker import Session
from tests.helpers import stage


@pytest.fixture(scope="module")
def snapshot() -> Snapshot:
    return Session(stage.opened_recording(cycles=5)).snapshot


def changes(snapshot: Snapshot) -> dict[str, Snapshot]:
    """Snapshots whose timeline is another one, by what has changed in them."""
    branch = snapshot.branch.branch_id
    judged = {branch: {(snapshot.who, 1): Judgement(verdict="wrong")}}
    regret = {branch: {1: Assessment(1, regret_m=2.0)}}
    fork = Session(stage.opened_recording(cycles=3)).snapshot
    return {
        "story": fork,
        "parent": replace(snapshot, parent=fork.story),
        "reviews": replace(snapshot, reviews=judged),
        "who": replace(snapshot, reviews=judged, who="somebody else"),
        "place": replace(snapshot, place=PlaceAnswer((0.0, 0.0, 0.0), (), {}, "recorded depth")),
        "assessed": replace(snapshot, assessed=regret),
    }


def test_a_timeline_is_kept_while_only_the_place_in_view_changes(snapshot: Snapshot):
    timelines = Timelines()
    first = timelines.of(snapshot)
    assert first == timeline_of(snapshot)
    assert timelines.of(replace(snapshot, stop=3, draft=Draft(), version=9)) is first


@pytest.mark.parametrize("what", ["story", "parent", "reviews", "who", "place", "assessed"])
def test_a_kept_timeline_is_always_the_right_one(snapshot: Snapshot, what: str):
    timelines = Timelines()
    timelines.of(snapshot)
    for seen in (changes(snapshot)[what], snapshot, *changes(snapshot).values()):
        assert timelines.of(seen) == timeline_of(seen)
