from c2nav_engine.traces.pb import common_pb2 as _common_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Alternative(_message.Message):
    __slots__ = ("key", "text", "picture", "caption")
    KEY_FIELD_NUMBER: _ClassVar[int]
    TEXT_FIELD_NUMBER: _ClassVar[int]
    PICTURE_FIELD_NUMBER: _ClassVar[int]
    CAPTION_FIELD_NUMBER: _ClassVar[int]
    key: str
    text: str
    picture: str
    caption: str
    def __init__(self, key: _Optional[str] = ..., text: _Optional[str] = ..., picture: _Optional[str] = ..., caption: _Optional[str] = ...) -> None: ...

class Context(_message.Message):
    __slots__ = ("words", "picture")
    WORDS_FIELD_NUMBER: _ClassVar[int]
    PICTURE_FIELD_NUMBER: _ClassVar[int]
    words: str
    picture: str
    def __init__(self, words: _Optional[str] = ..., picture: _Optional[str] = ...) -> None: ...

class Question(_message.Message):
    __slots__ = ("slot", "form", "orders", "instruction", "legs", "leg", "alternatives", "shuffle_seed", "template", "sketch", "context")
    SLOT_FIELD_NUMBER: _ClassVar[int]
    FORM_FIELD_NUMBER: _ClassVar[int]
    ORDERS_FIELD_NUMBER: _ClassVar[int]
    INSTRUCTION_FIELD_NUMBER: _ClassVar[int]
    LEGS_FIELD_NUMBER: _ClassVar[int]
    LEG_FIELD_NUMBER: _ClassVar[int]
    ALTERNATIVES_FIELD_NUMBER: _ClassVar[int]
    SHUFFLE_SEED_FIELD_NUMBER: _ClassVar[int]
    TEMPLATE_FIELD_NUMBER: _ClassVar[int]
    SKETCH_FIELD_NUMBER: _ClassVar[int]
    CONTEXT_FIELD_NUMBER: _ClassVar[int]
    slot: str
    form: str
    orders: str
    instruction: str
    legs: _containers.RepeatedScalarFieldContainer[str]
    leg: int
    alternatives: _containers.RepeatedCompositeFieldContainer[Alternative]
    shuffle_seed: str
    template: str
    sketch: str
    context: _containers.RepeatedCompositeFieldContainer[Context]
    def __init__(self, slot: _Optional[str] = ..., form: _Optional[str] = ..., orders: _Optional[str] = ..., instruction: _Optional[str] = ..., legs: _Optional[_Iterable[str]] = ..., leg: _Optional[int] = ..., alternatives: _Optional[_Iterable[_Union[Alternative, _Mapping]]] = ..., shuffle_seed: _Optional[str] = ..., template: _Optional[str] = ..., sketch: _Optional[str] = ..., context: _Optional[_Iterable[_Union[Context, _Mapping]]] = ...) -> None: ...

class Candidate(_message.Message):
    __slots__ = ("key", "feasible", "veto", "free_m", "offset_rad", "picture")
    KEY_FIELD_NUMBER: _ClassVar[int]
    FEASIBLE_FIELD_NUMBER: _ClassVar[int]
    VETO_FIELD_NUMBER: _ClassVar[int]
    FREE_M_FIELD_NUMBER: _ClassVar[int]
    OFFSET_RAD_FIELD_NUMBER: _ClassVar[int]
    PICTURE_FIELD_NUMBER: _ClassVar[int]
    key: str
    feasible: bool
    veto: str
    free_m: float
    offset_rad: float
    picture: str
    def __init__(self, key: _Optional[str] = ..., feasible: _Optional[bool] = ..., veto: _Optional[str] = ..., free_m: _Optional[float] = ..., offset_rad: _Optional[float] = ..., picture: _Optional[str] = ...) -> None: ...

