"""One cycle's direction: fan, vetting, election or glance, and the bounded motion after it."""

from __future__ import annotations

import math
from collections.abc import Generator, Sequence

from c2nav_engine.contract import slots
from c2nav_engine.contract.outcome import Answered, Cardinal, Key
from c2nav_engine.contract.question import Slot
from c2nav_engine.controller.bundle import bundle_steps
from c2nav_engine.controller.fan import sector_views, vet_fan, vet_sectors
from c2nav_engine.controller.sensed import Action, Candidate, View
from c2nav_engine.controller.turning import turns
from c2nav_engine.errors import InternalError
from c2nav_engine.faculties import seeing
from c2nav_engine.navigator.config import Direction
from c2nav_engine.navigator.requests import Note, Request, Response, Rig, Seen, Unasked
from c2nav_engine.navigator.state import Silent, State, ask, event, fallback, look, move


def see_and_move(state: State) -> Generator[Request, Response, bool]:
    """Step (1) and (2) of the cycle; True when it was a glance, a cycle of its own."""
    if state.task.config.variant.direction is Direction.DIRECT:
        yield from _direct(state)
        return False
    fan = _fan(state)
    candidates = vet_fan(
        fan.views,
        state.collisions,
        yaw_rad=state.odometer.pose.yaw_rad,
        config=state.task.config.controller,
    )
    survivors = [candidate for candidate in candidates if candidate.feasible]
    reason = state.history.glance_reason(
        state.cycle, survivors=len(survivors), config=state.task.config.controller
    )
    if reason:
        if not survivors:
            yield Note(Unasked(state.facts(Slot.SEEING, candidates), None))
        yield from _glance(state, reason)
        return True
    yield from _elect(state, candidates, survivors)
    return False


def _elect(state: State, candidates: Sequence[Candidate], survivors: Sequence[Candidate]) -> Silent:
    if len(survivors) == 1:
        yield Note(
            Unasked(state.facts(Slot.SEEING, candidates, notes=_notes(state)), survivors[0].key)
        )
        state.history.election(survivors[0].key)
        yield from _commit(state, survivors[0], answered=False)
        return
    cardinal = state.task.config.variant.direction is Direction.CARDINAL
    contested = state.history.contested(len(survivors))
    question = seeing.gaze(
        state.route(),
        {item.key: item.picture for item in survivors if item.picture is not None},
        contested=bool(contested),
        seed=state.seed(Slot.SEEING),
        headings_deg=_headings_deg(survivors) if cardinal else None,
    )
    answered = yield from ask(state, question, candidates, contested=contested, notes=_notes(state))
    if isinstance(answered, Cardinal):
        yield from _commit_heading(state, math.radians(answered.value))
        return
    winner = seeing.winner_of(answered)
    state.history.election(winner)
    if winner is None:
        yield from fallback(state, _why(answered))
        return
    yield from _commit(state, next(c for c in survivors if c.key == winner), answered=True)


def _commit(state: State, elected: Candidate, *, answered: bool) -> Silent:
    """Turn to the elected view and move its bundle."""
    profile = state.task.profile
    if elected.free_m is None or elected.offset_rad is None:
        message = f"expected a fan view with free space and direction, came {elected.key!r}"
        raise InternalError(message)
    steps = bundle_steps(elected.free_m, step_m=profile.step_m, config=state.task.config.controller)
    actions = (*turns(elected.offset_rad, profile.turn_rad), *(Action.FORWARD,) * steps)
    yield from _walk(state, actions, "elect", answered=answered)


def _commit_heading(state: State, left_rad: float) -> Silent:
    """Spatial inversion: turn to the named heading, then move if there is room."""
    profile, config = state.task.profile, state.task.config.controller
    aim = turns(left_rad, profile.turn_rad)
    state.history.election("front" if not aim else "left" if aim[0] is Action.LEFT else "right")
    yield from move(state, aim, "elect")
    state.fan = yield from look(Rig.FAN)
    if state.front.free_m < config.free_needed_m:
        yield from fallback(state, f"free {state.front.free_m:.1f} m at the named heading")
        return
    steps = bundle_steps(state.front.free_m, step_m=profile.step_m, config=config)
    yield from _walk(state, (Action.FORWARD,) * steps, "elect", answered=True)


