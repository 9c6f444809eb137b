"""Reads a trace back as what was recorded: exchanges, header, footer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import TracebackType

from google.protobuf.message import Message

from c2nav_engine.contract.question import Picture
from c2nav_engine.errors import TraceError
from c2nav_engine.runner.exchange import Exchange, Truth
from c2nav_engine.runner.record import Footer, Header
from c2nav_engine.runner.trace_exchanges import exchange_of, truth_of
from c2nav_engine.runner.trace_header import footer_of, header_of
from c2nav_engine.traces.check import data_section_holds
from c2nav_engine.traces.contract_messages import Show
from c2nav_engine.traces.moments import moments_of, parsed, picture_table
from c2nav_engine.traces.pb.common_pb2 import Picture as PictureMessage
from c2nav_engine.traces.pb.evaluation_pb2 import Evaluation
from c2nav_engine.traces.reader import TraceFile
from c2nav_engine.traces.records import Stored
from c2nav_engine.traces.topics import EXCHANGE_TOPICS


@dataclass(frozen=True, slots=True)
class Trace:
    """A whole trace in memory.

    Attributes:
        header: What was known before the first request.
        exchanges: Everything that happened; equal to what was written, but for pictures that the
            trace holds as digests only: their `jpeg` is empty.
        footer: How it ended.
        sha256: Digest of the file.
        complete: Whether the run wrote it to its end; a recovered trace is its unbroken beginning.
        path: The file.
    """

    header: Header
    exchanges: tuple[Exchange, ...]
    footer: Footer
    sha256: str
    complete: bool
    path: Path


def read_trace(path: Path) -> Trace:
    """Read and verify a whole trace.

    Raises:
        UnfinishedTrace: It lacks its closing record.
        TraceError: It is no trace, or is damaged.
    """
    with open_trace(path) as trace:
        if not data_section_holds(path.read_bytes()):
            message = (
                f"damaged trace: {path} does not hold what was written; `c2nav trace check` says "
                "where, `c2nav trace recover` saves what is intact"
            )
            raise TraceError(message)
        return Trace(
            header=trace.header,
            exchanges=tuple(trace.exchanges(pictures=True)),
            footer=trace.footer,
            sha256=trace.sha256,
            complete=trace.complete,
            path=path,
        )


def open_trace(path: Path) -> OpenTrace:
    """Open a trace for reading bit by bit; raises as `read_trace`, damage only where it is met."""
    return OpenTrace(TraceFile(path))


class OpenTrace:
    """A trace on disk; pictures and exchanges are read when asked for."""

    def __init__(self, file: TraceFile) -> None:
        self.file = file
        self._decision_times_ns = file.times_ns("/decision")

    @property
    def path(self) -> Path:
        """The file."""
        return self.file.path

    @property
    def sha256(self) -> str:
        """Digest of the file."""
        return self.file.sha256

    @property
    def complete(self) -> bool:
        """Whether the run wrote it to its end."""
        return self.file.complete

    @cached_property
    def header(self) -> Header:
        """What was known before the first request."""
        return header_of({name: self.file.attachment(name) for name in self.file.attachments})

    @cached_property
    def footer(self) -> Footer:
        """How it ended."""
        return footer_of(self.file.facts)

    @property
    def decision_count(self) -> int:
        """Decisions in the trace."""
        return len(self._decision_times_ns)

    def decisions(self) -> Iterator[Exchange]:
        """Every decision without its pictures' bytes (`jpeg` is empty): a few percent to read."""
        return self._read(self.file.messages("/decision"), pictures=False)

    def decision(self, number: int) -> Exchange:
        """One decision with its pictures; raises `TraceError` when it is not there."""
        if not 0 <= number < self.decision_count:
            message = f"expected a decision from 0 to {self.decision_count - 1}, came {number}"
            raise TraceError(message)
        stored = self.file.at("/decision", self._decision_times_ns[number])
        return next(self._read(stored, pictures=True))

    def exchanges(self, *, pictures: bool = False) -> Iterator[Exchange]:
        """Everything that happened, in order; ends at the first gap of a recovered trace."""
        found = self._read(self.file.messages(*EXCHANGE_TOPICS, "/eval"), pictures=pictures)
        for place, exchange in enumerate(found):
            if exchange.index != place:
                if self.complete:
                    message = (
                        f"damaged trace: {self.path} holds exchange {exchange.index} where "
                        f"{place} should be"
                    )
                    raise TraceError(message)
                return
            yield exchange

    @cached_property
    def _places(self) -> dict[str, PictureMessage]:
        """Where every picture lies, from the facts alone."""
        places: dict[str, PictureMessage] = {}
        for stored in self.file.messages(*EXCHANGE_TOPICS, "/eval"):
            for each in picture_table(parsed(stored)):
                if each.topic:
                    places.setdefault(each.sha256, each)
        return places

    def picture(self, sha256: str) -> bytes:
        """A picture's bytes by their digest; raises `TraceError` when they are not here."""
        place = self._places.get(sha256)
        data = b"" if place is None else self._bytes(place)
        if not data:
            message = f"{self.path} does not hold picture {sha256 or '(no digest)'}"
            raise TraceError(message)
        return data

    def _bytes(self, place: PictureMessage) -> bytes:
        return self.file.picture(place.topic, place.log_time_ns, place.sha256)

    def _read(self, found: Iterable[Stored], *, pictures: bool) -> Iterator[Exchange]:
        shared: dict[str, Picture] = {}
        for moment in moments_of(found):
            show = self._show(moment.message, shared, pictures=pictures)
            yield exchange_of(
                moment.message, self._truth(moment.evaluation, pictures=pictures), show
            )

    def _truth(self, message: Evaluation | None, *, pictures: bool) -> Truth | None:
        if message is None:
            return None
        return truth_of(message, self._depth(message, pictures=pictures))

    def _depth(self, message: Evaluation, *, pictures: bool) -> bytes:
        places = {each.sha256: each for each in message.pictures}
        place = places.get(message.depth)
        return self._bytes(place) if pictures and place is not None else b""

    def _show(self, message: Message, shared: dict[str, Picture], *, pictures: bool) -> Show:
        places = {each.sha256: each for each in picture_table(message)}

        def show(digest: str) -> Picture | None:
            if not digest:
                return None
            # What was first seen as a digest only may be stored later, when a question shows it.
            if digest not in shared or not shared[digest].jpeg:
                place = places[digest]
                jpeg = self._bytes(place) if pictures else b""
                shared[digest] = Picture(jpeg, digest, place.width_px, place.height_px)
            return shared[digest]

        return show

    def close(self) -> None:
        """Close the file; idempotent."""
        self.file.close()

    def __enter__(self) -> OpenTrace:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