class Facts(_message.Message):
    __slots__ = ("cycle", "leg", "candidates", "odometry", "travelled_m", "leg_travelled_m", "contested", "notes")
    CYCLE_FIELD_NUMBER: _ClassVar[int]
    LEG_FIELD_NUMBER: _ClassVar[int]
    CANDIDATES_FIELD_NUMBER: _ClassVar[int]
    ODOMETRY_FIELD_NUMBER: _ClassVar[int]
    TRAVELLED_M_FIELD_NUMBER: _ClassVar[int]
    LEG_TRAVELLED_M_FIELD_NUMBER: _ClassVar[int]
    CONTESTED_FIELD_NUMBER: _ClassVar[int]
    NOTES_FIELD_NUMBER: _ClassVar[int]
    cycle: int
    leg: int
    candidates: _containers.RepeatedCompositeFieldContainer[Candidate]
    odometry: _common_pb2.BodyPose
    travelled_m: float
    leg_travelled_m: float
    contested: str
    notes: _containers.RepeatedCompositeFieldContainer[_common_pb2.Text]
    def __init__(self, cycle: _Optional[int] = ..., leg: _Optional[int] = ..., candidates: _Optional[_Iterable[_Union[Candidate, _Mapping]]] = ..., odometry: _Optional[_Union[_common_pb2.BodyPose, _Mapping]] = ..., travelled_m: _Optional[float] = ..., leg_travelled_m: _Optional[float] = ..., contested: _Optional[str] = ..., notes: _Optional[_Iterable[_Union[_common_pb2.Text, _Mapping]]] = ...) -> None: ...

class Part(_message.Message):
    __slots__ = ("text", "picture")
    TEXT_FIELD_NUMBER: _ClassVar[int]
    PICTURE_FIELD_NUMBER: _ClassVar[int]
    text: str
    picture: str
    def __init__(self, text: _Optional[str] = ..., picture: _Optional[str] = ...) -> None: ...

class Label(_message.Message):
    __slots__ = ("label", "key")
    LABEL_FIELD_NUMBER: _ClassVar[int]
    KEY_FIELD_NUMBER: _ClassVar[int]
    label: str
    key: str
    def __init__(self, label: _Optional[str] = ..., key: _Optional[str] = ...) -> None: ...

class Query(_message.Message):
    __slots__ = ("parts", "labels", "form", "repair", "order", "template_sha256", "request_sha256", "text", "known", "model", "outcome", "wall")
    PARTS_FIELD_NUMBER: _ClassVar[int]
    LABELS_FIELD_NUMBER: _ClassVar[int]
    FORM_FIELD_NUMBER: _ClassVar[int]
    REPAIR_FIELD_NUMBER: _ClassVar[int]
    ORDER_FIELD_NUMBER: _ClassVar[int]
    TEMPLATE_SHA256_FIELD_NUMBER: _ClassVar[int]
    REQUEST_SHA256_FIELD_NUMBER: _ClassVar[int]
    TEXT_FIELD_NUMBER: _ClassVar[int]
    KNOWN_FIELD_NUMBER: _ClassVar[int]
    MODEL_FIELD_NUMBER: _ClassVar[int]
    OUTCOME_FIELD_NUMBER: _ClassVar[int]
    WALL_FIELD_NUMBER: _ClassVar[int]
    parts: _containers.RepeatedCompositeFieldContainer[Part]
    labels: _containers.RepeatedCompositeFieldContainer[Label]
    form: str
    repair: int
    order: int
    template_sha256: str
    request_sha256: str
    text: str
    known: _common_pb2.Outcome
    model: str
    outcome: _common_pb2.Outcome
    wall: QueryWall
    def __init__(self, parts: _Optional[_Iterable[_Union[Part, _Mapping]]] = ..., labels: _Optional[_Iterable[_Union[Label, _Mapping]]] = ..., form: _Optional[str] = ..., repair: _Optional[int] = ..., order: _Optional[int] = ..., template_sha256: _Optional[str] = ..., request_sha256: _Optional[str] = ..., text: _Optional[str] = ..., known: _Optional[_Union[_common_pb2.Outcome, _Mapping]] = ..., model: _Optional[str] = ..., outcome: _Optional[_Union[_common_pb2.Outcome, _Mapping]] = ..., wall: _Optional[_Union[QueryWall, _Mapping]] = ...) -> None: ...

class QueryWall(_message.Message):
    __slots__ = ("latency_s", "tokens_in", "tokens_out", "cost_usd", "cached", "retry_after_s")
    LATENCY_S_FIELD_NUMBER: _ClassVar[int]
    TOKENS_IN_FIELD_NUMBER: _ClassVar[int]
    TOKENS_OUT_FIELD_NUMBER: _ClassVar[int]
    COST_USD_FIELD_NUMBER: _ClassVar[int]
    CACHED_FIELD_NUMBER: _ClassVar[int]
    RETRY_AFTER_S_FIELD_NUMBER: _ClassVar[int]
    latency_s: float
    tokens_in: int
    tokens_out: int
    cost_usd: float
    cached: bool
    retry_after_s: float
    def __init__(self, latency_s: _Optional[float] = ..., tokens_in: _Optional[int] = ..., tokens_out: _Optional[int] = ..., cost_usd: _Optional[float] = ..., cached: _Optional[bool] = ..., retry_after_s: _Optional[float] = ...) -> None: ...

