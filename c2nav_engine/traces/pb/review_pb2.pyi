from c2nav_engine.traces.pb import common_pb2 as _common_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Review(_message.Message):
    __slots__ = ("id", "trace_sha256", "decision", "author", "kind", "outcome", "reason", "blind", "model_seen", "target", "extra", "wall")
    ID_FIELD_NUMBER: _ClassVar[int]
    TRACE_SHA256_FIELD_NUMBER: _ClassVar[int]
    DECISION_FIELD_NUMBER: _ClassVar[int]
    AUTHOR_FIELD_NUMBER: _ClassVar[int]
    KIND_FIELD_NUMBER: _ClassVar[int]
    OUTCOME_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    BLIND_FIELD_NUMBER: _ClassVar[int]
    MODEL_SEEN_FIELD_NUMBER: _ClassVar[int]
    TARGET_FIELD_NUMBER: _ClassVar[int]
    EXTRA_FIELD_NUMBER: _ClassVar[int]
    WALL_FIELD_NUMBER: _ClassVar[int]
    id: str
    trace_sha256: str
    decision: int
    author: str
    kind: str
    outcome: _common_pb2.Outcome
    reason: str
    blind: bool
    model_seen: bool
    target: str
    extra: _containers.RepeatedCompositeFieldContainer[_common_pb2.Text]
    wall: ReviewWall
    def __init__(self, id: _Optional[str] = ..., trace_sha256: _Optional[str] = ..., decision: _Optional[int] = ..., author: _Optional[str] = ..., kind: _Optional[str] = ..., outcome: _Optional[_Union[_common_pb2.Outcome, _Mapping]] = ..., reason: _Optional[str] = ..., blind: _Optional[bool] = ..., model_seen: _Optional[bool] = ..., target: _Optional[str] = ..., extra: _Optional[_Iterable[_Union[_common_pb2.Text, _Mapping]]] = ..., wall: _Optional[_Union[ReviewWall, _Mapping]] = ...) -> None: ...

class ReviewWall(_message.Message):
    __slots__ = ("when_s",)
    WHEN_S_FIELD_NUMBER: _ClassVar[int]
    when_s: float
    def __init__(self, when_s: _Optional[float] = ...) -> None: ...
