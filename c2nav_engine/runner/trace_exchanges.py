"""The exchange that a message records: the inverse of `runner.trace_messages`."""

from __future__ import annotations

from collections.abc import Sequence

from google.protobuf.message import Message

from c2nav_engine.contract.question import Slot
from c2nav_engine.controller.sensed import Action, Candidate, DepthStats, Step, View
from c2nav_engine.errors import TraceError
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
    Rig,
    Seen,
    SketchEntry,
    SketchState,
    Stop,
    Unasked,
)
from c2nav_engine.runner.exchange import Exchange, Override, Truth
from c2nav_engine.traces.contract_messages import (
    Show,
    outcome_of,
    pose_of,
    question_of,
    ranked_of,
)
from c2nav_engine.traces.pb.common_pb2 import Wall
from c2nav_engine.traces.pb.control_pb2 import Control, ExecutedStep, ViewReading
from c2nav_engine.traces.pb.control_pb2 import Look as LookMessage
from c2nav_engine.traces.pb.control_pb2 import Move as MoveMessage
from c2nav_engine.traces.pb.decision_pb2 import Candidate as CandidateMessage
from c2nav_engine.traces.pb.decision_pb2 import Decision
from c2nav_engine.traces.pb.decision_pb2 import Facts as FactsMessage
from c2nav_engine.traces.pb.decision_pb2 import Override as OverrideMessage
from c2nav_engine.traces.pb.evaluation_pb2 import Evaluation
from c2nav_engine.traces.pb.route_pb2 import Ladder, Sketch
from c2nav_engine.traces.pb.route_pb2 import Marker as MarkerMessage


def exchange_of(message: Message, truth: Truth | None, show: Show) -> Exchange:
    """The exchange of one message of `topics.EXCHANGE_TOPICS`."""
    if isinstance(message, Decision):
        return _asked(message, show) if message.HasField("question") else _unasked(message, show)
    if isinstance(message, Sketch):
        return _sketch(message, show)
    if isinstance(message, Ladder):
        return _ladder(message)
    if isinstance(message, Control):
        return _control(message, truth, show)
    text = f"expected an exchange's message, came {message.DESCRIPTOR.full_name}"
    raise TraceError(text)


def truth_of(message: Evaluation, depth_png: bytes) -> Truth:
    """What only the shell knew about an exchange."""
    return Truth(
        poses=tuple(pose_of(pose) for pose in message.poses),
        goal_distances_m=tuple(message.goal_distances_m),
        depth_png=depth_png,
    )


def _wall(message: Wall) -> dict[str, float]:
    return {fact.name: fact.value for fact in message.facts}


# ---------------------------------------------------------------- control


def _control(message: Control, truth: Truth | None, show: Show) -> Exchange:
    what = message.WhichOneof("what")
    if what == "look":
        request, response = Look(Rig(message.look.rig)), _seen(message.look, show)
    elif what == "move":
        request, response = _move(message.move), _moved(message.move)
    elif what == "event":
        event = Event(message.event.name, message.event.detail, message.event.cycle)
        request, response = Note(event), None
    elif what == "stop":
        request, response = Stop(), None
    else:
        text = f"exchange {message.exchange} says neither look, move, event nor stop"
        raise TraceError(text)
    return Exchange(
        index=message.exchange,
        step=message.step,
        decision=None,
        request=request,
        response=response,
        truth=truth,
        wall_s=_wall(message.wall),
    )


def _seen(message: LookMessage, show: Show) -> Seen:
    sectors = [show(digest) for digest in message.sectors]
    return Seen(
        views=tuple(_view(view, show) for view in message.views),
        odometry=pose_of(message.odometry),
        sectors=tuple(sector for sector in sectors if sector is not None),
        thumbnail=show(message.thumbnail),
    )


