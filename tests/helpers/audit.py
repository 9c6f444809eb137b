"""Reads an episode step by step: what no robot could do, and which faculty spoke out of turn."""

from __future__ import annotations

import math
from collections.abc import Sequence

from c2nav_engine.contract.outcome import Ordering
from c2nav_engine.contract.question import Slot
from c2nav_engine.geometry import Pose, wrap_rad
from c2nav_engine.navigator.requests import Action, Ask, Move, Moved, Note, SketchState, Stop
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.record import Header

TERMINAL = (Slot.GROUND, Slot.JOURNEY, Slot.LOOKBACK)


def faults_of(header: Header, exchanges: Sequence[Exchange]) -> list[str]:
    """One sentence a fault; an honest episode has none."""
    return [
        *_motion_faults(header, exchanges),
        *_gate_faults(header, exchanges),
        *_selection_faults(exchanges),
    ]


def _motion_faults(header: Header, exchanges: Sequence[Exchange]) -> list[str]:
    faults: list[str] = []
    pose = header.episode.start
    profile = header.profile
    for exchange in exchanges:
        if not isinstance(exchange.request, Move) or not isinstance(exchange.response, Moved):
            continue
        assert exchange.truth is not None
        for step, after in zip(exchange.response.steps, exchange.truth.poses, strict=True):
            faults += _step_faults(pose, after, step.action, (profile.step_m, profile.turn_rad))
            pose = after
    return faults


def _step_faults(
    before: Pose, after: Pose, action: Action, limits: tuple[float, float]
) -> list[str]:
    step_m, turn_rad = limits
    moved_m = math.dist(before.position_m[::2], after.position_m[::2])
    turned_rad = abs(wrap_rad(after.yaw_rad - before.yaw_rad))
    if action is Action.FORWARD:
        rise_m = abs(after.position_m[1] - before.position_m[1])
        if moved_m > step_m + 1e-6 or turned_rad > 1e-9 or rise_m > 0.4:
            return [f"a forward step moved {moved_m:.3f} m, rose {rise_m:.2f} m"]
        return []
    if moved_m > 1e-9 or abs(turned_rad - turn_rad) > 1e-6:
        return [f"a turn moved {moved_m:.3f} m and turned {math.degrees(turned_rad):.1f}°"]
    return []


def _gate_faults(header: Header, exchanges: Sequence[Exchange]) -> list[str]:
    faults: list[str] = []
    last_leg = len(header.legs) - 1
    entered = -1
    leg = 0
    for exchange in exchanges:
        request = exchange.request
        record = request.record if isinstance(request, Note) else None
        if isinstance(record, SketchState) and record.leg != leg:
            leg, entered = record.leg, record.entry.cycle
        if not isinstance(request, Ask):
            continue
        facts, slot = request.facts, request.question.slot
        where = f"{slot.value} in cycle {facts.cycle}"
        if facts.leg != leg:
            faults.append(f"{where}: leg {facts.leg}, the sketch says {leg}")
        if slot is Slot.TRANSITION and (leg == last_leg or facts.leg_travelled_m < 0.75 - 1e-9):
            faults.append(f"{where}: past its gate at {facts.leg_travelled_m:.2f} m of leg {leg}")
        early = facts.travelled_m < 2.0 - 1e-9 or facts.leg_travelled_m < 0.5 - 1e-9
        if slot in TERMINAL and (leg != last_leg or early or facts.cycle <= entered):
            faults.append(f"{where}: past its gate at {facts.travelled_m:.2f} m, leg {leg}")
    return faults


def _selection_faults(exchanges: Sequence[Exchange]) -> list[str]:
    """A forward bundle follows an election or a single survivor; a stop follows evidence."""
    faults: list[str] = []
    decided: Exchange | None = None
    asked: list[Slot] = []
    for exchange in exchanges:
        request = exchange.request
        if exchange.decision is not None:
            decided = exchange
        if isinstance(request, Ask):
            asked.append(request.question.slot)
            offered = {c.key for c in request.facts.candidates if c.feasible}
            if isinstance(exchange.response, Ordering) and exchange.response.winner not in offered:
                faults.append(f"decision {exchange.decision}: a vetoed view was elected")
        elected = isinstance(request, Move) and request.purpose == "elect"
        if elected and decided is not None and _chose_nothing(decided):
            faults.append(f"exchange {exchange.index}: motion without an ordering")
        if isinstance(request, Stop) and (not asked or asked[-1] not in TERMINAL):
            faults.append(f"exchange {exchange.index}: a stop without terminal evidence")
    return faults


def _chose_nothing(decided: Exchange) -> bool:
    return isinstance(decided.request, Ask) and not isinstance(decided.response, Ordering)
