"""Turning points: planted wrong answers are named, an unstable ranker is not a turning point."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice

import pytest

from c2nav_engine.contract.question import Slot
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.turning.flips import (
    TURNING,
    UNSTABLE,
    Budget,
    Flip,
    expected_queries,
    flips_of,
    trials_of,
)
from c2nav_engine.experiments.turning.moments import Recording, going_on
from c2nav_engine.experiments.turning.recoverable import last_recoverable
from c2nav_engine.experiments.turning.regrets import WRONG, Regret, regrets_of
from c2nav_engine.experiments.turning.same_ranker import Continuing, continuing
from c2nav_engine.experiments.turning.summary import (
    BY_CONTROLLER,
    NOT_ONE_AWAY,
    UNFINISHED,
    turning_point,
    verdict_of,
)
from c2nav_engine.experiments.turning.table import (
    COLUMNS,
    Row,
    flip_row,
    flips_in,
    goes_on,
    read_table,
    recoverable_row,
    regret_rows,
    write_table,
)
from c2nav_engine.runner.episode_run import run_to_end
from c2nav_engine.runner.opening import SeatFor
from tests.helpers.planted import (
    NOISELESS_SEATS,
    SHORT,
    Flawless,
    Mistake,
    decision_of,
    erring_seats,
    flawless,
    habit,
    spoilt_episodes,
    twice_spoilt_episodes,
    two_needs,
)

ONCE = Budget(repeats=1)
OBSERVER = Continuing("simulated", NOISELESS_SEATS, privileged=True)


def analysed(
    recording: Recording, seats: SeatFor, *, suspects: int = 5, repeats: int = 1
) -> list[Row]:
    """All three parts of one failure, as the command writes them."""
    regrets = regrets_of(recording)
    trials = trials_of(recording, regrets, suspects=suspects)
    flips = flips_of(recording, trials, seats, budget=Budget(repeats))
    return [
        *regret_rows(recording, regrets, trials),
        recoverable_row(recording, last_recoverable(recording)),
        *(flip_row(recording, flip, OBSERVER) for flip in flips),
    ]


def turning_decisions(rows: list[Row]) -> set[object]:
    return {row["decision"] for row in rows if row["verdict"] == TURNING}


@pytest.fixture(scope="module")
def whole() -> Flawless:
    return flawless(SHORT)


@pytest.fixture(scope="module")
def spoilt(whole: Flawless) -> tuple[Recording, int]:
    """The episode with its costliest wrong answer, and that decision's number."""
    recording = whole.with_mistakes(whole.mistakes[0])
    assert not recording.succeeded
    return recording, decision_of(recording, whole.mistakes[0])


@pytest.fixture(scope="module")
def two(whole: Flawless) -> tuple[tuple[Mistake, Mistake], Recording]:
    """The episode with two mistakes, each of which spoils it alone."""
    found = two_needs(whole)
    assert found is not None, f"no two mistakes spoil episode {SHORT}; see tests/helpers/planted.py"
    return found


# ---------------------------------------------------------------- (a) and (b)


def test_regret_names_the_planted_answer_first(spoilt, whole):
    recording, wrong = spoilt
    worst = min(regrets_of(recording), key=lambda regret: regret.weight)
    assert worst.decision == wrong
    assert worst.regret_m == pytest.approx(whole.mistakes[0].cost_m)


def test_the_planted_answer_is_the_last_one_that_could_be_recovered_from(spoilt):
    recording, wrong = spoilt
    found = last_recoverable(recording)
    assert found.decision == wrong
    assert found.tried[wrong]
    assert not any(saved for decision, saved in found.tried.items() if decision > wrong)


def test_going_on_without_a_change_reproduces_the_record(spoilt, whole):
    recording, wrong = spoilt
    again = going_on(recording, wrong, erring_seats(habit(whole.mistakes[0])))
    footer = run_to_end(again)
    assert footer.outcome is recording.footer.outcome
    assert footer.metrics["ne_m"] == recording.footer.metrics["ne_m"]
    assert [e.response for e in again.exchanges] == [e.response for e in recording.exchanges]


