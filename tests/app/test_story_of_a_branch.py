from __future__ import annotations

import pytest

from app.session.branches import cost_of, fork_estimate
from app.session.story import Story, story_of
from tests.helpers.stage import finished_run, live_run


@pytest.fixture(scope="module")
def story() -> Story:
    run = finished_run()
    return story_of(run.header, run.exchanges, pending=None, footer=run.footer)


def test_stops_go_forward_by_at_most_one_step_and_one_decision(story: Story):
    for before, after in zip(story.stops, story.stops[1:], strict=False):
        assert after.step - before.step in (0, 1)
        assert after.decision - before.decision in (0, 1)
        assert (before.step, before.decision) != (after.step, after.decision)


def test_every_step_and_every_decision_has_a_stop(story: Story):
    assert {stop.step for stop in story.stops} == set(range(story.track.last_step + 1))
    at = [stop.decision for stop in story.stops if stop.at_decision]
    assert at == list(range(len(story.decisions)))


def test_a_decision_is_found_where_it_was_taken(story: Story):
    for decision in story.decisions:
        stop = story.stops[story.stop_of_decision(decision.number)]
        assert (stop.decision, stop.step) == (decision.number, decision.step)


def test_a_live_run_tells_the_same_story_as_its_recording():
    live, done = live_run(), finished_run()
    while live.pending is not None:
        live.advance()
    read = [
        story_of(run.header, run.exchanges, pending=run.pending, footer=run.footer)
        for run in (live, done)
    ]
    assert read[0] == read[1]


def test_letters_are_those_of_the_recorded_presentation(story: Story):
    for decision in story.decisions:
        if decision.ranked is not None:
            labels = decision.ranked.queries[0].prompt.labels
            assert decision.letters == {key: label for label, key in labels}


def test_a_fork_is_expected_to_cost_what_the_rest_cost(story: Story):
    half = len(story.decisions) // 2
    spent = cost_of(story.decisions[: half + 1])
    expected = fork_estimate(story.decisions, half)
    whole = cost_of(story.decisions)
    assert spent.queries + expected.queries == whole.queries
    assert spent.decisions + expected.decisions == whole.decisions


def test_a_glimpse_is_the_newest_at_or_before_a_step(story: Story):
    for step in range(story.track.last_step + 1):
        glimpse = story.track.glimpse_at(step)
        assert glimpse is not None
        later = [g.step for g in story.track.glimpses if glimpse.step < g.step <= step]
        assert glimpse.step <= step
        assert not later