class Ranked(_message.Message):
    __slots__ = ("ranker", "privileged", "outcome", "queries")
    RANKER_FIELD_NUMBER: _ClassVar[int]
    PRIVILEGED_FIELD_NUMBER: _ClassVar[int]
    OUTCOME_FIELD_NUMBER: _ClassVar[int]
    QUERIES_FIELD_NUMBER: _ClassVar[int]
    ranker: str
    privileged: bool
    outcome: _common_pb2.Outcome
    queries: _containers.RepeatedCompositeFieldContainer[Query]
    def __init__(self, ranker: _Optional[str] = ..., privileged: _Optional[bool] = ..., outcome: _Optional[_Union[_common_pb2.Outcome, _Mapping]] = ..., queries: _Optional[_Iterable[_Union[Query, _Mapping]]] = ...) -> None: ...

class Override(_message.Message):
    __slots__ = ("who", "why", "outcome", "wall")
    WHO_FIELD_NUMBER: _ClassVar[int]
    WHY_FIELD_NUMBER: _ClassVar[int]
    OUTCOME_FIELD_NUMBER: _ClassVar[int]
    WALL_FIELD_NUMBER: _ClassVar[int]
    who: str
    why: str
    outcome: _common_pb2.Outcome
    wall: OverrideWall
    def __init__(self, who: _Optional[str] = ..., why: _Optional[str] = ..., outcome: _Optional[_Union[_common_pb2.Outcome, _Mapping]] = ..., wall: _Optional[_Union[OverrideWall, _Mapping]] = ...) -> None: ...

class OverrideWall(_message.Message):
    __slots__ = ("when_s",)
    WHEN_S_FIELD_NUMBER: _ClassVar[int]
    when_s: float
    def __init__(self, when_s: _Optional[float] = ...) -> None: ...

class Decision(_message.Message):
    __slots__ = ("exchange", "step", "decision", "slot", "facts", "question", "ranked", "override", "by", "committed", "elected", "pictures", "wall")
    EXCHANGE_FIELD_NUMBER: _ClassVar[int]
    STEP_FIELD_NUMBER: _ClassVar[int]
    DECISION_FIELD_NUMBER: _ClassVar[int]
    SLOT_FIELD_NUMBER: _ClassVar[int]
    FACTS_FIELD_NUMBER: _ClassVar[int]
    QUESTION_FIELD_NUMBER: _ClassVar[int]
    RANKED_FIELD_NUMBER: _ClassVar[int]
    OVERRIDE_FIELD_NUMBER: _ClassVar[int]
    BY_FIELD_NUMBER: _ClassVar[int]
    COMMITTED_FIELD_NUMBER: _ClassVar[int]
    ELECTED_FIELD_NUMBER: _ClassVar[int]
    PICTURES_FIELD_NUMBER: _ClassVar[int]
    WALL_FIELD_NUMBER: _ClassVar[int]
    exchange: int
    step: int
    decision: int
    slot: str
    facts: Facts
    question: Question
    ranked: Ranked
    override: Override
    by: str
    committed: _common_pb2.Outcome
    elected: str
    pictures: _containers.RepeatedCompositeFieldContainer[_common_pb2.Picture]
    wall: _common_pb2.Wall
    def __init__(self, exchange: _Optional[int] = ..., step: _Optional[int] = ..., decision: _Optional[int] = ..., slot: _Optional[str] = ..., facts: _Optional[_Union[Facts, _Mapping]] = ..., question: _Optional[_Union[Question, _Mapping]] = ..., ranked: _Optional[_Union[Ranked, _Mapping]] = ..., override: _Optional[_Union[Override, _Mapping]] = ..., by: _Optional[str] = ..., committed: _Optional[_Union[_common_pb2.Outcome, _Mapping]] = ..., elected: _Optional[str] = ..., pictures: _Optional[_Iterable[_Union[_common_pb2.Picture, _Mapping]]] = ..., wall: _Optional[_Union[_common_pb2.Wall, _Mapping]] = ...) -> None: ...
