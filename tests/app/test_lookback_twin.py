from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.inspector.panels.lookback import _pictures, side_by_side
from app.inspector.scene.thumbnails import pixels
from app.session.decisions import Decision
from app.session.snapshot import Snapshot
from app.session.worker import Session
from c2nav_engine.contract.question import Slot
from tests.helpers import stage


def at_lookback() -> Snapshot:
    """The play, standing at a look-back question instead of its first election."""
    plain = Session(stage.opened_recording(cycles=2)).snapshot
    facts = stage.facts_of(Slot.LOOKBACK, 0, stage.EPISODE.start, leg=2)
    asked = stage.contrast_of(Slot.LOOKBACK, facts, ("now", "back"), seed=500)
    decision = Decision(0, 0, 0, asked.facts, asked.question, pending=True)
    story = replace(plain.story, decisions=(decision, *plain.story.decisions[1:]))
    return replace(plain, story=story, stop=0)


def test_the_twin_shows_both_frames_uncropped_in_the_order_of_their_letters():
    pictures = _pictures(at_lookback())
    assert [letter for letter, _ in pictures] == ["A", "B"]
    image = side_by_side(pictures)
    first, second = (pixels(picture) for _, picture in pictures)
    rows, columns = first.shape[:2]
    np.testing.assert_array_equal(image[-rows:, :columns], first)
    np.testing.assert_array_equal(image[-rows:, -second.shape[1] :], second)
    assert (image[:-rows] != 255).any()  # the letters


def test_before_the_first_look_back_there_is_no_twin():
    assert _pictures(Session(stage.opened_recording(cycles=2)).snapshot) == []
