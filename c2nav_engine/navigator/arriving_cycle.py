"""Step (5) of the cycle and what follows from it: hold, inspect, stop, look back, walk back."""

from __future__ import annotations

from collections.abc import Generator, Sequence

from c2nav_engine.contract.question import Picture
from c2nav_engine.controller.places import PlaceMarker
from c2nav_engine.controller.sensed import DepthStats
from c2nav_engine.controller.vetoes import stop_vetoes
from c2nav_engine.controller.walkback import Return
from c2nav_engine.faculties.arriving import (
    Reading,
    Verdict,
    evaluate,
    evaluate_absolute,
    evaluate_basic,
)
from c2nav_engine.faculties.arriving.evidence import Asking
from c2nav_engine.navigator.config import Terminal
from c2nav_engine.navigator.remembering_cycle import CycleStart, append_entry, note_sketch
from c2nav_engine.navigator.requests import (
    LadderState,
    Marker,
    Note,
    Request,
    Response,
    Rig,
)
from c2nav_engine.navigator.state import Silent, State, Stopping, ask, event, look, move


def consider_arriving(state: State) -> Stopping:
    """Step (5), once its own progress gate is open and the body moved since it was last asked."""
    gates = state.task.config.gates
    due = (
        state.last_leg
        and state.cycle > state.leg_start_cycle
        and state.odometer.travelled_m >= gates.arriving_m - 1e-9
        and state.leg_travelled_m >= gates.arriving_leg_m - 1e-9
        and state.odometer.forward_steps > state.arriving_asked_at
    )
    if not due:
        return False
    if state.task.config.variant.terminal is Terminal.BASIC:
        return (yield from _basic_stop(state))
    reading = yield from _evaluate(state)
    if reading.verdict is Verdict.STOP:
        vetoes = _vetoes(state, state.front.depth, collided=state.odometer.last_forward_collided)
        if not vetoes:
            yield from _note(state, reading, ())
            return True
        state.reevaluate = True
        _mark(state, reading)
        yield from _note(state, reading, vetoes, "stop vetoed")
        return False
    left = _rejected(state, reading)
    yield from _note(state, reading, (), left)
    _consider_return(state, reading)
    return False


def reevaluate(state: State) -> Stopping:
    """The cycle after a vetoed stop: the evidence once more, at rest, with the freest view's depth.

    The collision veto speaks of the step that led here. This reading is taken at rest, so only
    depth can veto it [C].
    """
    state.reevaluate = False
    start = CycleStart(state.odometer)
    ring = yield from look(Rig.RING)
    freest = max(ring.views, key=lambda view: view.free_m)
    append_entry(state, start, glanced=True)
    yield from note_sketch(state, support=0, advanced=False, gate_open=False)
    reading = yield from _evaluate(state)
    if reading.verdict is Verdict.STOP:
        vetoes = _vetoes(state, freest.depth, collided=False)
        if not vetoes:
            yield from _note(state, reading, (), "re-evaluated")
            return True
        _mark(state, reading)
        yield from _note(state, reading, vetoes, "marker left")
        return False
    left = _rejected(state, reading)
    yield from _note(state, reading, (), left or "re-evaluated")
    _consider_return(state, reading)
    return False


def walk_back(state: State) -> Stopping:
    """Retrace to the marker and evaluate the terminal evidence there, once."""
    marker = state.returning
    state.returning = None
    if marker is None:
        return False
    start = CycleStart(state.odometer)
    state.walkbacks += 1
    state.places.use(marker)
    yield from event(state, "walk-back", f"to where cycle {marker.cycle} read {marker.score:+d}")
    reached = yield from _retrace(state, marker)
    state.history.restart(state.odometer.pose.position_m)
    state.ground_negatives = 0
    state.fan = yield from look(Rig.FAN)
    append_entry(state, start, glanced=False, words="went back" if reached else "turned back")
    yield from note_sketch(state, support=0, advanced=False, gate_open=False)
    if not reached:
        return False
    state.places.grant(state.odometer.pose.position_m)
    reading = yield from _evaluate(state, lookback=marker.lookback)
    vetoes = (
        _vetoes(state, state.front.depth, collided=state.odometer.last_forward_collided)
        if reading.verdict is Verdict.STOP
        else ()
    )
    yield from _note(state, reading, vetoes, "re-evaluated")
    return reading.verdict is Verdict.STOP and not vetoes