def _direct(state: State) -> Silent:
    """Without Seeing: one label of forward, left and right from the front view."""
    profile, config = state.task.profile, state.task.config.controller
    views = {"forward": "front", "left": "left", "right": "right"}
    fan = {view.key: view for view in _fan(state).views}
    candidates = [
        Candidate(
            action,
            True,
            free_m=fan[view].free_m,
            offset_rad=fan[view].offset_rad,
            picture=fan[view].picture if action == "forward" else None,
        )
        for action, view in views.items()
    ]
    question = slots.direct(state.route(), state.front.picture, seed=state.seed(Slot.DIRECT))
    answered = yield from ask(state, question, candidates, notes=_notes(state))
    winner = seeing.winner_of(answered)
    state.history.election(winner)
    if winner is None:
        yield from fallback(state, _why(answered))
        return
    view = fan[views[winner]]
    aim = turns(view.offset_rad, profile.turn_rad)
    steps = bundle_steps(view.free_m, step_m=profile.step_m, config=config)
    if steps == 0:
        # As under spatial inversion [C]: the body turns where it was told, and that is all.
        yield from move(state, aim, "direct")
        yield from fallback(state, f"free {view.free_m:.1f} m {winner}, no step fits")
        return
    yield from _walk(state, (*aim, *(Action.FORWARD,) * steps), "direct", answered=True)


def _glance(state: State, reason: str) -> Silent:
    """Junction Glance: rank six sectors, re-orient, and nothing else."""
    ring = yield from look(Rig.RING)
    yield from event(state, "glance", reason)
    candidates = vet_sectors(
        ring.views,
        ring.sectors,
        state.glances,
        pose=state.odometer.pose,
        config=state.task.config.controller,
    )
    survivors = [candidate for candidate in candidates if candidate.feasible]
    left_rad = yield from _glance_choice(state, ring, candidates, survivors)
    if left_rad is not None:
        aim = turns(left_rad, state.task.profile.turn_rad)
        yield from move(state, aim, "glance")
        state.glances.add(state.odometer.pose.position_m, state.odometer.pose.yaw_rad)
        state.collisions.clear()
    state.history.last_glance_cycle = state.cycle
    state.history.restart(state.odometer.pose.position_m)


def _glance_choice(
    state: State, ring: Seen, candidates: Sequence[Candidate], survivors: Sequence[Candidate]
) -> Generator[Request, Response, float | None]:
    """Direction to turn to; None after a fallback."""
    if not survivors:
        yield Note(Unasked(state.facts(Slot.GLANCE, candidates), None))
        yield from fallback(state, "the glance had no sector to offer")
        return None
    if len(survivors) == 1:
        yield Note(Unasked(state.facts(Slot.GLANCE, candidates), survivors[0].key))
        return _freer(ring, survivors[0].key).offset_rad
    cardinal = state.task.config.variant.direction is Direction.CARDINAL
    question = seeing.glance(
        state.route(),
        {item.key: item.picture for item in survivors if item.picture is not None},
        seed=state.seed(Slot.GLANCE),
        headings_deg=_headings_deg(survivors) if cardinal else None,
    )
    answered = yield from ask(state, question, candidates)
    if isinstance(answered, Cardinal):
        left_rad = math.radians(answered.value)
        if turns(left_rad, state.task.profile.turn_rad):
            return left_rad
        # A heading excludes no sector from the next glance, so without a turn the same question
        # could come for ever; as a fallback it is counted [C].
        yield from fallback(state, "the named heading is the present one")
        return None
    winner = seeing.winner_of(answered)
    if winner is None:
        yield from fallback(state, _why(answered))
        return None
    return _freer(ring, winner).offset_rad


def _freer(ring: Seen, sector: Key) -> View:
    """Whichever of a sector's two views has more free space."""
    pair = sector_views(ring.views, int(sector.removeprefix("sector")))
    return max(pair, key=lambda view: view.free_m)


def _walk(state: State, actions: Sequence[Action], purpose: str, *, answered: bool) -> Silent:
    """Execute a bundle; a forward step after an answer ends a run of fallbacks."""
    before = state.odometer.forward_steps
    try:
        yield from move(state, actions, purpose)
    finally:
        if answered and state.odometer.forward_steps > before:
            state.fallbacks = 0


def _fan(state: State) -> Seen:
    if state.fan is None:
        message = "the loop elected before it looked"
        raise InternalError(message)
    return state.fan


def _headings_deg(candidates: Sequence[Candidate]) -> dict[Key, float]:
    return {
        item.key: math.degrees(item.offset_rad)
        for item in candidates
        if item.offset_rad is not None
    }


def _notes(state: State) -> dict[str, str]:
    """What Seeing's histories hold, in plain words for people."""
    return {
        "last elections": ", ".join(key or "none" for key in state.history.elected[-4:]) or "none",
        "fallbacks in a row": str(state.fallbacks),
    }


def _why(answered: Answered) -> str:
    """A non-answer in a few words."""
    name = type(answered).__name__.lower()
    reason = getattr(answered, "reason", "")
    return f"{name}: {reason}" if reason else name