def test_a_wrong_answer_is_weighed_by_its_metres_and_by_one_where_it_has_none():
    near = Regret(1, Slot.SEEING, "front", "left", 0.001, WRONG)
    far = Regret(2, Slot.SEEING, "front", "left", 1.2, WRONG)
    early, late = (Regret(n, Slot.GROUND, "here", "ahead", None, WRONG) for n in (3, 4))
    right = Regret(5, Slot.GROUND, "here", "here", None, "")
    ordered = sorted((near, far, early, late, right), key=lambda regret: regret.weight)
    assert [regret.decision for regret in ordered] == [2, 4, 3, 1, 5]


# ---------------------------------------------------------------- (c)


def test_changing_the_planted_answer_alone_succeeds_beside_a_failing_control(spoilt):
    recording, wrong = spoilt
    rows = analysed(recording, NOISELESS_SEATS, suspects=2)
    assert turning_decisions(rows) == {wrong}
    assert verdict_of(rows) == TURNING


def test_two_planted_answers_are_not_one_answer_away(two):
    mistakes, recording = two
    rows = analysed(recording, erring_seats(habit(*mistakes)), suspects=2)
    tried = {row["decision"] for row in rows if row["part"] == "flip"}
    assert tried == {decision_of(recording, mistake) for mistake in mistakes}
    assert verdict_of(rows) == NOT_ONE_AWAY


def test_a_ranker_that_errs_every_other_time_is_unstable(two):
    mistakes, recording = two
    early, late = sorted(mistakes, key=lambda mistake: mistake.election)
    sometimes = erring_seats(habit(early), habit(early, late))
    rows = analysed(recording, sometimes, suspects=2, repeats=2)
    mended = [row["changed"] for row in rows if row["decision"] == decision_of(recording, early)]
    assert 1 in mended  # of two runs after the first mistake is mended, one errs again
    assert verdict_of(rows) == UNSTABLE


def test_a_control_that_succeeds_is_no_turning_point(spoilt):
    # The ranker erred in the recording, and never again: every early change "helps".
    recording, wrong = spoilt
    trials = [
        trial
        for trial in trials_of(recording, regrets_of(recording), suspects=99)
        if trial.decision < wrong
    ]
    flips = list(flips_of(recording, trials[:1], NOISELESS_SEATS, budget=ONCE))
    assert [(flip.control, flip.verdict) for flip in flips] == [(1, UNSTABLE)]


def test_no_further_answer_is_tried_once_the_queries_are_spent(spoilt):
    recording, _ = spoilt
    trials = trials_of(recording, regrets_of(recording), suspects=2)
    assert len(trials) > 1
    for most, tried in ((0, 0), (1, 1)):
        budget = Budget(repeats=1, max_queries=most)
        assert len(list(flips_of(recording, trials, NOISELESS_SEATS, budget=budget))) == tried


def test_a_cancelled_search_keeps_what_it_has_and_goes_on_from_there(spoilt):
    recording, wrong = spoilt
    trials = trials_of(recording, regrets_of(recording), suspects=1)
    cancelled = False
    search = flips_of(recording, trials, NOISELESS_SEATS, budget=ONCE, stopped=lambda: cancelled)
    first = next(search)
    cancelled = True
    assert list(search) == []
    left = [trial for trial in trials if trial.answer != first.answer]
    rest = list(flips_of(recording, left, NOISELESS_SEATS, budget=ONCE))
    assert {flip.answer for flip in (first, *rest)} == {trial.answer for trial in trials}
    assert {flip.decision for flip in (first, *rest)} == {wrong}


def test_what_it_will_ask_is_known_before(spoilt):
    recording, wrong = spoilt
    trials = trials_of(recording, regrets_of(recording), suspects=1)
    after = [e for e in recording.questions if (e.decision or 0) > wrong]
    asked = sum(len(e.ranked.queries) for e in after if e.ranked)
    # Each answer three times, and the control three times.
    assert expected_queries(recording, trials, repeats=3) == 3 * (len(trials) + 1) * asked
    assert expected_queries(recording, [], repeats=3) == 0


