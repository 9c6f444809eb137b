"""An exchange as the one message that records it."""

from __future__ import annotations

from google.protobuf.message import Message

from c2nav_engine.controller.sensed import Candidate, Step, View
from c2nav_engine.errors import InternalError
from c2nav_engine.navigator.requests import (
    Ask,
    Event,
    Facts,
    LadderState,
    Look,
    Marker,
    Move,
    Moved,
    Note,
    Seen,
    SketchState,
    Stop,
    Unasked,
)
from c2nav_engine.runner.exchange import Exchange, Override, Response
from c2nav_engine.traces.contract_messages import (
    Keep,
    outcome_message,
    pose_message,
    question_message,
    ranked_message,
)
from c2nav_engine.traces.pb import common_pb2, control_pb2, decision_pb2, route_pb2


def exchange_message(exchange: Exchange, keep: Keep) -> tuple[str, Message]:
    """Topic and message of an exchange; `keep` is told of each picture it shows."""
    request = exchange.request
    if isinstance(request, Ask):
        return "/decision", _asked(exchange, request, keep)
    if isinstance(request, Note):
        return _noted(exchange, request, keep)
    return "/control", _control(exchange, request, keep)


def wall_message(facts: dict[str, float]) -> common_pb2.Wall | None:
    """Wall-clock facts, or None when there are none."""
    if not facts:
        return None
    numbers = [common_pb2.Number(name=name, value=value) for name, value in facts.items()]
    return common_pb2.Wall(facts=numbers)


# ---------------------------------------------------------------- control


def _control(exchange: Exchange, request: Look | Move | Stop, keep: Keep) -> control_pb2.Control:
    message = control_pb2.Control(
        exchange=exchange.index, step=exchange.step, wall=wall_message(exchange.wall_s)
    )
    if isinstance(request, Look):
        message.look.CopyFrom(_look(request, exchange.response, keep))
    elif isinstance(request, Move):
        message.move.CopyFrom(_move(request, exchange.response))
    else:
        message.stop.SetInParent()
    return message


def _look(request: Look, response: Response, keep: Keep) -> control_pb2.Look:
    if not isinstance(response, Seen):
        raise _mismatch("Look", "Seen", response)
    return control_pb2.Look(
        rig=request.rig,
        views=[_view(view, keep) for view in response.views],
        odometry=pose_message(response.odometry),
        sectors=[keep(sector) for sector in response.sectors],
        thumbnail=keep(response.thumbnail),
    )


def _view(view: View, keep: Keep) -> control_pb2.ViewReading:
    return control_pb2.ViewReading(
        key=view.key,
        offset_rad=view.offset_rad,
        picture=keep(view.picture),
        free_m=view.free_m,
        depth_median_m=view.depth.median_m,
        depth_holes=view.depth.holes,
    )


def _move(request: Move, response: Response) -> control_pb2.Move:
    if not isinstance(response, Moved):
        raise _mismatch("Move", "Moved", response)
    return control_pb2.Move(
        actions=request.actions,
        purpose=request.purpose,
        steps=[_step(step) for step in response.steps],
        exhausted=response.exhausted,
    )


def _step(step: Step) -> control_pb2.ExecutedStep:
    return control_pb2.ExecutedStep(
        action=step.action,
        odometry=pose_message(step.odometry),
        moved_m=step.moved_m,
        collided=step.collided,
    )


# ---------------------------------------------------------------- decisions


def _asked(exchange: Exchange, request: Ask, keep: Keep) -> decision_pb2.Decision:
    response, ranked = exchange.response, exchange.ranked
    if response is None or isinstance(response, Seen | Moved):
        raise _mismatch("Ask", "an outcome", response)
    if ranked is not None and any(q.prompt.question != request.question for q in ranked.queries):
        message = f"expected prompts of exchange {exchange.index}'s question, came another's"
        raise InternalError(message)
    return decision_pb2.Decision(
        exchange=exchange.index,
        step=exchange.step,
        decision=_number(exchange),
        slot=request.facts.slot,
        facts=_facts(request.facts, keep),
        question=question_message(request.question, keep),
        ranked=None if ranked is None else ranked_message(ranked, keep),
        override=None if exchange.override is None else _override(exchange.override),
        by="ranker" if exchange.override is None else "override",
        committed=outcome_message(response),
        wall=wall_message(exchange.wall_s),
    )


