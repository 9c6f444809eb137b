from c2nav_engine.traces.pb import common_pb2 as _common_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Sketch(_message.Message):
    __slots__ = ("exchange", "step", "cycle", "entry_leg", "displacement_right_m", "displacement_forward_m", "elapsed_steps", "turning", "words", "cue", "thumbnail", "rendering", "support", "leg", "advanced", "gate_open", "pictures", "wall")
    EXCHANGE_FIELD_NUMBER: _ClassVar[int]
    STEP_FIELD_NUMBER: _ClassVar[int]
    CYCLE_FIELD_NUMBER: _ClassVar[int]
    ENTRY_LEG_FIELD_NUMBER: _ClassVar[int]
    DISPLACEMENT_RIGHT_M_FIELD_NUMBER: _ClassVar[int]
    DISPLACEMENT_FORWARD_M_FIELD_NUMBER: _ClassVar[int]
    ELAPSED_STEPS_FIELD_NUMBER: _ClassVar[int]
    TURNING_FIELD_NUMBER: _ClassVar[int]
    WORDS_FIELD_NUMBER: _ClassVar[int]
    CUE_FIELD_NUMBER: _ClassVar[int]
    THUMBNAIL_FIELD_NUMBER: _ClassVar[int]
    RENDERING_FIELD_NUMBER: _ClassVar[int]
    SUPPORT_FIELD_NUMBER: _ClassVar[int]
    LEG_FIELD_NUMBER: _ClassVar[int]
    ADVANCED_FIELD_NUMBER: _ClassVar[int]
    GATE_OPEN_FIELD_NUMBER: _ClassVar[int]
    PICTURES_FIELD_NUMBER: _ClassVar[int]
    WALL_FIELD_NUMBER: _ClassVar[int]
    exchange: int
    step: int
    cycle: int
    entry_leg: int
    displacement_right_m: float
    displacement_forward_m: float
    elapsed_steps: int
    turning: str
    words: str
    cue: str
    thumbnail: str
    rendering: str
    support: int
    leg: int
    advanced: bool
    gate_open: bool
    pictures: _containers.RepeatedCompositeFieldContainer[_common_pb2.Picture]
    wall: _common_pb2.Wall
    def __init__(self, exchange: _Optional[int] = ..., step: _Optional[int] = ..., cycle: _Optional[int] = ..., entry_leg: _Optional[int] = ..., displacement_right_m: _Optional[float] = ..., displacement_forward_m: _Optional[float] = ..., elapsed_steps: _Optional[int] = ..., turning: _Optional[str] = ..., words: _Optional[str] = ..., cue: _Optional[str] = ..., thumbnail: _Optional[str] = ..., rendering: _Optional[str] = ..., support: _Optional[int] = ..., leg: _Optional[int] = ..., advanced: _Optional[bool] = ..., gate_open: _Optional[bool] = ..., pictures: _Optional[_Iterable[_Union[_common_pb2.Picture, _Mapping]]] = ..., wall: _Optional[_Union[_common_pb2.Wall, _Mapping]] = ...) -> None: ...

class Marker(_message.Message):
    __slots__ = ("odometry", "score", "cycle", "path_m")
    ODOMETRY_FIELD_NUMBER: _ClassVar[int]
    SCORE_FIELD_NUMBER: _ClassVar[int]
    CYCLE_FIELD_NUMBER: _ClassVar[int]
    PATH_M_FIELD_NUMBER: _ClassVar[int]
    odometry: _common_pb2.BodyPose
    score: int
    cycle: int
    path_m: float
    def __init__(self, odometry: _Optional[_Union[_common_pb2.BodyPose, _Mapping]] = ..., score: _Optional[int] = ..., cycle: _Optional[int] = ..., path_m: _Optional[float] = ...) -> None: ...

class Ladder(_message.Message):
    __slots__ = ("exchange", "step", "cycle", "ground", "journey", "lookback", "verdict", "vetoes", "budget", "markers", "event", "wall")
    EXCHANGE_FIELD_NUMBER: _ClassVar[int]
    STEP_FIELD_NUMBER: _ClassVar[int]
    CYCLE_FIELD_NUMBER: _ClassVar[int]
    GROUND_FIELD_NUMBER: _ClassVar[int]
    JOURNEY_FIELD_NUMBER: _ClassVar[int]
    LOOKBACK_FIELD_NUMBER: _ClassVar[int]
    VERDICT_FIELD_NUMBER: _ClassVar[int]
    VETOES_FIELD_NUMBER: _ClassVar[int]
    BUDGET_FIELD_NUMBER: _ClassVar[int]
    MARKERS_FIELD_NUMBER: _ClassVar[int]
    EVENT_FIELD_NUMBER: _ClassVar[int]
    WALL_FIELD_NUMBER: _ClassVar[int]
    exchange: int
    step: int
    cycle: int
    ground: int
    journey: int
    lookback: int
    verdict: str
    vetoes: _containers.RepeatedScalarFieldContainer[str]
    budget: int
    markers: _containers.RepeatedCompositeFieldContainer[Marker]
    event: str
    wall: _common_pb2.Wall
    def __init__(self, exchange: _Optional[int] = ..., step: _Optional[int] = ..., cycle: _Optional[int] = ..., ground: _Optional[int] = ..., journey: _Optional[int] = ..., lookback: _Optional[int] = ..., verdict: _Optional[str] = ..., vetoes: _Optional[_Iterable[str]] = ..., budget: _Optional[int] = ..., markers: _Optional[_Iterable[_Union[Marker, _Mapping]]] = ..., event: _Optional[str] = ..., wall: _Optional[_Union[_common_pb2.Wall, _Mapping]] = ...) -> None: ...
