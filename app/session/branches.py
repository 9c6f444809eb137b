"""Branches: the recorded line, a live one, and what follows from another answer."""

from __future__ import annotations

import enum
import statistics
from dataclasses import dataclass

from app.session.decisions import Decision
from c2nav_engine.navigator.requests import Request
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.record import EpisodeOutcome, Footer, Header


class Origin(enum.StrEnum):
    """Where a branch comes from."""

    RECORDED = "recorded"
    LIVE = "live"
    FORK = "fork"


@dataclass(frozen=True, slots=True)
class Branch:
    """One line of exchanges.

    Attributes:
        branch_id: Stable within a session ("b0", "b1", …).
        origin: Recorded, live or forked.
        header: What was known before the first request.
        exchanges: Everything so far.
        pending: What the core waits for; None when the branch cannot go on.
        footer: How it ended; None while it runs.
        parent: Branch it left; "" for a root.
        fork_decision: Decision at which it left its parent; −1 for a root.
        trace_sha256: Digest of the trace it was read from; "" for a live one.
        source: File name of that trace, for people.
        trace: Path of its trace, which is there once it has ended; "" where nothing is recorded.
    """

    branch_id: str
    origin: Origin
    header: Header
    exchanges: tuple[Exchange, ...]
    pending: Request | None = None
    footer: Footer | None = None
    parent: str = ""
    fork_decision: int = -1
    trace_sha256: str = ""
    source: str = ""
    trace: str = ""

    @property
    def running(self) -> bool:
        """Whether it can go on."""
        return self.footer is None and self.pending is not None


@dataclass(frozen=True, slots=True)
class Cost:
    """What answers took; tokens and dollars count only where they are known."""

    decisions: int = 0
    queries: int = 0
    tokens: int = 0
    seconds: float = 0.0
    dollars: float = 0.0


def cost_of(decisions: tuple[Decision, ...]) -> Cost:
    """Sum over decisions."""
    queries = [query for d in decisions if d.ranked for query in d.ranked.queries]
    replies = [query.reply for query in queries]
    return Cost(
        decisions=sum(1 for d in decisions if not d.pending),
        queries=len(queries),
        tokens=sum((reply.tokens_in or 0) + (reply.tokens_out or 0) for reply in replies),
        seconds=sum(reply.latency_s for reply in replies),
        dollars=sum(reply.cost_usd or 0.0 for reply in replies),
    )


def usual_answer_s(exchanges: tuple[Exchange, ...]) -> float | None:
    """Median wall time of a whole answer, all its queries; None before the first."""
    waits = [e.wall_s["rank"] for e in exchanges if e.ranked and "rank" in e.wall_s]
    return statistics.median(waits) if waits else None


def fork_estimate(decisions: tuple[Decision, ...], at: int) -> Cost:
    """What a fork is expected to take: what the rest of this branch took."""
    return cost_of(tuple(d for d in decisions if d.number > at and not d.pending))


def succeeded(branch: Branch) -> bool | None:
    """Whether it stopped within the goal radius; None while unknown."""
    if branch.footer is None:
        return None
    success = branch.footer.metrics.get("success")
    return None if success is None else bool(success)


def ended_words(footer: Footer | None) -> str:
    """How a branch ended, in a few words with its sign."""
    if footer is None:
        return "running"
    distance_m = footer.metrics.get("ne_m")
    away = "" if distance_m is None else f" {distance_m:.1f} m away"
    words = {
        EpisodeOutcome.STOPPED: f"stopped{away}",
        EpisodeOutcome.STEP_LIMIT: f"step limit{away}",
        EpisodeOutcome.STALLED: f"stalled{away}",
        EpisodeOutcome.ERROR: "error",
        EpisodeOutcome.INTERRUPTED: "interrupted",
    }[footer.outcome]
    # The sign never stands alone on the next line.
    return f"{words}\u00a0{'✓' if footer.metrics.get('success') else '✕'}"
