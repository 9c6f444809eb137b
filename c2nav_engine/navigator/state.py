"""Where the loop stands, and the few ways in which it talks to its shell."""

from __future__ import annotations

import enum
import hashlib
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass

from c2nav_engine.contract.outcome import Answered, Ordering
from c2nav_engine.contract.question import Picture, Question, Slot
from c2nav_engine.contract.slots import Route
from c2nav_engine.controller.collisions import CollisionMemory
from c2nav_engine.controller.fan import GlanceMemory
from c2nav_engine.controller.history import SeeingHistory
from c2nav_engine.controller.odometer import Odometer
from c2nav_engine.controller.places import PlaceMarker, Places
from c2nav_engine.controller.sensed import Action, Candidate, View
from c2nav_engine.episodes.profile import Profile
from c2nav_engine.errors import InternalError
from c2nav_engine.faculties.remembering import RouteSketch, TransitionRule
from c2nav_engine.geometry import Pose
from c2nav_engine.navigator.config import LoopConfig
from c2nav_engine.navigator.requests import (
    Ask,
    Event,
    Facts,
    Look,
    Move,
    Moved,
    Note,
    Request,
    Response,
    Rig,
    Seen,
)


class Ending(enum.StrEnum):
    """How the generator ended by itself."""

    STOPPED = "stopped"
    STEP_LIMIT = "step_limit"
    STALLED = "stalled"


class BudgetUsed(Exception):
    """The shell executed the last allowed action; unwinds the cycle."""


@dataclass(frozen=True, slots=True)
class Task:
    """What one run of the loop is given.

    Attributes:
        instruction: The whole instruction, verbatim.
        legs: The parsed route ladder, K ≥ 1.
        profile: The body.
        config: Everything that decides.
        episode_id: Keys the presentation seeds.
        seed: Keys the presentation seeds.
        start: Believed pose at the start.
    """

    instruction: str
    legs: tuple[str, ...]
    profile: Profile
    config: LoopConfig
    episode_id: str
    seed: int
    start: Pose


class State:
    """Everything the loop remembers between requests.

    Attributes:
        task: What it was given.
        legs: The legs it follows: the parsed ones, or the whole instruction as one.
        cycle: Navigation cycle, from 0.
        leg: Active leg, from 0.
        fan: The latest fan.
        frames: (path_m, front picture) of every fan, oldest first.
        fallbacks: Fallback cycles in a row.
        reevaluate: A stop was vetoed in the last cycle.
        returning: Marker to walk back to in the next cycle.
    """

    def __init__(self, task: Task) -> None:
        config = task.config
        self.task = task
        self.legs = task.legs if config.variant.legs else (task.instruction,)
        self.odometer = Odometer(task.start)
        self.collisions = CollisionMemory(
            half_offset_rad=task.profile.fan_offset_rad / 2.0,
            forget_m=config.controller.collision_forget_m,
        )
        self.glances = GlanceMemory(config.controller.glance_memory_m)
        self.history = SeeingHistory(task.start.position_m)
        self.sketch = RouteSketch()
        self.transition = TransitionRule(
            needed=config.gates.transition_support, progress_support=config.gates.progress_support
        )
        self.places = Places(config.controller, config.gates.lookback_budget)
        self.cycle = 0
        self.leg = 0
        self.leg_start = task.start
        self.leg_start_m = 0.0
        self.leg_start_cycle = -1
        self.gate_cycles = 0
        self.fan: Seen | None = None
        self.frames: list[tuple[float, Picture]] = []
        self.fallbacks = 0
        self.ground_negatives = 0
        self.basic_run = 0
        self.walkbacks = 0
        self.reevaluate = False
        self.returning: PlaceMarker | None = None
        self.transition_asked_at = 0
        self.arriving_asked_at = 0

    @property
    def last_leg(self) -> bool:
        """Whether the active leg is the last."""
        return self.leg == len(self.legs) - 1

    @property
    def leg_travelled_m(self) -> float:
        """Believed travel since the active leg was entered."""
        return self.odometer.travelled_m - self.leg_start_m

    @property
    def front(self) -> View:
        """The front view of the latest fan."""
        if self.fan is None:
            message = "the loop read its fan before it looked"
            raise InternalError(message)
        return next(view for view in self.fan.views if view.key == "front")

    @property
    def thumbnails(self) -> tuple[Picture, ...]:
        """The sketch's thumbnails, where prompts carry the sketch."""
        return self.sketch.thumbnails if self.task.config.variant.sketch else ()

    def route(self) -> Route:
        """What every question says about the route now."""
        sketch = self.sketch.render(self.leg) if self.task.config.variant.sketch else ""
        return Route(self.task.instruction, self.legs, self.leg, sketch)

    def seed(self, slot: Slot) -> int:
        """Presentation seed of a slot in this cycle; the same for matched variants."""
        key = f"{self.task.seed}/{self.task.episode_id}/{slot.value}/{self.cycle}"
        return int.from_bytes(hashlib.sha256(key.encode()).digest()[:6], "big")

    def facts(
        self,
        slot: Slot,
        candidates: Sequence[Candidate],
        *,
        contested: str = "",
        notes: Mapping[str, str] | None = None,
    ) -> Facts:
        """What the controller knows at this decision."""
        return Facts(
            slot=slot,
            cycle=self.cycle,
            leg=self.leg,
            candidates=tuple(candidates),
            odometry=self.odometer.pose,
            travelled_m=self.odometer.travelled_m,
            leg_travelled_m=self.leg_travelled_m,
            contested=contested,
            notes=dict(notes or {}),
        )

    def enter_next_leg(self) -> None:
        """Advance the route: a new leg begins here."""
        self.leg += 1
        self.leg_start = self.odometer.pose
        self.leg_start_m = self.odometer.travelled_m
        self.leg_start_cycle = self.cycle
        self.gate_cycles = 0
        self.transition.restart()
        self.history.first_of_leg = True


