"""Whether a trace holds what was written, and holds all of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from foxglove_schemas_protobuf.CompressedImage_pb2 import CompressedImage
from mcap.opcode import Opcode

from c2nav_engine.errors import TraceError
from c2nav_engine.traces.moments import parsed, picture_table
from c2nav_engine.traces.pb import control_pb2, decision_pb2, evaluation_pb2, route_pb2
from c2nav_engine.traces.reader import TraceFile
from c2nav_engine.traces.records import (
    Record,
    Stored,
    attachment_of,
    chunk_records,
    data_sums,
    footer_of,
    walk,
)
from c2nav_engine.traces.topics import (
    EXCHANGE_TOPICS,
    IMAGE_TOPICS,
    log_time_ns,
    step_and_exchange,
)

Facts = (
    control_pb2.Control
    | decision_pb2.Decision
    | route_pb2.Sketch
    | route_pb2.Ladder
    | evaluation_pb2.Evaluation
)


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing that is not as it should be.

    Attributes:
        where: Byte, topic or exchange.
        expected: What should be there.
        came: What is there.
    """

    where: str
    expected: str
    came: str

    def __str__(self) -> str:
        """For a person, on one line."""
        return f"{self.where}: expected {self.expected}, came {self.came}"


def check(path: Path) -> list[Fault]:
    """Everything wrong with a trace; an empty list when nothing is.

    Raises `TraceError` where there is no file at all: that is bad input, not a fault of a trace.

    Reads every byte: CRCs of chunks, attachments, data section and index; then the exchanges'
    numbering and every picture's digest. A redacted trace may lack pictures, a recovered one its
    end; both say so in their metadata.
    """
    if not path.is_file():
        message = f"expected a trace file, found none at {path}"
        raise TraceError(message)
    try:
        with TraceFile(path) as trace:
            data = path.read_bytes()
            return [*_section_faults(data), *_record_faults(data), *_content_faults(trace)]
    except TraceError as error:
        return [Fault(path.name, "a readable trace", str(error))]


def data_section_holds(data: bytes) -> bool:
    """Whether the CRC over everything before the index holds."""
    return not list(_section_faults(data))


def _section_faults(data: bytes) -> Iterator[Fault]:
    footer = footer_of(data)
    if footer is None:
        yield Fault("end of file", "the closing record", "none")
        return
    # DataEnd is the last record before the index: opcode, length, CRC.
    end = footer.summary_start - 13
    record = next(walk(data, end), None)
    if record is None or record.opcode != Opcode.DATA_END:
        yield Fault(f"byte {end}", "the end of the data section", "something else")
        return
    written, found = data_sums(data, record)
    if written != found:
        yield Fault("data section", f"CRC {written:08x}", f"{found:08x}")


def _record_faults(data: bytes) -> Iterator[Fault]:
    for record in walk(data):
        try:
            _open(record)
        except TraceError as error:
            yield Fault(f"byte {record.offset}", "an intact record", str(error))


def _open(record: Record) -> None:
    if record.opcode == Opcode.CHUNK:
        chunk_records(record)
    elif record.opcode == Opcode.ATTACHMENT:
        attachment_of(record)


def _content_faults(trace: TraceFile) -> Iterator[Fault]:
    exchanges: list[int] = []
    decisions: list[int] = []
    for stored in trace.messages(*EXCHANGE_TOPICS, "/eval"):
        message = _facts_message(stored)
        if stored.log_time_ns != log_time_ns(message.step, message.exchange):
            where = f"{stored.topic} {stored.sequence}"
            yield Fault(where, "the log time of its step", f"{stored.log_time_ns} ns")
        if not isinstance(message, evaluation_pb2.Evaluation):
            exchanges.append(message.exchange)
        if isinstance(message, decision_pb2.Decision):
            decisions.append(message.decision)
    yield from _numbering(exchanges, "exchange")
    yield from _numbering(decisions, "decision")
    if not trace.complete and trace.facts.get("recovered") != "yes":
        yield Fault("metadata", "a complete trace", "complete: no")
    yield from missing_pictures(trace)


def _facts_message(stored: Stored) -> Facts:
    message = parsed(stored)
    assert isinstance(message, Facts)
    return message


def _numbering(numbers: Sequence[int], what: str) -> Iterator[Fault]:
    for place, number in enumerate(numbers):
        if place != number:
            yield Fault(f"{what} {place}", f"{what}s numbered 0, 1, 2 …", f"{what} {number}")
            return


def missing_pictures(trace: TraceFile) -> Iterator[Fault]:
    """Pictures that an exchange names and the trace does not hold; a redacted one names none."""
    if trace.facts.get("redacted") == "yes":
        return
    held = {
        (stored.topic, stored.log_time_ns, sha256(_image(stored)).hexdigest())
        for stored in trace.messages(*IMAGE_TOPICS)
    }
    named = (
        picture
        for stored in trace.messages(*EXCHANGE_TOPICS, "/eval")
        for picture in picture_table(parsed(stored))
        if picture.topic
    )
    # Many exchanges name the same picture; one that is missing is told once.
    for topic, time_ns, digest in dict.fromkeys(
        (each.topic, each.log_time_ns, each.sha256) for each in named
    ):
        if (topic, time_ns, digest) not in held:
            step, exchange = step_and_exchange(time_ns)
            where = f"{topic} at step {step}, exchange {exchange}"
            yield Fault(where, f"picture {digest[:12]}", "none")


def _image(stored: Stored) -> bytes:
    image = parsed(stored)
    assert isinstance(image, CompressedImage)
    return image.data
