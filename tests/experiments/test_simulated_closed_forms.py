"""The observer against every closed form of signal detection, by Monte Carlo.

Each estimate comes from N keyed draws; tolerances are four standard errors or more.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product

import numpy as np
import pytest
from jaxtyping import config
from scipy.integrate import quad
from scipy.stats import norm

from c2nav_engine.contract.aggregate import agreement
from c2nav_engine.contract.outcome import Abstention, Answered, Cardinal, Key, Ordering
from c2nav_engine.contract.prompt import Prompt
from c2nav_engine.contract.question import Form, Question, Slot
from c2nav_engine.experiments.simulated import SimulatedObserver, SlotTruth
from c2nav_engine.experiments.simulated_options import SimulatedOptions
from tests.helpers.questions import question

N = 6000
TOLERANCE = 0.026


@pytest.fixture(autouse=True, scope="module")
def unchecked_types() -> Iterator[None]:
    """Tens of thousands of answers: their types are checked in the other tests."""
    config.update("jaxtyping_disable", True)
    yield
    config.update("jaxtyping_disable", False)


class AtStep:
    """One and the same truth at every step; `step` moves on."""

    def __init__(self, target: Key | None) -> None:
        self.target = target
        self.step = 0

    def of(self, question: Question) -> SlotTruth:
        headings_rad = {"left": np.pi / 4, "front": 0.0, "right": -np.pi / 4}
        return SlotTruth(self.target, self.step, 0, headings_rad)


def prompt(asked: Question, keys: tuple[Key, ...], order: int = 0) -> Prompt:
    labels = tuple(zip("ABCDEF", keys, strict=False))
    return Prompt(asked, (), labels, asked.form, 0, order, "", "")


def answers(
    asked: Question, keys: tuple[Key, ...], target: Key | None, options: SimulatedOptions
) -> list[Answered]:
    return [outcomes[0] for outcomes in answers_to([prompt(asked, keys)], target, options)]


def answers_to(
    shown: list[Prompt], target: Key | None, options: SimulatedOptions
) -> Iterator[list[Answered]]:
    """The outcomes of these presentations at each of N steps."""
    truth = AtStep(target)
    judge = SimulatedObserver(options, truth=truth, seed=1, episode_id="7")
    for truth.step in range(N):
        replies = [judge.answer(told) for told in shown]
        yield [reply.outcome for reply in replies if reply.outcome is not None]


def share(outcomes: list[Answered], holds: Callable[[Answered], bool]) -> float:
    return float(np.mean([holds(outcome) for outcome in outcomes]))


def won_by(key: Key) -> Callable[[Answered], bool]:
    return lambda outcome: isinstance(outcome, Ordering) and outcome.winner == key


def value_of(outcome: Answered) -> float:
    assert isinstance(outcome, Cardinal)
    return outcome.value


PAIR = ("stay", "next")


@pytest.mark.parametrize(("d_prime", "expected"), [(0.0, 0.5), (1.0, 0.7602), (2.0, 0.9214)])
def test_a_comparison_of_two(d_prime: float, expected: float) -> None:
    assert norm.cdf(d_prime / np.sqrt(2.0)) == pytest.approx(expected, abs=5e-5)
    found = answers(question(Slot.TRANSITION), PAIR, "next", SimulatedOptions(d_prime))
    assert share(found, won_by("next")) == pytest.approx(expected, abs=TOLERANCE)


@pytest.mark.parametrize(
    ("d_prime", "options", "expected"),
    [(1.0, 3, 0.6337), (1.0, 4, 0.5520), (1.0, 6, 0.4494), (1.5, 3, 0.766)],
)
def test_a_comparison_of_many(d_prime: float, options: int, expected: float) -> None:
    def density(x: float) -> float:
        return float(norm.pdf(x - d_prime) * norm.cdf(x) ** (options - 1))

    assert quad(density, -8.0, 10.0)[0] == pytest.approx(expected, abs=6e-4)
    keys = tuple(f"sector{index}" for index in range(options))
    asked = question(Slot.GLANCE, keys=keys)
    found = answers(asked, keys, "sector1", SimulatedOptions(d_prime))
    assert share(found, won_by("sector1")) == pytest.approx(expected, abs=TOLERANCE)


def test_an_absolute_verdict_at_its_best_criterion() -> None:
    asked, keys = question(Slot.GROUND, form=Form.YES_NO), ("here", "ahead")
    options = SimulatedOptions(d_prime=1.0)
    yes = share(answers(asked, keys, "here", options), lambda o: value_of(o) == 1.0)
    false_yes = share(answers(asked, keys, "ahead", options), lambda o: value_of(o) == 1.0)
    assert norm.cdf(0.5) == pytest.approx(0.6915, abs=5e-5)
    assert yes == pytest.approx(0.6915, abs=TOLERANCE)
    assert 1.0 - false_yes == pytest.approx(0.6915, abs=TOLERANCE)


def test_a_criterion_that_varies_between_episodes_costs_the_absolute_verdict() -> None:
    # Over episodes the evidence less the criterion has variance 1 + σ².
    asked, options = question(Slot.GROUND, form=Form.YES_NO), SimulatedOptions(1.0, sigma_c=1.0)
    told, truth = prompt(asked, ("here", "ahead")), AtStep("here")
    yes = [
        SimulatedObserver(options, truth=truth, seed=1, episode_id=str(e)).answer(told)
        for e in range(2000)
    ]
    share_yes = np.mean([reply.outcome == Cardinal(1.0) for reply in yes])
    assert share_yes == pytest.approx(norm.cdf(0.5 / np.sqrt(2.0)), abs=2 * TOLERANCE)


def test_a_criterion_is_one_constant_of_its_episode() -> None:
    # x − c at a fixed criterion: true and false positives move together along Φ(d′ − c), Φ(−c).
    asked, keys = question(Slot.GROUND, form=Form.YES_NO), ("here", "ahead")
    options = SimulatedOptions(1.0, sigma_c=1.0)
    hit = share(answers(asked, keys, "here", options), lambda o: value_of(o) == 1.0)
    alarm = share(answers(asked, keys, "ahead", options), lambda o: value_of(o) == 1.0)
    criterion = -norm.ppf(alarm)
    assert abs(criterion - 0.5) > 0.05
    assert hit == pytest.approx(norm.cdf(1.0 - criterion), abs=2 * TOLERANCE)


def test_progress_supports_as_the_criterion_says() -> None:
    asked, options = question(Slot.TRANSITION, form=Form.PROGRESS), SimulatedOptions(d_prime=1.0)
    for target, expected in (("next", norm.cdf(0.5)), ("stay", norm.cdf(-0.5))):
        found = answers(asked, PAIR, target, options)
        supports = share(found, lambda outcome: value_of(outcome) >= 80.0)
        assert supports == pytest.approx(expected, abs=TOLERANCE)
        assert all(0.0 <= value_of(outcome) <= 100.0 for outcome in found)


def test_direct_action_goes_forward_as_the_criterion_says() -> None:
    asked, keys = question(Slot.DIRECT), ("forward", "left", "right")
    options = SimulatedOptions(d_prime=1.0)
    forward = answers(asked, keys, "forward", options)
    assert share(forward, won_by("forward")) == pytest.approx(norm.cdf(0.5), abs=TOLERANCE)
    left = answers(asked, keys, "left", options)
    # Past a front below the criterion, left against right is a comparison of two.
    expected = norm.cdf(0.5) * norm.cdf(1.0 / np.sqrt(2.0))
    assert share(left, won_by("left")) == pytest.approx(expected, abs=TOLERANCE)


@pytest.mark.parametrize(("target", "sign"), [("next", 1.0), ("stay", -1.0)])
def test_a_bias_towards_the_first(target: Key, sign: float) -> None:
    options = SimulatedOptions(d_prime=1.0, beta=0.8)
    found = answers(question(Slot.TRANSITION), ("next", "stay"), target, options)
    expected = norm.cdf((1.0 + sign * 0.8) / np.sqrt(2.0))
    assert share(found, won_by(target)) == pytest.approx(expected, abs=TOLERANCE)


@pytest.mark.parametrize(
    ("shared_orders", "correct", "wrong", "abstained"),
    [(False, 0.500, 0.045, 0.455), (True, 0.556, 0.102, 0.342)],
)
def test_swapping_and_abstaining(
    shared_orders: bool, correct: float, wrong: float, abstained: float
) -> None:
    options = SimulatedOptions(d_prime=1.0, beta=0.8, shared_orders=shared_orders)
    asked = question(Slot.TRANSITION)
    shown = [prompt(asked, PAIR, 0), prompt(asked, PAIR[::-1], 1)]
    outcomes = [agreement(PAIR, both) for both in answers_to(shown, "next", options)]
    assert share(outcomes, won_by("next")) == pytest.approx(correct, abs=TOLERANCE)
    assert share(outcomes, won_by("stay")) == pytest.approx(wrong, abs=TOLERANCE)
    is_abstention = share(outcomes, lambda outcome: isinstance(outcome, Abstention))
    assert is_abstention == pytest.approx(abstained, abs=TOLERANCE)


def has_run(supports: tuple[bool, ...], r: int) -> bool:
    return any(all(supports[i : i + r]) for i in range(len(supports) - r + 1))


@pytest.mark.parametrize(("target", "p", "expected"), [("next", 0.8, 0.972), ("stay", 0.2, 0.164)])
def test_a_run_of_two_supports_in_six_tries(target: Key, p: float, expected: float) -> None:
    exact = sum(
        p ** sum(supports) * (1 - p) ** (6 - sum(supports))
        for supports in product((True, False), repeat=6)
        if has_run(supports, 2)
    )
    assert exact == pytest.approx(expected, abs=5e-4)
    options = SimulatedOptions(d_prime=float(np.sqrt(2.0) * norm.ppf(0.8)))
    found = answers(question(Slot.TRANSITION), PAIR, target, options)
    supports = [won_by("next")(outcome) for outcome in found]
    tries = [tuple(supports[i : i + 6]) for i in range(0, N - 5, 6)]
    runs = np.mean([has_run(six, 2) for six in tries])
    assert runs == pytest.approx(expected, abs=0.045)


def test_lapses_are_uniform_and_the_rest_is_not() -> None:
    keys = ("left", "front", "right")
    options = SimulatedOptions(d_prime=50.0, lapse=0.3)
    found = answers(question(Slot.SEEING), keys, "left", options)
    assert share(found, won_by("left")) == pytest.approx(0.7 + 0.1, abs=TOLERANCE)
    assert share(found, won_by("right")) == pytest.approx(0.1, abs=TOLERANCE)


def test_headings_scatter_as_the_sensitivity_says() -> None:
    options = SimulatedOptions(d_prime=1.5)
    asked, keys = question(Slot.SEEING, form=Form.DEGREES), ("left", "front", "right")
    degrees = [value_of(outcome) for outcome in answers(asked, keys, "front", options)]
    # 45° / 1.5 = 30°: clipped to ±90 at three deviations.
    assert np.std(degrees) == pytest.approx(30.0, abs=1.0)
    assert np.mean(degrees) == pytest.approx(0.0, abs=1.5)
    assert max(np.abs(degrees)) == 90.0
