"""When two traces are the same: (topic, sequence, payload) with every `wall` cleared."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import zip_longest
from typing import Any

from google.protobuf.descriptor import Descriptor
from google.protobuf.message import Message

from c2nav_engine.traces.reader import TraceFile
from c2nav_engine.traces.records import Stored
from c2nav_engine.traces.topics import TOPICS, step_and_exchange

WALL = "wall"


@dataclass(frozen=True, slots=True)
class Difference:
    """Where two traces first part.

    Attributes:
        topic: On which topic.
        sequence: Which message of the topic, from 0.
        step: Low-level step.
        exchange: Exchange of the episode; the unit of replay.
        field: Path of the field within the message ("" when a whole message is missing).
        first: Its value in the first trace, as text.
        second: Its value in the second.
    """

    topic: str
    sequence: int
    step: int
    exchange: int
    field: str
    first: str
    second: str

    def __str__(self) -> str:
        """For a person, on one line."""
        where = f"step {self.step}, exchange {self.exchange}, {self.topic} {self.sequence}"
        return f"{where}, {self.field or 'message'}: {self.first} against {self.second}"


def first_difference(first: TraceFile, second: TraceFile) -> Difference | None:
    """The first message in which two traces differ; None when they are equal.

    Metadata and attachments do not count: a replay has its own run name.
    """
    for a, b in zip_longest(first.messages(), second.messages()):
        found = _stored_difference(a, b)
        if found is not None:
            return found
    return None


def _stored_difference(a: Stored | None, b: Stored | None) -> Difference | None:
    here = a or b
    if here is None or (a is not None and b is not None and _same_bytes(a, b)):
        return None
    step, exchange = step_and_exchange(here.log_time_ns)
    if a is None or b is None or (a.topic, a.sequence) != (b.topic, b.sequence):
        return Difference(here.topic, here.sequence, step, exchange, "", _name(a), _name(b))
    if a.log_time_ns != b.log_time_ns:
        times = (str(a.log_time_ns), str(b.log_time_ns))
        return Difference(a.topic, a.sequence, step, exchange, "log time", *times)
    if a.topic not in TOPICS:
        sizes = (f"{len(a.data)} bytes", f"{len(b.data)} bytes")
        return Difference(a.topic, a.sequence, step, exchange, "payload", *sizes)
    kind = TOPICS[a.topic].message
    found = message_difference(kind.FromString(a.data), kind.FromString(b.data))
    return None if found is None else Difference(a.topic, a.sequence, step, exchange, *found)


def _same_bytes(a: Stored, b: Stored) -> bool:
    return (a.topic, a.sequence, a.log_time_ns, a.data) == (
        b.topic,
        b.sequence,
        b.log_time_ns,
        b.data,
    )


def _name(stored: Stored | None) -> str:
    return "nothing" if stored is None else f"{stored.topic} {stored.sequence}"


# ---------------------------------------------------------------- messages


def clear_wall(message: Message) -> None:
    """Drop every `wall` in a message, at any depth, in place."""
    for field, value in message.ListFields():
        if field.name == WALL:
            message.ClearField(WALL)
        elif field.message_type is not None and _has_wall(field.message_type):
            for each in value if _repeated(field) else (value,):
                clear_wall(each)


@cache
def _has_wall(kind: Descriptor) -> bool:
    return any(
        field.name == WALL or (field.message_type is not None and _has_wall(field.message_type))
        for field in kind.fields
    )


def message_difference(a: Message, b: Message) -> tuple[str, str, str] | None:
    """(field path, value in a, value in b) of the first difference beside `wall`, or None."""
    return next(_differences(a, b, ""), None)


def _differences(a: Message, b: Message, path: str) -> Iterator[tuple[str, str, str]]:
    for field in a.DESCRIPTOR.fields:
        if field.name != WALL:
            yield from _field_differences(a, b, field, path=path)


def _field_differences(
    a: Message, b: Message, field: Any, *, path: str
) -> Iterator[tuple[str, str, str]]:
    name = f"{path}.{field.name}" if path else field.name
    if _repeated(field):
        pairs: Iterator[tuple[Any, Any]] = zip_longest(
            getattr(a, field.name), getattr(b, field.name)
        )
        for index, (x, y) in enumerate(pairs):
            yield from _value_differences(x, y, f"{name}[{index}]")
    else:
        x, y = _value(a, field), _value(b, field)
        yield from _value_differences(x, y, name)


def _value(message: Message, field: Any) -> Any:
    if field.has_presence and not message.HasField(field.name):
        return None
    return getattr(message, field.name)


def _value_differences(x: Any, y: Any, name: str) -> Iterator[tuple[str, str, str]]:
    if isinstance(x, Message) and isinstance(y, Message):
        yield from _differences(x, y, name)
    elif x != y and not (x != x and y != y):
        yield name, _words(x), _words(y)


def _words(value: Any) -> str:
    if value is None:
        return "nothing"
    if isinstance(value, bytes):
        return f"{len(value)} bytes"
    text = str(value).strip().replace("\n", " ")
    return repr(text) if isinstance(value, str) else text


def _repeated(field: Any) -> bool:
    return field.is_repeated
