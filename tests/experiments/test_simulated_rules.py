from __future__ import annotations

import math
from dataclasses import replace

import pytest

from c2nav_engine.contract.outcome import Answered, Cardinal, Invalid, Key, Ordering
from c2nav_engine.contract.prompt import Prompt
from c2nav_engine.contract.question import Form, Orders, Question, Slot
from c2nav_engine.contract.render import render
from c2nav_engine.errors import UsageError
from c2nav_engine.experiments.simulated import SimulatedObserver, SlotTruth
from c2nav_engine.experiments.simulated_noise import normal, uniform
from c2nav_engine.experiments.simulated_options import SimulatedOptions
from c2nav_engine.rankers.wrapper import AskingRanker
from tests.helpers.questions import every_question, question

HEADINGS = {"left": math.pi / 4, "front": 0.0, "right": -math.pi / 4} | {
    f"sector{k}": math.remainder(math.radians(60 * k + 15), math.tau) for k in range(6)
}


class Known:
    def __init__(self, target: Key | None, *, step: int = 3, queries: int = 0) -> None:
        self.truth = SlotTruth(target, step, queries, HEADINGS)

    def of(self, question: Question) -> SlotTruth:
        return self.truth


def observer(
    target: Key | None, *, step: int = 3, queries: int = 0, **options: float
) -> SimulatedObserver:
    kind = SimulatedOptions.from_options({k: str(v).lower() for k, v in options.items()})
    known = Known(target, step=step, queries=queries)
    return SimulatedObserver(kind, truth=known, seed=5, episode_id="12")


def outcome(judge: SimulatedObserver, prompt: Prompt) -> Answered:
    found = judge.answer(prompt).outcome
    assert found is not None
    return found


def degrees(judge: SimulatedObserver, asked: Question) -> float:
    found = outcome(judge, render(asked))
    assert isinstance(found, Cardinal)
    return found.value


def test_noise_belongs_to_its_name_alone() -> None:
    assert normal("a", 1) == normal("a", 1) != normal("a", 2)
    assert normal("a", 11) != normal("a1", 1)
    assert 0.0 < uniform("a") < 1.0


@pytest.mark.parametrize("asked", every_question(), ids=lambda q: f"{q.slot}-{q.form}")
def test_a_perfect_observer_is_right_in_every_slot_and_form(asked: Question) -> None:
    target = asked.keys[0]
    ranked = AskingRanker(observer(target, d_prime=200.0), privileged=True).rank(asked)
    assert ranked.privileged
    if asked.form is Form.DEGREES:
        assert isinstance(ranked.outcome, Cardinal)
        assert ranked.outcome.value == pytest.approx(math.degrees(HEADINGS[target]), abs=1.0)
    elif asked.form is Form.PROGRESS:
        assert ranked.outcome == Cardinal(0.0)
    elif asked.form is Form.YES_NO:
        assert ranked.outcome == Cardinal(1.0)
    else:
        assert isinstance(ranked.outcome, Ordering)
        assert ranked.outcome.winner == target


@pytest.mark.parametrize("asked", every_question(), ids=lambda q: f"{q.slot}-{q.form}")
@pytest.mark.parametrize(
    "options",
    [SimulatedOptions(lapse=1.0), SimulatedOptions(d_prime=0.0), SimulatedOptions(sigma_c=9.0)],
)
def test_every_answer_is_one_that_the_form_allows(
    asked: Question, options: SimulatedOptions
) -> None:
    for step in range(20):
        for target in (asked.keys[-1], None):
            known = Known(target, step=step)
            judge = SimulatedObserver(options, truth=known, seed=5, episode_id="12")
            ranked = AskingRanker(judge).rank(asked)
            assert not isinstance(ranked.outcome, Invalid)


def test_answers_do_not_depend_on_what_was_asked_before() -> None:
    judge = observer("left", d_prime=0.5)
    first = outcome(judge, render(question(Slot.SEEING)))
    for asked in every_question():
        judge.answer(render(asked))
    assert outcome(judge, render(question(Slot.SEEING))) == first


def test_presentation_changes_labels_not_evidence() -> None:
    judge = observer(None)
    assert outcome(judge, render(question(Slot.SEEING, seed=1))) == outcome(
        judge, render(question(Slot.SEEING, seed=2))
    )


def test_variants_that_differ_in_form_see_the_same_noise() -> None:
    # A ranking and a direct action over the same fan: left against right agrees where the front
    # is out of the question.
    for step in range(40):
        keys = ("left", "front", "right")
        ranking = outcome(observer("left", step=step), render(question(Slot.SEEING, keys=keys)))
        action = outcome(observer("left", step=step), render(question(Slot.DIRECT)))
        assert isinstance(ranking, Ordering) and isinstance(action, Ordering)
        if action.winner != "forward":
            sides = [key for key in ranking.keys if key != "front"]
            assert action.winner == sides[0]