def _view(message: ViewReading, show: Show) -> View:
    picture = show(message.picture)
    if picture is None:
        text = f"expected the picture of view {message.key!r}, the trace names none"
        raise TraceError(text)
    depth = DepthStats(message.depth_median_m, message.depth_holes)
    return View(message.key, message.offset_rad, picture, message.free_m, depth)


def _move(message: MoveMessage) -> Move:
    return Move(tuple(Action(action) for action in message.actions), message.purpose)


def _moved(message: MoveMessage) -> Moved:
    return Moved(tuple(_step(step) for step in message.steps), message.exhausted)


def _step(message: ExecutedStep) -> Step:
    odometry = pose_of(message.odometry)
    return Step(Action(message.action), odometry, message.moved_m, message.collided)


# ---------------------------------------------------------------- decisions


def _asked(message: Decision, show: Show) -> Exchange:
    question = question_of(message.question, show)
    ranked = message.ranked if message.HasField("ranked") else None
    return Exchange(
        index=message.exchange,
        step=message.step,
        decision=message.decision,
        request=Ask(question, _facts(message, show)),
        response=outcome_of(message.committed),
        ranked=None if ranked is None else ranked_of(ranked, question, show),
        override=_override(message.override) if message.HasField("override") else None,
        wall_s=_wall(message.wall),
    )


def _override(message: OverrideMessage) -> Override:
    return Override(outcome_of(message.outcome), message.who, message.why, message.wall.when_s)


def _unasked(message: Decision, show: Show) -> Exchange:
    elected = message.elected if message.HasField("elected") else None
    return Exchange(
        index=message.exchange,
        step=message.step,
        decision=message.decision,
        request=Note(Unasked(_facts(message, show), elected)),
        response=None,
        wall_s=_wall(message.wall),
    )


def _facts(decision: Decision, show: Show) -> Facts:
    message: FactsMessage = decision.facts
    return Facts(
        slot=Slot(decision.slot),
        cycle=message.cycle,
        leg=message.leg,
        candidates=_candidates(message.candidates, show),
        odometry=pose_of(message.odometry),
        travelled_m=message.travelled_m,
        leg_travelled_m=message.leg_travelled_m,
        contested=message.contested,
        notes={note.name: note.value for note in message.notes},
    )


def _candidates(messages: Sequence[CandidateMessage], show: Show) -> tuple[Candidate, ...]:
    return tuple(
        Candidate(
            key=each.key,
            feasible=each.feasible,
            veto=each.veto,
            free_m=each.free_m if each.HasField("free_m") else None,
            offset_rad=each.offset_rad if each.HasField("offset_rad") else None,
            picture=show(each.picture),
        )
        for each in messages
    )


# ---------------------------------------------------------------- notes


def _sketch(message: Sketch, show: Show) -> Exchange:
    entry = SketchEntry(
        cycle=message.cycle,
        leg=message.entry_leg,
        displacement_m=(message.displacement_right_m, message.displacement_forward_m),
        elapsed_steps=message.elapsed_steps,
        turning=message.turning,
        words=message.words,
        cue=message.cue,
        thumbnail=show(message.thumbnail),
    )
    state = SketchState(
        entry=entry,
        rendering=message.rendering,
        support=message.support,
        leg=message.leg,
        advanced=message.advanced,
        gate_open=message.gate_open,
    )
    return Exchange(
        message.exchange, message.step, None, Note(state), None, wall_s=_wall(message.wall)
    )


def _ladder(message: Ladder) -> Exchange:
    state = LadderState(
        cycle=message.cycle,
        ground=message.ground,
        journey=message.journey,
        lookback=message.lookback,
        verdict=message.verdict,
        vetoes=tuple(message.vetoes),
        budget=message.budget,
        markers=tuple(_marker(marker) for marker in message.markers),
        event=message.event,
    )
    return Exchange(
        message.exchange, message.step, None, Note(state), None, wall_s=_wall(message.wall)
    )


def _marker(message: MarkerMessage) -> Marker:
    return Marker(pose_of(message.odometry), message.score, message.cycle, message.path_m)
