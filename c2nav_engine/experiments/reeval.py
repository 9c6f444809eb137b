"""Recorded questions, asked again: of another ranker, or of the same one in other orders.

Decision-level and open-loop: every question was made by the recorded run, and no answer changes
where the robot goes. Its figures say how a ranker answers these questions, not how it navigates.
"""

from __future__ import annotations

import enum
import itertools
import string
from collections import deque
from collections.abc import Generator, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from c2nav_engine.contract.outcome import Answered, Key, TransportFailure
from c2nav_engine.contract.presentation import ORDINAL_FORMS, labelled, seeded_order
from c2nav_engine.contract.prompt import Query
from c2nav_engine.contract.question import Question
from c2nav_engine.contract.render import render_as
from c2nav_engine.errors import InternalError, RankerUnavailable, TraceError
from c2nav_engine.navigator.requests import Ask, Moved, Seen
from c2nav_engine.rankers.wrapper import AskingRanker
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.recorded import OpenTrace, open_trace

MOST_PERMUTED = 4
"""Alternatives up to which `all` means every permutation; beyond, rotations and their reverses."""


class OrderSet(enum.StrEnum):
    """Which presentation orders are asked."""

    RECORDED = "1"
    REVERSED = "2"
    """The recorded order and its reverse."""
    ALL = "all"


class Labelling(enum.StrEnum):
    """What the letters do when the positions change."""

    POSITION = "position"
    """A stands first whatever it names: letter and position move together."""
    KEY = "key"
    """Each alternative keeps its recorded letter: position moves alone."""


@dataclass(frozen=True, slots=True)
class Presentation:
    """One way to put a question.

    Attributes:
        order: Index of the order of positions; 0 is the recorded one.
        labelling: What the letters do.
        labels: Label → key, first position first.
    """

    order: int
    labelling: Labelling
    labels: tuple[tuple[str, Key], ...]


def presentations_of(question: Question, orders: OrderSet) -> tuple[Presentation, ...]:
    """Every presentation of a question.

    Each order but the recorded one is put twice, with letters by position and with letters that
    stay with their alternatives: beside the recorded order the second differs in position alone,
    and beside the second the first differs in letters alone. Cardinal forms have no order to
    change and are asked as recorded.
    """
    recorded = seeded_order(question)
    letters = dict(zip(recorded, string.ascii_uppercase, strict=False))
    found = [Presentation(0, Labelling.POSITION, labelled(recorded))]
    if question.form not in ORDINAL_FORMS:
        return tuple(found)
    for index, shown in enumerate(_orders(recorded, orders)[1:], start=1):
        kept = tuple((letters[key], key) for key in shown)
        found.append(Presentation(index, Labelling.POSITION, labelled(shown)))
        found.append(Presentation(index, Labelling.KEY, kept))
    return tuple(found)


def _orders(recorded: tuple[Key, ...], orders: OrderSet) -> list[tuple[Key, ...]]:
    """Orders of positions, the recorded one first and its reverse second."""
    if orders is OrderSet.RECORDED:
        return [recorded]
    both = [recorded, recorded[::-1]]
    if orders is OrderSet.REVERSED:
        return both
    if len(recorded) <= MOST_PERMUTED:
        more = list(itertools.permutations(recorded))
    else:
        turns = range(len(recorded))
        more = [shown[turn:] + shown[:turn] for shown in both for turn in turns]
    return list(dict.fromkeys([*both, *more]))


@dataclass(frozen=True, slots=True)
class Recorded:
    """One recorded question with where it comes from.

    Attributes:
        trace: Its file.
        trace_sha256: Digest of that file.
        run: Run name.
        episode_id: Episode.
        scene_id: Scene.
        variant: Preset.
        seed: Run seed.
        ranker: Who answered it then.
        decision: Its number.
        ask: The question with the controller's facts; pictures in full.
        answer: The outcome that was committed.
    """

    trace: Path
    trace_sha256: str
    run: str
    episode_id: str
    scene_id: str
    variant: str
    seed: int
    ranker: str
    decision: int
    ask: Ask
    answer: Answered