Answer = Generator[Request, Response, Answered]
Silent = Generator[Request, Response, None]
Stopping = Generator[Request, Response, bool]
"""Returns whether the robot stops now."""


def ask(
    state: State,
    question: Question,
    candidates: Sequence[Candidate] | None = None,
    *,
    contested: str = "",
    notes: Mapping[str, str] | None = None,
) -> Answer:
    """Put a question; candidates default to the question's own alternatives."""
    if candidates is None:
        candidates = [
            Candidate(item.key, True, picture=item.picture) for item in question.alternatives
        ]
    facts = state.facts(question.slot, candidates, contested=contested, notes=notes)
    response = yield Ask(question, facts)
    if response is None or isinstance(response, Seen | Moved):
        message = f"expected an outcome for {question.slot}, came {type(response).__name__}"
        raise InternalError(message)
    if isinstance(response, Ordering) and not set(response.keys) <= set(question.keys):
        message = f"expected keys among {question.keys}, came {response.keys}"
        raise InternalError(message)
    return response


def look(rig: Rig) -> Generator[Request, Response, Seen]:
    """Read cameras."""
    response = yield Look(rig)
    if not isinstance(response, Seen):
        message = f"expected what {rig} sees, came {type(response).__name__}"
        raise InternalError(message)
    return response


def move(
    state: State, actions: Sequence[Action], purpose: str, *, retracing: bool = False
) -> Generator[Request, Response, Moved]:
    """Execute actions and take in what was achieved; raises `BudgetUsed` at the step limit."""
    if not actions:
        return Moved(())
    response = yield Move(tuple(actions), purpose)
    if not isinstance(response, Moved):
        message = f"expected the achieved motion, came {type(response).__name__}"
        raise InternalError(message)
    state.odometer.add(response.steps, retracing=retracing)
    state.collisions.add(response.steps, travelled_m=state.odometer.travelled_m)
    if response.exhausted:
        raise BudgetUsed
    return response


def event(state: State, name: str, detail: str) -> Silent:
    """Tell the shell that something happened."""
    yield Note(Event(name, detail, state.cycle))


def fallback(state: State, reason: str) -> Silent:
    """This cycle could not select: the route state stays and the next cycle asks again."""
    state.fallbacks += 1
    yield from event(state, "fallback", reason)
