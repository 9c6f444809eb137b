"""One episode with its shell, advanced one request at a time.

Batch runs, the inspector, forks and re-runs all drive this object; nobody else answers the core.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from c2nav_engine.contract.prompt import Ranked
from c2nav_engine.contract.question import Question
from c2nav_engine.errors import InternalError, RankerUnavailable
from c2nav_engine.navigator.loop import Loop
from c2nav_engine.navigator.requests import Ask, Look, Move, Note, Request, Response, Stop, Unasked
from c2nav_engine.navigator.state import Ending
from c2nav_engine.rankers.protocol import Counting, Ranker
from c2nav_engine.rankers.tally import Telling
from c2nav_engine.runner.exchange import Exchange, Override, Truth
from c2nav_engine.runner.record import EpisodeOutcome, Footer, Header
from c2nav_engine.runner.shell import Shell
from c2nav_engine.world.scene import Scene
from c2nav_engine.world.surface import Surface


@runtime_checkable
class Recorder(Protocol):
    """Where exchanges go as they happen: a trace file, or nothing."""

    def write(self, exchange: Exchange) -> None:
        """One exchange is finished."""
        ...

    def finish(self, footer: Footer) -> str:
        """The episode is over; returns the trace's sha256."""
        ...

    def attach(self, name: str, data: bytes) -> None:
        """Keep a file beside the exchanges."""
        ...

    def abandon(self) -> None:
        """Leave what is written, unfinished and recoverable."""
        ...


Score = Callable[[Sequence[Exchange], EpisodeOutcome], Mapping[str, float | int | None]]
"""Metrics of a finished episode; the run's shell alone may measure them."""

BeforeAsk = Callable[[Ask, Sequence[Exchange]], None]
"""Told about every question before the ranker is: how a privileged observer learns the truth."""


@dataclass(frozen=True, slots=True)
class Parts:
    """Everything an `EpisodeRun` is put together from.

    Attributes:
        header: What is known before the first request.
        loop: The core, not yet started.
        shell: Answers looks and moves.
        ranker: Answers questions; None when only a person does.
        recorder: Where exchanges go, or None.
        score: Metrics at the end, or None where nothing can be measured.
        before_ask: Told about questions first, or None.
        scene: What is rendered, for viewers; None in playback.
        surface: The floor, for viewers; None in playback.
        trace: Path of the trace that the recorder writes; "" without one.
    """

    header: Header
    loop: Loop
    shell: Shell
    ranker: Ranker | None = None
    recorder: Recorder | None = None
    score: Score | None = None
    before_ask: BeforeAsk | None = None
    scene: Scene | None = None
    surface: Surface | None = None
    trace: str = ""


