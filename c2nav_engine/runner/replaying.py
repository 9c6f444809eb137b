"""Driving the core with what a trace recorded, and naming the first thing that differs."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, cast

from c2nav_engine.contract.question import Picture
from c2nav_engine.navigator.loop import navigate
from c2nav_engine.navigator.requests import Look, Move
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.opening import task_of
from c2nav_engine.runner.record import EpisodeOutcome, Footer, Header
from c2nav_engine.runner.shell import Shell


@dataclass(frozen=True, slots=True)
class Divergence:
    """The first difference between a trace and its replay.

    Attributes:
        exchange: Index of the exchange.
        decision: Number of the latest decision up to there; None before the first.
        part: "request" (what the core asked), "response" (what the scene gave back now) or "end".
        field: Where inside it, as a path.
        recorded: The trace's value, in short.
        replayed: The replay's value, in short.
    """

    exchange: int
    decision: int | None
    part: str
    field: str
    recorded: str
    replayed: str

    def __str__(self) -> str:
        """One sentence."""
        where = (
            "before the first decision" if self.decision is None else f"decision {self.decision}"
        )
        return (
            f"{where}, exchange {self.exchange}: {self.part} differs in {self.field}: "
            f"recorded {self.recorded}, replayed {self.replayed}"
        )


def replay(
    header: Header,
    exchanges: Sequence[Exchange],
    footer: Footer | None,
    *,
    shell: Shell | None = None,
) -> Divergence | None:
    """Run the core again on recorded answers; None when it reproduces its trace.

    Args:
        header: Of the trace.
        exchanges: All of them; their responses are sent to the core.
        footer: How it ended; an interrupted or failed episode is compared as far as it went.
        shell: With the scene: looks and moves are executed again and compared too, pictures by
            their hashes. Without it no pixel is rendered.
    """
    loop = navigate(task_of(header))
    decision: int | None = None
    request = next(loop)
    for exchange in exchanges:
        decision = exchange.decision if exchange.decision is not None else decision
        found = difference(exchange.request, request)
        if found is not None:
            return Divergence(exchange.index, decision, "request", *found)
        found = _shell_difference(shell, exchange)
        if found is not None:
            return Divergence(exchange.index, decision, "response", *found)
        try:
            request = loop.send(exchange.response)
        except StopIteration as finished:
            if exchange is not exchanges[-1]:
                recorded = f"exchange {exchange.index + 1}"
                ending = str(finished.value)
                return Divergence(exchange.index, decision, "end", "next", recorded, ending)
            return _end_difference(exchange.index, decision, footer, str(finished.value))
    loop.close()
    return _end_difference(len(exchanges), decision, footer, "the core goes on")


def _shell_difference(shell: Shell | None, exchange: Exchange) -> tuple[str, str, str] | None:
    if shell is None:
        return None
    if isinstance(exchange.request, Look):
        seen, truth = shell.look(exchange.request)
        return difference(exchange.response, seen) or difference(exchange.truth, truth, "truth")
    if isinstance(exchange.request, Move):
        moved, truth = shell.move(exchange.request)
        return difference(exchange.response, moved) or difference(exchange.truth, truth, "truth")
    return None


def _end_difference(
    exchange: int, decision: int | None, footer: Footer | None, ending: str
) -> Divergence | None:
    """Whether the core ended as recorded; a record that was cut off says nothing of the end."""
    if footer is None or footer.outcome in {EpisodeOutcome.ERROR, EpisodeOutcome.INTERRUPTED}:
        return None
    if footer.outcome.value == ending:
        return None
    return Divergence(exchange, decision, "end", "outcome", footer.outcome.value, ending)


def difference(recorded: object, replayed: object, path: str = "") -> tuple[str, str, str] | None:
    """(field path, recorded, replayed) of the first difference; None for equal values.

    Pictures are compared by hash, all else field by field.
    """
    if type(recorded) is not type(replayed):
        return (path or "kind", _short(recorded), _short(replayed))
    if isinstance(recorded, Picture) and isinstance(replayed, Picture):
        if recorded.sha256 == replayed.sha256:
            return None
        return (f"{path}.sha256", recorded.sha256[:12], replayed.sha256[:12])
    for name, before, after in _members(recorded, replayed):
        found = difference(before, after, f"{path}{name}".lstrip("."))
        if found is not None:
            return found
    if _is_leaf(recorded) and recorded != replayed:
        return (path or "value", _short(recorded), _short(replayed))
    return None


def _is_leaf(value: object) -> bool:
    return not dataclasses.is_dataclass(value) and not isinstance(value, tuple | Mapping)


def _members(recorded: Any, replayed: Any) -> list[tuple[str, object, object]]:
    """Parts of a compound value by name; lengths count as a part."""
    if dataclasses.is_dataclass(recorded):
        return [
            (f".{field.name}", getattr(recorded, field.name), getattr(replayed, field.name))
            for field in dataclasses.fields(recorded)
        ]
    if isinstance(recorded, tuple):
        before_all = cast("tuple[object, ...]", recorded)
        after_all = cast("tuple[object, ...]", replayed)
        pairs = [
            (f"[{place}]", one, other)
            for place, (one, other) in enumerate(zip(before_all, after_all, strict=False))
        ]
        return [*pairs, (".length", len(before_all), len(after_all))]
    if isinstance(recorded, Mapping):
        before = cast("Mapping[str, object]", recorded)
        after = cast("Mapping[str, object]", replayed)
        keys = sorted(set(before) | set(after))
        return [(f"[{key}]", before.get(key), after.get(key)) for key in keys]
    return []


def _short(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 120 else f"{text[:117]}…"
