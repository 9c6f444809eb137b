"""The simulated observer: a Gaussian judge that knows the truth and sees it through noise.

For experiments without a model. It is privileged: records say so, and it shares no table with a
model. Definitions are method.md's, fixed before any run:

evidence of a role = d′·[it is the target] + N(0, 1) + β·[it is shown first].

Comparative forms rank the evidence. Cardinal forms read the same evidence against a criterion
c = d′/2 plus a constant per episode; they draw no noise of their own.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

from c2nav_engine.contract.outcome import Answered, Cardinal, Invalid, Key, Ordering
from c2nav_engine.contract.prompt import Prompt, Reply
from c2nav_engine.contract.question import Form, Question, Slot
from c2nav_engine.experiments.simulated_noise import normal, normal_cdf, uniform
from c2nav_engine.experiments.simulated_options import SimulatedOptions
from c2nav_engine.geometry import wrap_rad

NAME = "simulated"
SUPPORT_PERCENT = 80.0
"""Progress at the criterion: where `transition-cardinal` begins to support the next leg."""
PERCENT_PER_DEVIATION = 20.0
HEADING_LIMIT_RAD = math.pi / 2.0


@dataclass(frozen=True, slots=True)
class SlotTruth:
    """What is true of one question.

    Attributes:
        target: The alternative that is right; None when none is.
        step: Low-level actions executed so far.
        queries: Queries answered so far in the episode.
        headings_rad: Direction left of the heading of each offered view or sector.
        fan_offset_rad: Side views of the fan, the unit of heading errors.
    """

    target: Key | None
    step: int
    queries: int = 0
    headings_rad: Mapping[Key, float] = field(default_factory=dict[Key, float])
    fan_offset_rad: float = math.radians(45.0)


@runtime_checkable
class Truth(Protocol):
    """Tells the observer what is true; supplied by whoever stands outside the loop."""

    def of(self, question: Question) -> SlotTruth:
        """The truth of the question that is pending."""
        ...


class SimulatedObserver:
    """Answers one episode's prompts; an `Adapter` for the asking wrapper.

    It keeps no state of its own: draws are keyed by name, so that a fork or a re-run from any
    decision sees what the first run saw.

    Args:
        options: What kind of observer.
        truth: What is right.
        seed: Run seed.
        episode_id: Episode.
    """

    def __init__(
        self, options: SimulatedOptions, *, truth: Truth, seed: int, episode_id: str
    ) -> None:
        self._options = options
        self._truth = truth
        self._seed = seed
        self._episode_id = episode_id
        spread = options.sigma_c * normal(seed, episode_id, "criterion")
        self._criterion = options.d_prime / 2.0 + spread

    @property
    def name(self) -> str:
        """What records call it."""
        return NAME

    @property
    def asks_once(self) -> bool:
        """It answers every presentation order."""
        return False

    @property
    def privileged(self) -> bool:
        """It knows the truth."""
        return True

    def answer(self, prompt: Prompt) -> Reply:
        """A finished outcome, for this presentation."""
        truth = self._truth.of(prompt.question)
        return Reply(outcome=self._outcome(prompt, truth), model=NAME)

    def _outcome(self, prompt: Prompt, truth: SlotTruth) -> Answered:
        if self._chance(prompt, truth, "invalid") < self._options.invalid_rate:
            return Invalid("the simulated observer answered nothing readable")
        if self._chance(prompt, truth, "lapse") < self._options.lapse:
            return self._lapsed(prompt, truth)
        by_form = {
            Form.ORDINAL: self._ranking,
            Form.ACTION: self._action,
            Form.DEGREES: self._heading,
            Form.PROGRESS: self._progress,
            Form.YES_NO: self._verdict,
        }
        return by_form[prompt.form](prompt, truth)

    def _ranking(self, prompt: Prompt, truth: SlotTruth) -> Ordering:
        evidence = {key: self._evidence(key, prompt, truth) for _, key in prompt.labels}
        return Ordering.of(*sorted(evidence, key=lambda key: -evidence[key]))

    def _action(self, prompt: Prompt, truth: SlotTruth) -> Ordering:
        """Forward while the front's evidence reaches the criterion, else the better side."""
        left, right = (self._evidence(key, prompt, truth) for key in ("left", "right"))
        ahead = self._evidence("forward", prompt, truth) >= self._criterion
        winner = "forward" if ahead else "left" if left >= right else "right"
        return Ordering.winner_only(winner, prompt.question.keys)

    def _heading(self, prompt: Prompt, truth: SlotTruth) -> Cardinal:
        aim = truth.target
        if aim is None:
            # Nothing offered is right: it names the direction that looks best. [C]
            aim = self._ranking(prompt, truth).winner
        z = self._noise(aim, prompt, truth)
        error_rad = self._heading_error_rad(z, truth)
        if prompt.question.slot is Slot.GLANCE:
            if math.isinf(error_rad):
                # Without any sensitivity the wrapped error is uniform over the circle.
                error_rad = math.tau * (normal_cdf(z) - 0.5)
            heading_rad = wrap_rad(truth.headings_rad[aim] + error_rad)
        else:
            wished_rad = truth.headings_rad[aim] + error_rad
            heading_rad = min(HEADING_LIMIT_RAD, max(-HEADING_LIMIT_RAD, wished_rad))
        return Cardinal(math.degrees(heading_rad))

    def _heading_error_rad(self, z: float, truth: SlotTruth) -> float:
        if self._options.d_prime == 0.0:
            return math.copysign(math.inf, z)
        return truth.fan_offset_rad / self._options.d_prime * z

    def _progress(self, prompt: Prompt, truth: SlotTruth) -> Cardinal:
        above = self._evidence("next", prompt, truth) - self._criterion
        return Cardinal(min(100.0, max(0.0, SUPPORT_PERCENT + PERCENT_PER_DEVIATION * above)))

    def _verdict(self, prompt: Prompt, truth: SlotTruth) -> Cardinal:
        return Cardinal(float(self._evidence("here", prompt, truth) >= self._criterion))

    def _evidence(self, key: Key, prompt: Prompt, truth: SlotTruth) -> float:
        first = prompt.form is not Form.YES_NO and key == prompt.labels[0][1]
        return (
            self._options.d_prime * (key == truth.target)
            + self._noise(key, prompt, truth)
            + self._options.beta * first
        )

    def _noise(self, key: Key, prompt: Prompt, truth: SlotTruth) -> float:
        order = 0 if self._options.shared_orders else prompt.order
        # Direct action looks at the fan's directions: it shares the election's evidence.
        slot = Slot.SEEING if prompt.question.slot is Slot.DIRECT else prompt.question.slot
        role = "front" if key == "forward" else key
        return normal(self._seed, self._episode_id, slot.value, truth.step, role, order)

    def _lapsed(self, prompt: Prompt, truth: SlotTruth) -> Answered:
        """An answer drawn uniformly from those that the form allows."""
        keys = prompt.question.keys
        if prompt.form is Form.ORDINAL:
            drawn = {key: self._chance(prompt, truth, f"order/{key}") for key in keys}
            return Ordering.of(*sorted(keys, key=lambda key: drawn[key]))
        share = self._chance(prompt, truth, "value")
        if prompt.form is Form.ACTION:
            return Ordering.winner_only(keys[math.floor(share * len(keys))], keys)
        if prompt.form is Form.YES_NO:
            return Cardinal(float(share < 0.5))
        if prompt.form is Form.PROGRESS:
            return Cardinal(100.0 * share)
        limit = 180.0 if prompt.question.slot is Slot.GLANCE else 90.0
        return Cardinal(limit * (2.0 * share - 1.0))

    def _chance(self, prompt: Prompt, truth: SlotTruth, what: str) -> float:
        """A uniform draw of this very query: asking again draws again."""
        query = f"{truth.queries}/{prompt.order}/{prompt.repair}"
        slot = prompt.question.slot.value
        return uniform(self._seed, self._episode_id, slot, truth.step, query, what)
