"""Steps (3) and (4) of the cycle: the sketch's entry, and whether the next leg has begun."""

from __future__ import annotations

from c2nav_engine.contract.question import Slot
from c2nav_engine.controller.odometer import Odometer
from c2nav_engine.faculties.remembering import (
    SketchEntry,
    transition_question,
    turning_word,
)
from c2nav_engine.faculties.remembering.sketch import in_leg_frame, movement_words
from c2nav_engine.geometry import Pose, wrap_rad
from c2nav_engine.navigator.config import Advance
from c2nav_engine.navigator.requests import Note, SketchState
from c2nav_engine.navigator.state import Silent, State, ask


class CycleStart:
    """Where a cycle began, to tell afterwards what it did."""

    def __init__(self, odometer: Odometer) -> None:
        self._pose: Pose = odometer.pose
        self._steps = odometer.steps
        self._forward_steps = odometer.forward_steps

    def net_yaw_rad(self, odometer: Odometer) -> float:
        """Net left turn since."""
        return wrap_rad(odometer.pose.yaw_rad - self._pose.yaw_rad)

    def steps(self, odometer: Odometer) -> int:
        """Low-level actions since."""
        return odometer.steps - self._steps

    def forward_steps(self, odometer: Odometer) -> int:
        """Forward steps since."""
        return odometer.forward_steps - self._forward_steps


def append_entry(state: State, start: CycleStart, *, glanced: bool, words: str = "") -> None:
    """Step (3): the controller's own record of this cycle."""
    odometer = state.odometer
    forward_steps = start.forward_steps(odometer)
    turning = turning_word(start.net_yaw_rad(odometer))
    entry = SketchEntry(
        cycle=state.cycle,
        leg=state.leg,
        displacement_m=in_leg_frame(state.leg_start, odometer.pose),
        elapsed_steps=start.steps(odometer),
        turning=turning,
        words=words or movement_words(turning, forward_steps, reoriented=glanced),
        cue="ambiguous",
        thumbnail=state.fan.thumbnail if state.fan is not None else None,
    )
    state.sketch.append(entry, forward_steps=forward_steps)


def consider_transition(state: State) -> Silent:
    """Step (4): past the gate, ask whether the evidence now belongs to the next leg."""
    advance = state.task.config.variant.advance
    gate_open = _gate_open(state)
    if gate_open and advance is Advance.BLIND:
        state.gate_cycles += 1
    elif gate_open and state.odometer.forward_steps > state.transition_asked_at:
        yield from _ask_transition(state)
    gates = state.task.config.gates
    due = state.transition.accepted or state.gate_cycles > gates.blind_leg_cycles
    support = state.transition.support
    leg = state.leg
    if due and not state.last_leg:
        state.enter_next_leg()
    yield from note_sketch(
        state, support=support, advanced=state.leg != leg, gate_open=gate_open, leg=leg
    )


def note_sketch(
    state: State, *, support: int, advanced: bool, gate_open: bool, leg: int | None = None
) -> Silent:
    """Tell the shell what the sketch now holds; `leg` is the one the cycle belonged to."""
    yield Note(
        SketchState(
            entry=state.sketch.entries[-1],
            rendering=state.sketch.render(state.leg if leg is None else leg),
            support=support,
            leg=state.leg,
            advanced=advanced,
            gate_open=gate_open,
        )
    )


def _gate_open(state: State) -> bool:
    """Enough physical progress in a leg that has a next one (paper, "Event schedule")."""
    gates = state.task.config.gates
    return (
        not state.last_leg
        and state.leg_travelled_m >= gates.transition_m - 1e-9
        and state.cycle - state.leg_start_cycle >= gates.transition_cycles
    )


def _ask_transition(state: State) -> Silent:
    state.transition_asked_at = state.odometer.forward_steps
    question = transition_question(
        state.route(),
        state.front.picture,
        seed=state.seed(Slot.TRANSITION),
        earlier=state.thumbnails,
        cardinal=state.task.config.variant.advance is Advance.CARDINAL,
    )
    answered = yield from ask(
        state, question, notes={"supports in a row": str(state.transition.support)}
    )
    state.sketch.cue(state.transition.read(answered))