def test_a_flip_counts_only_beside_its_control():
    base = Flip(3, Slot.SEEING, "left", changed=3, control=0, repeats=3, queries=9)
    assert base.verdict == TURNING
    assert replace(base, control=1).verdict == UNSTABLE
    assert replace(base, changed=2).verdict == UNSTABLE
    assert replace(base, changed=0).verdict == "no success"


# ---------------------------------------------------------------- the table


def test_the_table_is_read_back_with_its_flips(spoilt, tmp_path):
    recording, wrong = spoilt
    flip = Flip(wrong, Slot.SEEING, "front", changed=1, control=0, repeats=1, queries=4)
    rows = [flip_row(recording, flip, OBSERVER)]
    write_table(rows, tmp_path / "turning.parquet")
    assert read_table(tmp_path / "turning.parquet") == rows
    assert flips_in(rows, recording.trace_sha256) == [flip]
    assert flips_in(rows, recording.trace_sha256, goes_on=goes_on(OBSERVER), repeats=1) == [flip]
    assert flips_in(rows, recording.trace_sha256, repeats=2) == []
    assert flips_in(rows, "another trace") == []


def test_another_table_is_told_from_one_of_turning_points(tmp_path):
    (tmp_path / "notes.parquet").write_text("no table at all")
    with pytest.raises(UsageError, match="name another file"):
        read_table(tmp_path / "notes.parquet")


def row(**facts: str | int) -> Row:
    """A row of one trace, blank but for some facts."""
    return {name: facts.get(name) for name in COLUMNS}


def test_an_episode_with_answers_left_to_try_has_no_verdict_yet():
    rows = [
        row(part="regret", decision=3, words="wrong", to_try=2),
        row(part="recoverable", decision=3),
        row(part="flip", decision=3, answer="left", verdict="no success"),
    ]
    assert verdict_of(rows) == UNFINISHED
    rows.append(row(part="flip", decision=3, answer="front", verdict="no success"))
    assert verdict_of(rows) == NOT_ONE_AWAY


def test_a_failure_that_the_truth_could_not_prevent_is_the_controllers():
    wrong = row(part="regret", decision=3, words="wrong", to_try=0)
    assert verdict_of([wrong, row(part="recoverable")]) == BY_CONTROLLER
    assert verdict_of([wrong, row(part="recoverable", decision=3)]) == NOT_ONE_AWAY
    vetoed = row(part="regret", decision=3, words="vetoed", to_try=0)
    assert verdict_of([vetoed, row(part="recoverable", decision=3)]) == BY_CONTROLLER
    assert verdict_of([vetoed, wrong, row(part="recoverable", decision=3)]) == NOT_ONE_AWAY


def test_a_person_cannot_go_on(spoilt):
    recording, _ = spoilt
    assert continuing(recording.header).privileged
    with pytest.raises(UsageError, match="--ranker"):
        continuing(replace(recording.header, ranker="human"))


# ---------------------------------------------------------------- the campaign


@pytest.mark.slow
def test_one_planted_answer_is_named_in_twenty_of_twenty():
    named: list[str] = []
    for whole, recording, wrong in islice(spoilt_episodes(), 20):
        assert min(regrets_of(recording), key=lambda regret: regret.weight).decision == wrong
        rows = analysed(recording, erring_seats(habit(whole.mistakes[0])), suspects=3)
        point = turning_point(rows)
        if point is not None and point["decision"] == wrong:
            named.append(whole.episode_id)
    assert len(named) == 20, f"named only in {named}"


@pytest.mark.slow
def test_two_planted_answers_are_not_one_answer_away_in_twenty_of_twenty():
    not_away: list[str] = []
    for whole, (mistakes, recording) in islice(twice_spoilt_episodes(), 20):
        rows = analysed(recording, erring_seats(habit(*mistakes)), suspects=3)
        if verdict_of(rows) == NOT_ONE_AWAY:
            not_away.append(whole.episode_id)
    assert len(not_away) == 20, f"so only in {not_away}"
