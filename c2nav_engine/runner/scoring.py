"""Metrics of a run, from what its shell measured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict

from c2nav_engine.contract.outcome import Abstention, Empty, Invalid, Refused, Truncated
from c2nav_engine.episodes.episode import Episode
from c2nav_engine.geometry import Point
from c2nav_engine.metrics.episode import score
from c2nav_engine.metrics.trajectory import Trajectory
from c2nav_engine.navigator.requests import Event, Look, Move, Moved, Note, Stop
from c2nav_engine.runner.exchange import Exchange
from c2nav_engine.runner.record import EpisodeOutcome

Metrics = Mapping[str, float | int | None]


def trajectory_of(
    exchanges: Sequence[Exchange],
    *,
    start_m: Point,
    shortest_m: float | None,
    ground_truth_m: tuple[Point, ...],
) -> Trajectory:
    """Positions and goal distances of a run, the start first."""
    positions: list[Point] = [start_m]
    distances: list[float] = [] if shortest_m is None else [shortest_m]
    collisions = steps = 0
    stopped = False
    for exchange in exchanges:
        if isinstance(exchange.request, Move) and exchange.truth is not None:
            positions += [pose.position_m for pose in exchange.truth.poses]
            distances += exchange.truth.goal_distances_m
            if isinstance(exchange.response, Moved):
                collisions += sum(step.collided for step in exchange.response.steps)
                steps += len(exchange.response.steps)
        elif isinstance(exchange.request, Stop):
            stopped = True
            steps += 1
    return Trajectory(
        positions_m=tuple(positions),
        goal_distances_m=tuple(distances),
        stopped=stopped,
        shortest_m=shortest_m,
        steps=steps,
        collisions=collisions,
        ground_truth_m=ground_truth_m,
    )


def count_of(exchanges: Sequence[Exchange]) -> dict[str, float | int | None]:
    """Counts of one episode: decisions, queries, bad answers, fallbacks, glances, walk-backs."""
    queries = [query for item in exchanges if item.ranked for query in item.ranked.queries]
    events = [
        item.request.record.name
        for item in exchanges
        if isinstance(item.request, Note) and isinstance(item.request.record, Event)
    ]
    unusable = (Invalid, Refused, Truncated, Empty)
    tokens = [query.reply.tokens_in for query in queries if query.reply.tokens_in is not None]
    tokens += [query.reply.tokens_out for query in queries if query.reply.tokens_out is not None]
    return {
        "decisions": sum(item.decision is not None for item in exchanges),
        "queries": len(queries),
        "invalid": sum(isinstance(query.outcome, unusable) for query in queries),
        "abstained": sum(isinstance(item.response, Abstention) for item in exchanges),
        "fallbacks": events.count("fallback"),
        "glances": events.count("glance"),
        "walkbacks": events.count("walk-back"),
        "tokens": sum(tokens) if tokens else None,
        "latency_s": round(sum(query.reply.latency_s for query in queries), 6),
    }


def metrics_of(
    exchanges: Sequence[Exchange],
    outcome: EpisodeOutcome,
    *,
    episode: Episode,
    shortest_m: float | None,
    ground_truth_m: tuple[Point, ...],
) -> Metrics:
    """The measuring columns of `episodes.csv` for a finished episode."""
    del outcome  # whether STOP was called stands in the exchanges themselves
    trajectory = trajectory_of(
        exchanges,
        start_m=_start_of(exchanges, episode),
        shortest_m=shortest_m,
        ground_truth_m=ground_truth_m,
    )
    return {**asdict(score(trajectory)), **count_of(exchanges)}


def _start_of(exchanges: Sequence[Exchange], episode: Episode) -> Point:
    for exchange in exchanges:
        if isinstance(exchange.request, Look) and exchange.truth is not None:
            return exchange.truth.poses[0].position_m
    return episode.start.position_m