def test_a_heading_is_off_by_the_noise_of_its_target() -> None:
    asked = question(Slot.SEEING, form=Form.DEGREES)
    z = normal(5, "12", "seeing", 3, "left", 0)
    expected = max(-90.0, min(90.0, 45.0 + 45.0 / 1.5 * z))
    assert degrees(observer("left"), asked) == pytest.approx(expected)
    biased = degrees(observer("left", beta=3.0), asked)
    assert biased == pytest.approx(expected)


def test_a_glance_heading_wraps_about_the_true_sector() -> None:
    asked = question(Slot.GLANCE, form=Form.DEGREES)
    values = [degrees(observer("sector3", step=s, d_prime=0.3), asked) for s in range(60)]
    assert all(-180.0 <= value <= 180.0 for value in values)
    assert min(values) < -90.0 and max(values) > 90.0


def test_without_sensitivity_headings_say_nothing() -> None:
    fan = question(Slot.SEEING, form=Form.DEGREES)
    assert {abs(degrees(observer("left", step=s, d_prime=0.0), fan)) for s in range(20)} == {90.0}
    ring = question(Slot.GLANCE, form=Form.DEGREES)
    values = [degrees(observer("sector1", step=s, d_prime=0.0), ring) for s in range(200)]
    assert len({math.floor(value / 60.0) for value in values}) == 6


def test_without_a_target_the_heading_follows_what_looks_best() -> None:
    asked = question(Slot.SEEING, form=Form.DEGREES)
    ranking = outcome(observer(None), render(question(Slot.SEEING)))
    assert isinstance(ranking, Ordering)
    best = ranking.winner
    z = normal(5, "12", "seeing", 3, best, 0)
    expected = math.degrees(HEADINGS[best]) + 45.0 / 1.5 * z
    assert degrees(observer(None), asked) == pytest.approx(max(-90.0, min(90.0, expected)))


def test_orders_share_noise_only_by_option() -> None:
    asked = question(Slot.SEEING, orders=Orders.CYCLIC)
    shown = [render(asked, order) for order in range(3)]
    shared = {outcome(observer(None, step=1, shared_orders=True), one) for one in shown}
    assert len(shared) == 1
    apart = [{outcome(observer(None, step=step), one) for one in shown} for step in range(6)]
    assert any(len(outcomes) > 1 for outcomes in apart)


def test_an_invalid_answer_is_drawn_again_for_the_repair() -> None:
    asked = question(Slot.SEEING)
    first = [outcome(observer(None, queries=q, invalid_rate=0.5), render(asked)) for q in range(40)]
    again = [
        outcome(observer(None, queries=q, invalid_rate=0.5), render(asked, repair=1))
        for q in range(40)
    ]
    bad_first = [isinstance(found, Invalid) for found in first]
    bad_again = [isinstance(found, Invalid) for found in again]
    assert 8 < sum(bad_first) < 32
    assert bad_first != bad_again
    # What can be read is the same evidence, whichever attempt it was.
    assert {found for found in first + again if isinstance(found, Ordering)} == {
        outcome(observer(None), render(asked))
    }


def test_the_criterion_belongs_to_the_episode() -> None:
    kind, known = SimulatedOptions(sigma_c=5.0), Known("here")
    asked = render(question(Slot.GROUND, form=Form.YES_NO))
    verdicts = {
        SimulatedObserver(kind, truth=known, seed=5, episode_id=str(e)).answer(asked).outcome
        for e in range(20)
    }
    assert verdicts == {Cardinal(0.0), Cardinal(1.0)}


def test_options_come_as_words_and_go_to_the_record() -> None:
    kind = SimulatedOptions(d_prime=1.0, beta=-0.5, lapse=0.1, shared_orders=True)
    assert SimulatedOptions.from_options(kind.as_options()) == kind
    assert SimulatedOptions.from_options({}) == SimulatedOptions()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"d_prime": "high"}, "expected a value for d_prime"),
        ({"d_prime": "-1"}, "expected d_prime of the simulated observer as 0 or more, came -1.0"),
        ({"sigma_c": "inf"}, "expected a value for sigma_c"),
        ({"lapse": "1.5"}, "within 0 … 1, came 1.5"),
        ({"invalid_rate": "nan"}, "expected a value for invalid_rate"),
        ({"dprime": "1"}, "has no option dprime"),
    ],
)
def test_impossible_observers_are_refused(options: dict[str, str], words: str) -> None:
    with pytest.raises(UsageError, match=words):
        SimulatedOptions.from_options(options)


def test_the_noise_of_a_step_is_its_own() -> None:
    asked = render(question(Slot.GLANCE))
    answers = {outcome(observer(None, step=step), asked) for step in range(10)}
    assert len(answers) > 1
    assert replace(Known("left").truth, step=4) != Known("left").truth