def _override(override: Override) -> decision_pb2.Override:
    return decision_pb2.Override(
        who=override.who,
        why=override.why,
        outcome=outcome_message(override.outcome),
        wall=decision_pb2.OverrideWall(when_s=override.when_s),
    )


def _unasked(exchange: Exchange, record: Unasked, keep: Keep) -> decision_pb2.Decision:
    return decision_pb2.Decision(
        exchange=exchange.index,
        step=exchange.step,
        decision=_number(exchange),
        slot=record.facts.slot,
        facts=_facts(record.facts, keep),
        by="rule",
        elected=record.elected,
        wall=wall_message(exchange.wall_s),
    )


def _number(exchange: Exchange) -> int:
    if exchange.decision is None:
        message = f"expected a decision number on exchange {exchange.index}, came none"
        raise InternalError(message)
    return exchange.decision


def _facts(facts: Facts, keep: Keep) -> decision_pb2.Facts:
    return decision_pb2.Facts(
        cycle=facts.cycle,
        leg=facts.leg,
        candidates=[_candidate(each, keep) for each in facts.candidates],
        odometry=pose_message(facts.odometry),
        travelled_m=facts.travelled_m,
        leg_travelled_m=facts.leg_travelled_m,
        contested=facts.contested,
        notes=[common_pb2.Text(name=name, value=words) for name, words in facts.notes.items()],
    )


def _candidate(candidate: Candidate, keep: Keep) -> decision_pb2.Candidate:
    return decision_pb2.Candidate(
        key=candidate.key,
        feasible=candidate.feasible,
        veto=candidate.veto,
        free_m=candidate.free_m,
        offset_rad=candidate.offset_rad,
        picture=keep(candidate.picture),
    )


# ---------------------------------------------------------------- notes


def _noted(exchange: Exchange, request: Note, keep: Keep) -> tuple[str, Message]:
    record = request.record
    if isinstance(record, Unasked):
        return "/decision", _unasked(exchange, record, keep)
    if isinstance(record, SketchState):
        return "/sketch", _sketch(exchange, record, keep)
    if isinstance(record, LadderState):
        return "/ladder", _ladder(exchange, record)
    return "/control", _event(exchange, record)


def _sketch(exchange: Exchange, state: SketchState, keep: Keep) -> route_pb2.Sketch:
    entry = state.entry
    right_m, forward_m = entry.displacement_m
    return route_pb2.Sketch(
        exchange=exchange.index,
        step=exchange.step,
        cycle=entry.cycle,
        entry_leg=entry.leg,
        displacement_right_m=right_m,
        displacement_forward_m=forward_m,
        elapsed_steps=entry.elapsed_steps,
        turning=entry.turning,
        words=entry.words,
        cue=entry.cue,
        thumbnail=keep(entry.thumbnail),
        rendering=state.rendering,
        support=state.support,
        leg=state.leg,
        advanced=state.advanced,
        gate_open=state.gate_open,
        wall=wall_message(exchange.wall_s),
    )


def _ladder(exchange: Exchange, state: LadderState) -> route_pb2.Ladder:
    return route_pb2.Ladder(
        exchange=exchange.index,
        step=exchange.step,
        cycle=state.cycle,
        ground=state.ground,
        journey=state.journey,
        lookback=state.lookback,
        verdict=state.verdict,
        vetoes=state.vetoes,
        budget=state.budget,
        markers=[_marker(marker) for marker in state.markers],
        event=state.event,
        wall=wall_message(exchange.wall_s),
    )


def _marker(marker: Marker) -> route_pb2.Marker:
    return route_pb2.Marker(
        odometry=pose_message(marker.odometry),
        score=marker.score,
        cycle=marker.cycle,
        path_m=marker.path_m,
    )


def _event(exchange: Exchange, event: Event) -> control_pb2.Control:
    return control_pb2.Control(
        exchange=exchange.index,
        step=exchange.step,
        event=control_pb2.Event(name=event.name, detail=event.detail, cycle=event.cycle),
        wall=wall_message(exchange.wall_s),
    )


def _mismatch(request: str, expected: str, came: Response) -> InternalError:
    return InternalError(f"expected {expected} in answer to {request}, came {type(came).__name__}")