class EpisodeRun:
    """The navigation loop of one episode, one exchange at a time.

    Attributes:
        header: What is known before the first request.
        exchanges: Everything so far, oldest first.
        pending: What the core waits for; None once it is over.
        footer: How it ended; None before.
        trace_sha256: Hash of the finished trace; "" before, or without a recorder.
        scene: What is rendered, for viewers.
        surface: The floor, for viewers.
        trace: Path of the trace, which is there once it is finished; "" without a recorder.
    """

    def __init__(self, parts: Parts, *, clock: Callable[[], float] = time.monotonic) -> None:
        self.header = parts.header
        self.exchanges: list[Exchange] = []
        self.footer: Footer | None = None
        self.trace_sha256 = ""
        self.scene = parts.scene
        self.surface = parts.surface
        self.trace = parts.trace
        self._parts = parts
        self._clock = clock
        self._proposal: Ranked | None = None
        self._proposal_s = 0.0
        self._kept: set[str] = set()
        self._steps = 0
        self._decisions = 0
        self.pending: Request | None = next(parts.loop)

    def advance(self) -> Exchange:
        """Answer the pending request, asking the ranker where it is a question.

        Raises:
            RankerStopped: No further query makes sense; the episode stays open.
            RankerUnavailable: Retries are used up; the episode ended as `error`.
        """
        request = self._pending()
        if isinstance(request, Ask):
            return self.commit()
        start_s = self._clock()
        response, truth = self._respond(request)
        return self._close_exchange(
            request, response, truth=truth, wall={"shell": self._clock() - start_s}
        )

    def propose(self, told: Telling | None = None) -> Ranked:
        """The ranker's answer to the pending question, without committing it; asked once.

        `told` hears how many queries are answered, where the ranker counts them.
        """
        request = self._pending()
        if not isinstance(request, Ask) or self._parts.ranker is None:
            message = f"expected a pending question and a ranker, came {type(request).__name__}"
            raise InternalError(message)
        if self._proposal is None:
            if self._parts.before_ask is not None:
                self._parts.before_ask(request, self.exchanges)
            start_s = self._clock()
            try:
                ranked = _ranked(self._parts.ranker, request.question, told)
            except RankerUnavailable as error:
                self.end(EpisodeOutcome.ERROR, str(error))
                raise
            if self.pending is not request:
                # A person answered meanwhile: an answer that comes too late is no proposal.
                return ranked
            self._proposal, self._proposal_s = ranked, self._clock() - start_s
        return self._proposal

    def commit(self, override: Override | None = None) -> Exchange:
        """Send the core the proposal, or a person's answer in its place.

        A ranker that already answered stays in the record beside the override.
        """
        request = self._pending()
        if not isinstance(request, Ask):
            message = f"expected a pending question, came {type(request).__name__}"
            raise InternalError(message)
        ranked = self._proposal
        if override is None:
            ranked = self.propose()
            outcome = ranked.outcome
        else:
            outcome = override.outcome
        wall = {"rank": self._proposal_s} if ranked is not None else {}
        self._proposal = None
        return self._close_exchange(request, outcome, ranked=ranked, override=override, wall=wall)

    def feed(self, exchange: Exchange) -> Exchange:
        """Take over a recorded answer to the pending question, query record and all."""
        request = self._pending()
        if not isinstance(request, Ask):
            message = f"expected a pending question, came {type(request).__name__}"
            raise InternalError(message)
        return self._close_exchange(
            request, exchange.response, ranked=exchange.ranked, override=exchange.override
        )

    def resume(self, exchange: Exchange) -> Exchange:
        """Take over any recorded exchange whole; the shell is not asked."""
        return self._close_exchange(
            self._pending(),
            exchange.response,
            ranked=exchange.ranked,
            override=exchange.override,
            truth=exchange.truth,
        )

    def end(self, outcome: EpisodeOutcome, error: str = "") -> Footer:
        """Close the episode: metrics, footer, and the trace's last record."""
        score = self._parts.score
        metrics = score(self.exchanges, outcome) if score else dict[str, float | int | None]()
        self.footer = Footer(outcome, metrics, error)
        self.pending = None
        self._parts.loop.close()
        if self._parts.recorder is not None:
            self.trace_sha256 = self._parts.recorder.finish(self.footer)
        return self.footer

    def keep(self, name: str, data: bytes) -> None:
        """Attach a file to the trace, once by that name; without a recorder there is no trace."""
        if self._parts.recorder is not None and self.footer is None and name not in self._kept:
            self._kept.add(name)
            self._parts.recorder.attach(name, data)

    def close(self) -> None:
        """Leave an unfinished episode: the trace stays recoverable."""
        self._parts.loop.close()
        if self.footer is None and self._parts.recorder is not None:
            self._parts.recorder.abandon()

    def _pending(self) -> Request:
        if self.pending is None:
            message = "the episode is over; open it again to go on"
            raise InternalError(message)
        return self.pending

    def _respond(self, request: Request) -> tuple[Response, Truth | None]:
        if isinstance(request, Look):
            return self._parts.shell.look(request)
        if isinstance(request, Move):
            return self._parts.shell.move(request)
        return None, None

    def _close_exchange(
        self,
        request: Request,
        response: Response,
        *,
        ranked: Ranked | None = None,
        override: Override | None = None,
        truth: Truth | None = None,
        wall: dict[str, float] | None = None,
    ) -> Exchange:
        decides = isinstance(request, Ask) or (
            isinstance(request, Note) and isinstance(request.record, Unasked)
        )
        exchange = Exchange(
            index=len(self.exchanges),
            step=self._steps,
            decision=self._decisions if decides else None,
            request=request,
            response=response,
            ranked=ranked,
            override=override,
            truth=truth,
            wall_s=wall or {},
        )
        self._decisions += decides
        if isinstance(request, Move) and truth is not None:
            self._steps += len(truth.poses)
        elif isinstance(request, Stop):
            self._steps += 1
        self.exchanges.append(exchange)
        if self._parts.recorder is not None:
            self._parts.recorder.write(exchange)
        self._send(response)
        return exchange

    def _send(self, response: Response) -> None:
        try:
            self.pending = self._parts.loop.send(response)
        except StopIteration as finished:
            ending: Ending = finished.value
            self.end(EpisodeOutcome(ending.value))


def _ranked(ranker: Ranker, question: Question, told: Telling | None) -> Ranked:
    if told is not None and isinstance(ranker, Counting):
        return ranker.rank_telling(question, told)
    return ranker.rank(question)


def run_to_end(run: EpisodeRun) -> Footer:
    """Advance until the episode is over."""
    while run.footer is None:
        run.advance()
    return run.footer
