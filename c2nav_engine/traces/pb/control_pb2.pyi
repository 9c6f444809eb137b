from c2nav_engine.traces.pb import common_pb2 as _common_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class ViewReading(_message.Message):
    __slots__ = ("key", "offset_rad", "picture", "free_m", "depth_median_m", "depth_holes")
    KEY_FIELD_NUMBER: _ClassVar[int]
    OFFSET_RAD_FIELD_NUMBER: _ClassVar[int]
    PICTURE_FIELD_NUMBER: _ClassVar[int]
    FREE_M_FIELD_NUMBER: _ClassVar[int]
    DEPTH_MEDIAN_M_FIELD_NUMBER: _ClassVar[int]
    DEPTH_HOLES_FIELD_NUMBER: _ClassVar[int]
    key: str
    offset_rad: float
    picture: str
    free_m: float
    depth_median_m: float
    depth_holes: float
    def __init__(self, key: _Optional[str] = ..., offset_rad: _Optional[float] = ..., picture: _Optional[str] = ..., free_m: _Optional[float] = ..., depth_median_m: _Optional[float] = ..., depth_holes: _Optional[float] = ...) -> None: ...

class Look(_message.Message):
    __slots__ = ("rig", "views", "odometry", "sectors", "thumbnail")
    RIG_FIELD_NUMBER: _ClassVar[int]
    VIEWS_FIELD_NUMBER: _ClassVar[int]
    ODOMETRY_FIELD_NUMBER: _ClassVar[int]
    SECTORS_FIELD_NUMBER: _ClassVar[int]
    THUMBNAIL_FIELD_NUMBER: _ClassVar[int]
    rig: str
    views: _containers.RepeatedCompositeFieldContainer[ViewReading]
    odometry: _common_pb2.BodyPose
    sectors: _containers.RepeatedScalarFieldContainer[str]
    thumbnail: str
    def __init__(self, rig: _Optional[str] = ..., views: _Optional[_Iterable[_Union[ViewReading, _Mapping]]] = ..., odometry: _Optional[_Union[_common_pb2.BodyPose, _Mapping]] = ..., sectors: _Optional[_Iterable[str]] = ..., thumbnail: _Optional[str] = ...) -> None: ...

class ExecutedStep(_message.Message):
    __slots__ = ("action", "odometry", "moved_m", "collided")
    ACTION_FIELD_NUMBER: _ClassVar[int]
    ODOMETRY_FIELD_NUMBER: _ClassVar[int]
    MOVED_M_FIELD_NUMBER: _ClassVar[int]
    COLLIDED_FIELD_NUMBER: _ClassVar[int]
    action: str
    odometry: _common_pb2.BodyPose
    moved_m: float
    collided: bool
    def __init__(self, action: _Optional[str] = ..., odometry: _Optional[_Union[_common_pb2.BodyPose, _Mapping]] = ..., moved_m: _Optional[float] = ..., collided: _Optional[bool] = ...) -> None: ...

class Move(_message.Message):
    __slots__ = ("actions", "purpose", "steps", "exhausted")
    ACTIONS_FIELD_NUMBER: _ClassVar[int]
    PURPOSE_FIELD_NUMBER: _ClassVar[int]
    STEPS_FIELD_NUMBER: _ClassVar[int]
    EXHAUSTED_FIELD_NUMBER: _ClassVar[int]
    actions: _containers.RepeatedScalarFieldContainer[str]
    purpose: str
    steps: _containers.RepeatedCompositeFieldContainer[ExecutedStep]
    exhausted: bool
    def __init__(self, actions: _Optional[_Iterable[str]] = ..., purpose: _Optional[str] = ..., steps: _Optional[_Iterable[_Union[ExecutedStep, _Mapping]]] = ..., exhausted: _Optional[bool] = ...) -> None: ...

class Event(_message.Message):
    __slots__ = ("name", "detail", "cycle")
    NAME_FIELD_NUMBER: _ClassVar[int]
    DETAIL_FIELD_NUMBER: _ClassVar[int]
    CYCLE_FIELD_NUMBER: _ClassVar[int]
    name: str
    detail: str
    cycle: int
    def __init__(self, name: _Optional[str] = ..., detail: _Optional[str] = ..., cycle: _Optional[int] = ...) -> None: ...

class Stop(_message.Message):
    __slots__ = ()
    def __init__(self) -> None: ...

class Control(_message.Message):
    __slots__ = ("exchange", "step", "look", "move", "event", "stop", "pictures", "wall")
    EXCHANGE_FIELD_NUMBER: _ClassVar[int]
    STEP_FIELD_NUMBER: _ClassVar[int]
    LOOK_FIELD_NUMBER: _ClassVar[int]
    MOVE_FIELD_NUMBER: _ClassVar[int]
    EVENT_FIELD_NUMBER: _ClassVar[int]
    STOP_FIELD_NUMBER: _ClassVar[int]
    PICTURES_FIELD_NUMBER: _ClassVar[int]
    WALL_FIELD_NUMBER: _ClassVar[int]
    exchange: int
    step: int
    look: Look
    move: Move
    event: Event
    stop: Stop
    pictures: _containers.RepeatedCompositeFieldContainer[_common_pb2.Picture]
    wall: _common_pb2.Wall
    def __init__(self, exchange: _Optional[int] = ..., step: _Optional[int] = ..., look: _Optional[_Union[Look, _Mapping]] = ..., move: _Optional[_Union[Move, _Mapping]] = ..., event: _Optional[_Union[Event, _Mapping]] = ..., stop: _Optional[_Union[Stop, _Mapping]] = ..., pictures: _Optional[_Iterable[_Union[_common_pb2.Picture, _Mapping]]] = ..., wall: _Optional[_Union[_common_pb2.Wall, _Mapping]] = ...) -> None: ...
