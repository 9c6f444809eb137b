from c2nav_engine.traces.pb import common_pb2 as _common_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Evaluation(_message.Message):
    __slots__ = ("exchange", "step", "poses", "goal_distances_m", "depth", "pictures", "wall")
    EXCHANGE_FIELD_NUMBER: _ClassVar[int]
    STEP_FIELD_NUMBER: _ClassVar[int]
    POSES_FIELD_NUMBER: _ClassVar[int]
    GOAL_DISTANCES_M_FIELD_NUMBER: _ClassVar[int]
    DEPTH_FIELD_NUMBER: _ClassVar[int]
    PICTURES_FIELD_NUMBER: _ClassVar[int]
    WALL_FIELD_NUMBER: _ClassVar[int]
    exchange: int
    step: int
    poses: _containers.RepeatedCompositeFieldContainer[_common_pb2.BodyPose]
    goal_distances_m: _containers.RepeatedScalarFieldContainer[float]
    depth: str
    pictures: _containers.RepeatedCompositeFieldContainer[_common_pb2.Picture]
    wall: _common_pb2.Wall
    def __init__(self, exchange: _Optional[int] = ..., step: _Optional[int] = ..., poses: _Optional[_Iterable[_Union[_common_pb2.BodyPose, _Mapping]]] = ..., goal_distances_m: _Optional[_Iterable[float]] = ..., depth: _Optional[str] = ..., pictures: _Optional[_Iterable[_Union[_common_pb2.Picture, _Mapping]]] = ..., wall: _Optional[_Union[_common_pb2.Wall, _Mapping]] = ...) -> None: ...
