"""Records an episode: exchanges in, a crash-safe trace out."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType

from c2nav_engine.contract.question import Picture, Slot
from c2nav_engine.errors import InternalError
from c2nav_engine.navigator.requests import Ask, Look, Request, Rig, Seen
from c2nav_engine.runner.exchange import Exchange, Truth
from c2nav_engine.runner.record import Footer, Header
from c2nav_engine.runner.trace_draft import Draft, Places
from c2nav_engine.runner.trace_header import footer_facts, header_facts, header_files
from c2nav_engine.runner.trace_messages import exchange_message
from c2nav_engine.runner.trace_views import Views
from c2nav_engine.traces.attachments import LAYOUT_FILE, foxglove_layout
from c2nav_engine.traces.contract_messages import pose_message
from c2nav_engine.traces.pb.evaluation_pb2 import Evaluation
from c2nav_engine.traces.topics import THUMBNAIL_TOPIC, log_time_ns
from c2nav_engine.traces.writer import TraceFileWriter


class TraceWriter:
    """A trace under construction; every written exchange survives a kill.

    Leaving the context without `finish` leaves `PATH.part`, which `recover` reads.

    Args:
        path: Where the finished trace will stand.
        header: What is known before the first request.
        fsync: Also survive a power failure (about 0.6 ms more an exchange).
    """

    def __init__(self, path: Path, header: Header, *, fsync: bool = False) -> None:
        self._places: Places = {}
        self._views = Views(header.profile)
        self._next = 0
        self._file = TraceFileWriter(path, header_facts(header), fsync=fsync)
        for name, data in header_files(header).items():
            self.attach(name, data)
        self._file.attach(LAYOUT_FILE, foxglove_layout(), media_type="application/json")

    def write(self, exchange: Exchange) -> None:
        """Append the next exchange; when this returns, the operating system has it."""
        if exchange.index != self._next:
            message = f"expected exchange {self._next}, came {exchange.index}"
            raise InternalError(message)
        self._next += 1
        draft = Draft(self._places, log_time_ns(exchange.step, exchange.index))
        _store_pictures(exchange, draft)
        # A look's own topics have taken what is worth keeping; a decision keeps all it shows.
        keep = draft.name if isinstance(exchange.request, Look) else draft.keep
        draft.add(*exchange_message(exchange, keep))
        if exchange.truth is not None:
            draft.add("/eval", _evaluation(exchange, exchange.truth, draft))
        self._file.append([*draft.messages, *self._views.of(exchange)])

    def attach(self, name: str, data: bytes) -> None:
        """Keep a file beside the exchanges; its ending says what it is."""
        kind = "application/json" if name.endswith(".json") else "text/plain"
        self._file.attach(name, data, media_type=kind)

    def finish(self, footer: Footer) -> str:
        """Complete the trace, give it its name and return its SHA-256."""
        return self._file.finish(footer_facts(footer))

    def abandon(self) -> None:
        """Stop here and leave the `.part` for `recover`; idempotent."""
        self._file.abandon()

    def __enter__(self) -> TraceWriter:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.abandon()


def _store_pictures(exchange: Exchange, draft: Draft) -> None:
    """Put pictures on the topics that viewers know."""
    if isinstance(exchange.response, Seen):
        _store_look(exchange.request, exchange.response, draft)
    elif isinstance(exchange.request, Ask) and exchange.request.question.slot is Slot.LOOKBACK:
        # Both frames were stored when they were seen; here a viewer gets them side by side.
        for each in exchange.request.question.alternatives:
            if each.picture is not None and each.picture.jpeg and each.key in ("now", "back"):
                _show_again(each.picture, f"/lookback/{each.key}", draft)


def _show_again(picture: Picture, topic: str, draft: Draft) -> None:
    if not draft.store(picture, topic):
        draft.show(picture, topic)


def _store_look(request: Request, seen: Seen, draft: Draft) -> None:
    if not (isinstance(request, Look) and request.rig is Rig.RING):
        # The ring's twelve views are kept as digests: no question shows one but in its sector.
        for view in seen.views:
            draft.store(view.picture, f"/view/{view.key}")
    for place, sector in enumerate(seen.sectors):
        draft.store(sector, f"/glance/{place}")
    if seen.thumbnail is not None:
        draft.store(seen.thumbnail, THUMBNAIL_TOPIC)


def _evaluation(exchange: Exchange, truth: Truth, draft: Draft) -> Evaluation:
    return Evaluation(
        exchange=exchange.index,
        step=exchange.step,
        poses=[pose_message(pose) for pose in truth.poses],
        goal_distances_m=truth.goal_distances_m,
        depth=draft.keep_depth(truth.depth_png),
    )