@dataclass(frozen=True, slots=True)
class Reanswered:
    """One presentation of one recorded question with what came back.

    Attributes:
        recorded: The question.
        presentation: How it was put.
        queries: Every query it took; the last one counts.
        outcome: What that one meant; a `TransportFailure` where no answer came.
    """

    recorded: Recorded
    presentation: Presentation
    queries: tuple[Query, ...]
    outcome: Answered


def recorded_questions(paths: Sequence[Path]) -> Iterator[Recorded]:
    """Every question of these traces, in order; raises `TraceError` where pictures are left out."""
    for path in paths:
        with open_trace(path) as trace:
            for number in range(trace.decision_count):
                exchange = trace.decision(number)
                if isinstance(exchange.request, Ask):
                    yield _recorded(trace, exchange, exchange.request)


def _recorded(trace: OpenTrace, exchange: Exchange, ask: Ask) -> Recorded:
    question = ask.question
    pictures = [each.picture for each in question.alternatives if each.picture is not None]
    pictures += [picture for _, picture in question.context]
    if not all(picture.jpeg for picture in pictures):
        message = (
            f"expected the pictures of decision {exchange.decision} in {trace.path}, came digests "
            "alone; ask the trace as it was recorded, not an export without pictures"
        )
        raise TraceError(message)
    answer = exchange.response
    if answer is None or isinstance(answer, Seen | Moved):
        message = f"expected an outcome for decision {exchange.decision}, came {answer!r}"
        raise InternalError(message)
    header = trace.header
    return Recorded(
        trace=trace.path,
        trace_sha256=trace.sha256,
        run=header.run,
        episode_id=header.episode.episode_id,
        scene_id=header.episode.scene_id,
        variant=header.variant,
        seed=header.seed,
        ranker=header.ranker,
        decision=exchange.decision or 0,
        ask=ask,
        answer=answer,
    )


def count_queries(paths: Sequence[Path], orders: OrderSet) -> int:
    """Presentations that these traces hold, without reading a picture."""
    count = 0
    for path in paths:
        with open_trace(path) as trace:
            for exchange in trace.decisions():
                if isinstance(exchange.request, Ask):
                    count += len(presentations_of(exchange.request.question, orders))
    return count


def reevaluate(
    paths: Sequence[Path], ranker: AskingRanker, orders: OrderSet, *, at_once: int = 1
) -> Generator[Reanswered]:
    """Ask every recorded question again; results in the order of the traces.

    Nothing is answered from memory: every presentation is a query of its own. Closing the
    generator stops asking.

    Args:
        paths: Finished traces.
        ranker: Who is asked.
        orders: In which orders.
        at_once: Presentations under way at once.

    Raises:
        RankerStopped: No further query makes sense.
        TraceError: A trace cannot be read or lacks its pictures.
    """
    jobs = (
        (recorded, presentation)
        for recorded in recorded_questions(paths)
        for presentation in presentations_of(recorded.ask.question, orders)
    )
    with ThreadPoolExecutor(at_once) as pool:
        waiting: deque[Future[Reanswered]] = deque()
        try:
            for recorded, presentation in jobs:
                waiting.append(pool.submit(_ask, ranker, recorded, presentation))
                # A few ahead of the slowest: pictures of what waits are held in memory.
                if len(waiting) > 2 * at_once:
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()
        finally:
            for future in waiting:
                future.cancel()


def _ask(ranker: AskingRanker, recorded: Recorded, presentation: Presentation) -> Reanswered:
    question = recorded.ask.question
    prompt = render_as(question, presentation.labels, order=presentation.order)
    try:
        queries = ranker.put(prompt)
    except RankerUnavailable as error:
        return Reanswered(recorded, presentation, (), TransportFailure(str(error)))
    return Reanswered(recorded, presentation, queries, queries[-1].outcome)