def _retrace(state: State, marker: PlaceMarker) -> Generator[Request, Response, bool]:
    profile = state.task.profile
    way = Return(
        marker,
        state.odometer,
        step_m=profile.step_m,
        turn_rad=profile.turn_rad,
        config=state.task.config.controller,
    )
    while actions := way.next_actions():
        moved = yield from move(state, actions, "walk-back", retracing=True)
        way.executed(collided=any(step.collided for step in moved.steps))
    if not way.reached:
        yield from event(state, "gave up", way.abandoned)
        state.odometer.return_to(state.odometer.path_m)
        return False
    yield from move(state, way.facing(), "walk-back", retracing=True)
    state.odometer.return_to(marker.path_m)
    return True


def _evaluate(
    state: State, *, lookback: Picture | None = None
) -> Generator[Request, Response, Reading]:
    """The terminal evidence by this variant's form, spending what it spends."""
    state.arriving_asked_at = state.odometer.forward_steps
    here = state.odometer.pose.position_m
    if state.task.config.variant.terminal is Terminal.ABSOLUTE:
        return (
            yield from _drive(
                state, evaluate_absolute(state.route(), state.front.picture, seeds=state.seed)
            )
        )
    sketching = state.task.config.variant.sketch
    reading = yield from _drive(
        state,
        evaluate(
            state.route(),
            state.front.picture,
            seeds=state.seed,
            earlier=state.thumbnails if sketching else None,
            lookback=lookback or _frame_behind(state),
            budget=state.places.budget_at(here),
        ),
    )
    if reading.looked_back:
        state.places.spend(here)
    return reading


def _basic_stop(state: State) -> Stopping:
    """Ground in favour in two cycles in a row, past the same gates and vetoes."""
    state.arriving_asked_at = state.odometer.forward_steps
    reading = yield from _drive(
        state, evaluate_basic(state.route(), state.front.picture, seeds=state.seed)
    )
    state.basic_run = state.basic_run + 1 if reading.evidence.ground == 1 else 0
    if state.basic_run < state.task.config.gates.basic_stop_run:
        yield from _note(state, reading, ())
        return False
    vetoes = _vetoes(state, state.front.depth, collided=state.odometer.last_forward_collided)
    stopping = Reading(reading.evidence, Verdict.STOP)
    yield from _note(state, stopping, vetoes, "stop vetoed" if vetoes else "")
    return not vetoes


def _drive(state: State, asking: Asking) -> Generator[Request, Response, Reading]:
    """Run a faculty's generator of questions through the loop's own requests."""
    try:
        question = next(asking)
        while True:
            answered = yield from ask(state, question)
            question = asking.send(answered)
    except StopIteration as finished:
        reading: Reading = finished.value
        return reading


def _vetoes(state: State, depth: DepthStats, *, collided: bool) -> tuple[str, ...]:
    return stop_vetoes(depth, collided=collided, config=state.task.config.controller)


def _frame_behind(state: State) -> Picture | None:
    """The latest front view at the look-back distance behind, along the path."""
    limit_m = state.odometer.path_m - state.task.config.gates.lookback_m
    behind = [picture for path_m, picture in state.frames if path_m <= limit_m + 1e-9]
    return behind[-1] if behind else None


def _rejected(state: State, reading: Reading) -> str:
    """Leave a marker where a candidate stop was rejected; what the record calls it."""
    candidate = reading.evidence.ground == 1 or reading.inspected
    return "marker left" if candidate and _mark(state, reading) else ""


def _mark(state: State, reading: Reading) -> bool:
    if not state.task.config.variant.walkback:
        return False
    marker = PlaceMarker(
        odometry=state.odometer.pose,
        score=reading.evidence.ground + reading.evidence.journey,
        cycle=state.cycle,
        path_m=state.odometer.path_m,
        lookback=_frame_behind(state),
    )
    return state.places.mark(marker)


def _consider_return(state: State, reading: Reading) -> None:
    """Disconfirming evidence in two cycles in a row calls the robot back to its best marker."""
    config = state.task.config.controller
    negative = reading.evidence.ground == -1
    state.ground_negatives = state.ground_negatives + 1 if negative else 0
    if state.ground_negatives < config.walkback_negatives or state.walkbacks >= config.walkbacks:
        return
    state.returning = state.places.best_marker(state.odometer.path_m)


def _note(state: State, reading: Reading, vetoes: Sequence[str], event_name: str = "") -> Silent:
    markers = tuple(
        Marker(marker.odometry, marker.score, marker.cycle, marker.path_m)
        for marker in state.places.markers
    )
    yield Note(
        LadderState(
            cycle=state.cycle,
            ground=reading.evidence.ground,
            journey=reading.evidence.journey,
            lookback=reading.evidence.lookback,
            verdict=reading.verdict.value,
            vetoes=tuple(vetoes),
            budget=state.places.budget_at(state.odometer.pose.position_m),
            markers=markers,
            event=event_name,
        )
    )
