"""The topics of a trace: their message types, their lane in the file, and their time.

Lanes keep light facts apart from heavy pictures, so that reading every decision of a trace touches
a few percent of its bytes (docs/traces.md).
"""

from __future__ import annotations

import enum
from dataclasses import dataclass
from functools import cache
from typing import Any

from foxglove_schemas_protobuf.CameraCalibration_pb2 import CameraCalibration
from foxglove_schemas_protobuf.CompressedImage_pb2 import CompressedImage
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.PoseInFrame_pb2 import PoseInFrame
from foxglove_schemas_protobuf.PosesInFrame_pb2 import PosesInFrame
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from google.protobuf.message import Message

from c2nav_engine.traces.pb.control_pb2 import Control
from c2nav_engine.traces.pb.decision_pb2 import Decision
from c2nav_engine.traces.pb.evaluation_pb2 import Evaluation
from c2nav_engine.traces.pb.review_pb2 import Review
from c2nav_engine.traces.pb.route_pb2 import Ladder, Sketch

SCHEMA_VERSION = 1
"""Raised when a reader of the old version would misread the new one; added fields do not."""

EPOCH_NS = 1_767_225_600_000_000_000
"""2026-01-01T00:00:00Z: where every episode's log time begins, so that equal runs are equal."""

STEP_NS = 1_000_000_000
"""Log time of one low-level action: second 37 of a viewer's clock is step 37."""

EXCHANGE_NS = 1_000
"""Exchanges within one step stay in order, and each log time names one exchange."""


METADATA = "c2nav"
"""The metadata record of a trace."""

STARTED = "c2nav.started"
"""The same facts as far as they were known before the first step; what `recover` builds on."""


class Lane(enum.IntEnum):
    """What is read together lies together; in the order in which a finished file holds them.

    Words come first, so that a file cut short by a broken copy still tells the whole story.
    """

    FACTS = 0
    DECISIONS = 1
    THUMBNAILS = 2
    PICTURES = 3
    DEPTH = 4


@dataclass(frozen=True, slots=True)
class Topic:
    """A message type and its lane."""

    message: type[Message]
    lane: Lane


PICTURE_TOPICS = (
    *(f"/view/{key}" for key in ("left", "front", "right")),
    *(f"/glance/{sector}" for sector in range(6)),
    *(f"/lookback/{key}" for key in ("now", "back")),
    "/picture",
)
"""`/picture` takes whatever a decision shows that no other topic holds."""

DEPTH_TOPIC = "/depth/front"
THUMBNAIL_TOPIC = "/thumbnail"
IMAGE_TOPICS = (*PICTURE_TOPICS, DEPTH_TOPIC, THUMBNAIL_TOPIC)

EXCHANGE_TOPICS = ("/control", "/decision", "/sketch", "/ladder")
"""Each exchange is one message on one of these."""

TOPICS: dict[str, Topic] = {
    # First what an exchange is, then what is known of it, then what illustrates it: messages of
    # one log time are told in this order, so that a difference is named by its cause.
    "/control": Topic(Control, Lane.FACTS),
    "/decision": Topic(Decision, Lane.DECISIONS),
    "/sketch": Topic(Sketch, Lane.FACTS),
    "/ladder": Topic(Ladder, Lane.FACTS),
    "/eval": Topic(Evaluation, Lane.FACTS),
    "/review": Topic(Review, Lane.FACTS),
    **{topic: Topic(CompressedImage, Lane.PICTURES) for topic in PICTURE_TOPICS},
    THUMBNAIL_TOPIC: Topic(CompressedImage, Lane.THUMBNAILS),
    DEPTH_TOPIC: Topic(CompressedImage, Lane.DEPTH),
    "/calibration": Topic(CameraCalibration, Lane.FACTS),
    "/tf": Topic(FrameTransforms, Lane.FACTS),
    "/pose": Topic(PoseInFrame, Lane.FACTS),
    "/path": Topic(PosesInFrame, Lane.FACTS),
    "/log": Topic(Log, Lane.FACTS),
}

_RANKS = {topic: rank for rank, topic in enumerate(TOPICS)}


def rank_of(topic: str) -> int:
    """Place of a topic among messages of one log time."""
    return _RANKS.get(topic, len(_RANKS))


def log_time_ns(step: int, exchange: int) -> int:
    """When an exchange happened, on the episode's own clock."""
    return EPOCH_NS + step * STEP_NS + exchange * EXCHANGE_NS


def step_and_exchange(time_ns: int) -> tuple[int, int]:
    """The step and the exchange that a log time stands for."""
    step, rest = divmod(time_ns - EPOCH_NS, STEP_NS)
    return step, rest // EXCHANGE_NS


@cache
def schema_bytes(message: type[Message]) -> bytes:
    """The self-contained schema of a message type, as MCAP files carry it."""
    # protobuf has two descriptor classes, one per backend, and names neither in its stubs' unions.
    files: dict[str, Any] = {}

    def add(file: Any) -> None:
        for dependency in file.dependencies:
            add(dependency)
        files.setdefault(file.name, file)

    add(message.DESCRIPTOR.file)
    described = FileDescriptorSet()
    for file in files.values():
        file.CopyToProto(described.file.add())
    return described.SerializeToString()
