"""No word of ours holds a coordinate, a distance, a degree or a percentage, in any episode."""

from __future__ import annotations

import pytest

from c2nav_engine.contract.lint import lint
from c2nav_engine.contract.presentation import presentations
from c2nav_engine.contract.question import Form
from c2nav_engine.contract.render import render
from c2nav_engine.contract.route import parse_english
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.world.builtin import builtin_source
from tests.helpers.open_floor import Floor, drive, each, task

INVERTED = {Form.DEGREES, Form.PROGRESS, Form.YES_NO}
ANSWERS = {
    "seeing": ["left", "front", "right", "front"],
    "direct": ["forward", "left", "right"],
    "transition": ["next", "next", "stay"],
    "ground": ["here", "ahead", "ahead", "here"],
    "journey": ["missing", "covered"],
    "lookback": ["back"],
    "glance": ["sector2"],
}


def faults(ask: Ask) -> list[str]:
    """Of every presentation, and of the repair attempt, whose added line is always the same."""
    orders = range(len(presentations(ask.question)))
    prompts = [*(render(ask.question, order) for order in orders), render(ask.question, repair=1)]
    return [fault for prompt in prompts for fault in lint(prompt)]


@pytest.mark.parametrize(("variant", "every"), [("full", 1), ("no-seeing", 10), ("no-sketch", 10)])
def test_every_built_in_episode_is_asked_in_nonmetric_words(variant, every):
    for episode in builtin_source().episodes[::every]:
        legs = parse_english(episode.instruction).legs
        blocked = frozenset(range(11, 13))
        floor = Floor(collide_at=blocked)
        tale = drive(task(variant, legs=legs), each(**ANSWERS), floor, asks=14)
        asked = [ask for ask, _ in tale.answers]
        assert len(asked) >= 10
        assert [fault for ask in asked for fault in faults(ask)] == []


def test_the_lint_can_fail():
    tale = drive(task("spatial-cardinal"), each(), asks=1)
    (ask, _) = tale.answers[0]
    assert ask.question.form in INVERTED
    assert "+45 degrees" in "".join(p for p in render(ask.question).parts if isinstance(p, str))
