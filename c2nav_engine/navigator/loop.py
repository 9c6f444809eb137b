"""The closed loop (paper, "Closed-Loop Execution"): a generator that performs no I/O.

It yields `Look`, `Ask`, `Move`, `Note` and `Stop` and is sent what they brought. The live runner,
a replay, a person in the browser and every test drive this same generator.
"""

from __future__ import annotations

from collections.abc import Generator

from c2nav_engine.navigator.arriving_cycle import consider_arriving, reevaluate, walk_back
from c2nav_engine.navigator.remembering_cycle import (
    CycleStart,
    append_entry,
    consider_transition,
    note_sketch,
)
from c2nav_engine.navigator.requests import Request, Response, Rig, Stop
from c2nav_engine.navigator.seeing_cycle import see_and_move
from c2nav_engine.navigator.state import (
    BudgetUsed,
    Ending,
    Silent,
    State,
    Stopping,
    Task,
    event,
    look,
)

Loop = Generator[Request, Response, Ending]


def navigate(task: Task) -> Loop:
    """Follow the instruction until a stop, a stall or the step limit.

    Args:
        task: Instruction, legs, body, config and seeds; nothing about the goal.

    Returns:
        How it ended; only `Ending.STOPPED` called STOP.
    """
    state = State(task)
    try:
        yield from _take_view(state)
        while True:
            stopping = yield from _cycle(state)
            if stopping:
                yield Stop()
                return Ending.STOPPED
            if state.fallbacks >= task.config.controller.stall_fallbacks:
                yield from event(state, "stalled", f"{state.fallbacks} fallbacks in a row")
                return Ending.STALLED
            state.cycle += 1
    except BudgetUsed:
        return Ending.STEP_LIMIT


def _cycle(state: State) -> Stopping:
    """One navigation cycle; True when the robot stops now."""
    if state.reevaluate:
        return (yield from reevaluate(state))
    if state.returning is not None:
        return (yield from walk_back(state))
    start = CycleStart(state.odometer)
    glanced = yield from see_and_move(state)
    yield from _take_view(state)
    append_entry(state, start, glanced=glanced)
    if glanced:
        yield from note_sketch(
            state, support=state.transition.support, advanced=False, gate_open=False
        )
        return False
    yield from consider_transition(state)
    stopping = yield from consider_arriving(state)
    state.history.cycle_ended(state.odometer.pose.position_m)
    return stopping


def _take_view(state: State) -> Silent:
    """The fan after this cycle's motion: its centre serves (4), (5) and the next election."""
    state.fan = yield from look(Rig.FAN)
    state.frames.append((state.odometer.path_m, state.front.picture))
