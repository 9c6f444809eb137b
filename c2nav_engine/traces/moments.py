"""A trace as a sequence of moments: each exchange's message with what the shell knew of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from google.protobuf.message import DecodeError, Message

from c2nav_engine.errors import TraceError
from c2nav_engine.geometry import Pose
from c2nav_engine.traces.contract_messages import pose_of
from c2nav_engine.traces.pb.common_pb2 import Picture
from c2nav_engine.traces.pb.control_pb2 import Control
from c2nav_engine.traces.pb.decision_pb2 import Decision
from c2nav_engine.traces.pb.evaluation_pb2 import Evaluation
from c2nav_engine.traces.pb.route_pb2 import Ladder, Sketch
from c2nav_engine.traces.reader import TraceFile
from c2nav_engine.traces.records import Stored
from c2nav_engine.traces.topics import EXCHANGE_TOPICS, TOPICS


@dataclass(frozen=True, slots=True)
class Moment:
    """One exchange.

    Attributes:
        message: What was asked and answered.
        evaluation: What only the shell knew; None where it knew nothing.
    """

    message: Control | Decision | Sketch | Ladder
    evaluation: Evaluation | None

    @property
    def exchange(self) -> int:
        """Its number in the episode."""
        return self.message.exchange

    @property
    def step(self) -> int:
        """Low-level actions executed before it."""
        return self.message.step

    def poses(self) -> list[tuple[int, Pose]]:
        """(step, pose) of a look or a motion: true poses where known, else odometry."""
        if not isinstance(self.message, Control):
            return []
        what = self.message.WhichOneof("what")
        if what == "look":
            first, believed = self.step, [self.message.look.odometry]
        elif what == "move":
            first, believed = self.step + 1, [each.odometry for each in self.message.move.steps]
        else:
            return []
        known = self.evaluation.poses if self.evaluation is not None else ()
        return [(first + place, pose_of(pose)) for place, pose in enumerate(known or believed)]

    def goal_distances_m(self) -> list[tuple[int, float]]:
        """(step, geodesic distance to the goal) where the shell measured it."""
        distances = self.evaluation.goal_distances_m if self.evaluation is not None else ()
        return [
            (step, distance_m)
            for (step, _), distance_m in zip(self.poses(), distances, strict=False)
        ]


def moments(trace: TraceFile) -> Iterator[Moment]:
    """Every exchange in order, without its pictures' bytes."""
    return moments_of(trace.messages(*EXCHANGE_TOPICS, "/eval"))


def moments_of(found: Iterable[Stored]) -> Iterator[Moment]:
    """Messages of exchanges with the evaluation that follows each."""
    pending: Control | Decision | Sketch | Ladder | None = None
    evaluation: Evaluation | None = None
    for stored in found:
        message = parsed(stored)
        if isinstance(message, Evaluation):
            evaluation = message
            continue
        assert isinstance(message, Control | Decision | Sketch | Ladder)
        if pending is not None:
            yield Moment(pending, _of(pending, evaluation))
        pending, evaluation = message, None
    if pending is not None:
        yield Moment(pending, _of(pending, evaluation))


def _of(message: Message, evaluation: Evaluation | None) -> Evaluation | None:
    """An evaluation whose own exchange was lost belongs to no other."""
    same = evaluation is not None and evaluation.exchange == getattr(message, "exchange", None)
    return evaluation if same else None


def parsed(stored: Stored) -> Message:
    """The message itself; raises `TraceError` where its bytes are none."""
    try:
        return TOPICS[stored.topic].message.FromString(stored.data)
    except DecodeError as error:
        message = f"damaged trace: {stored.topic} {stored.sequence} is no message ({error})"
        raise TraceError(message) from error


def picture_table(message: Message) -> Sequence[Picture]:
    """The pictures that a message names, with where they are stored."""
    return message.pictures if isinstance(message, Control | Decision | Sketch | Evaluation) else ()


def pictures(trace: TraceFile, message: Message) -> dict[str, bytes]:
    """Digest → bytes of the pictures that a message names, b"" where the trace lacks them."""
    return {
        each.sha256: trace.picture(each.topic, each.log_time_ns, each.sha256)
        for each in picture_table(message)
    }
