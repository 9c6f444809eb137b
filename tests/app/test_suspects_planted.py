"""Suspects in real houses: a wrong answer planted in a flawless episode is named first."""

from __future__ import annotations

import pytest

from app.session.assessing import Assessor
from app.session.snapshot import BAD_M, suspects_of
from app.session.story import story_of
from tests.helpers.planted import decision_of, flawless

FAST = 2
"""Episodes of every run of the tests; the campaign goes through all twenty."""


def campaign() -> list[object]:
    return [
        str(number) if number <= FAST else pytest.param(str(number), marks=pytest.mark.slow)
        for number in range(1, 21)
    ]


@pytest.mark.parametrize("episode", campaign())
def test_a_planted_wrong_answer_stands_first(episode: str):
    whole = flawless(episode)
    planted = whole.mistakes[0]
    recording = whole.with_mistakes(planted)
    header = recording.header
    story = story_of(header, recording.exchanges, pending=None, footer=recording.footer)
    found = Assessor(header, lambda: recording.world.surface).assess(story, ())
    suspects = suspects_of(found)
    wrong = decision_of(recording, planted)
    assert suspects[0].decision == wrong
    assert suspects[0].regret_m == pytest.approx(planted.cost_m, abs=0.05)
    # Whoever asks for the first one over the bar is led there too, or to nothing worse before it.
    bad = [s.decision for s in suspects if (s.regret_m or 0.0) >= BAD_M]
    assert not bad or min(bad) == wrong
