"""Questions, prompts, answers and poses as messages, and back; one pair of functions each.

Pictures travel by digest: `keep` is told of each one on the way out, `show` finds it on the way in.
"""

from __future__ import annotations

from collections.abc import Callable

from c2nav_engine.contract.outcome import (
    Abstention,
    Answered,
    Cardinal,
    Empty,
    Invalid,
    Ordering,
    Refused,
    Tie,
    TransportFailure,
    Truncated,
)
from c2nav_engine.contract.prompt import Prompt, Query, Ranked, Reply
from c2nav_engine.contract.question import Alternative, Form, Orders, Picture, Question, Slot
from c2nav_engine.errors import TraceError
from c2nav_engine.geometry import Pose
from c2nav_engine.traces.pb import common_pb2, decision_pb2

Keep = Callable[[Picture | None], str]
"""Notes a picture for storing; returns its digest, "" for None."""

Show = Callable[[str], Picture | None]
"""The picture of a digest; None for ""."""

# ---------------------------------------------------------------- outcomes

_KINDS: dict[type[Answered], str] = {
    Ordering: "ordering",
    Tie: "tie",
    Abstention: "abstention",
    Invalid: "invalid",
    Refused: "refused",
    Truncated: "truncated",
    Empty: "empty",
    TransportFailure: "transport-failure",
    Cardinal: "cardinal",
}


def outcome_message(outcome: Answered) -> common_pb2.Outcome:
    """An outcome as a message."""
    message = common_pb2.Outcome(kind=_KINDS[type(outcome)])
    if isinstance(outcome, Ordering | Tie):
        message.tiers.extend(common_pb2.Tier(keys=tier) for tier in outcome.tiers)
    elif isinstance(outcome, Abstention | Invalid | TransportFailure):
        message.reason = outcome.reason
    elif isinstance(outcome, Cardinal):
        message.value = outcome.value
    return message


_READERS: dict[str, Callable[[common_pb2.Outcome], Answered]] = {
    "ordering": lambda message: Ordering(_tiers(message)),
    "tie": lambda message: Tie(_tiers(message)),
    "abstention": lambda message: Abstention(message.reason),
    "invalid": lambda message: Invalid(message.reason),
    "refused": lambda _: Refused(),
    "truncated": lambda _: Truncated(),
    "empty": lambda _: Empty(),
    "transport-failure": lambda message: TransportFailure(message.reason),
    "cardinal": lambda message: Cardinal(message.value),
}


def outcome_of(message: common_pb2.Outcome) -> Answered:
    """The outcome of a message; raises `TraceError` for a kind that does not exist."""
    if message.kind not in _READERS:
        text = f"expected one of the outcomes {list(_READERS)}, the trace says {message.kind!r}"
        raise TraceError(text)
    return _READERS[message.kind](message)


def _tiers(message: common_pb2.Outcome) -> tuple[tuple[str, ...], ...]:
    return tuple(tuple(tier.keys) for tier in message.tiers)


# ---------------------------------------------------------------- poses


def pose_message(pose: Pose) -> common_pb2.BodyPose:
    """A pose as a message."""
    x, y, z = pose.position_m
    return common_pb2.BodyPose(x_m=x, y_m=y, z_m=z, yaw_rad=pose.yaw_rad)


def pose_of(message: common_pb2.BodyPose) -> Pose:
    """The pose of a message."""
    return Pose((message.x_m, message.y_m, message.z_m), message.yaw_rad)


# ---------------------------------------------------------------- questions


def question_message(question: Question, keep: Keep) -> decision_pb2.Question:
    """A question as a message."""
    return decision_pb2.Question(
        slot=question.slot,
        form=question.form,
        orders=question.orders,
        instruction=question.instruction,
        legs=question.legs,
        leg=question.leg,
        alternatives=[
            decision_pb2.Alternative(
                key=each.key, text=each.text, picture=keep(each.picture), caption=each.caption
            )
            for each in question.alternatives
        ],
        shuffle_seed=str(question.shuffle_seed),
        template=question.template,
        sketch=question.sketch,
        context=[
            decision_pb2.Context(words=words, picture=keep(picture))
            for words, picture in question.context
        ],
    )


def question_of(message: decision_pb2.Question, show: Show) -> Question:
    """The question of a message."""
    return Question(
        slot=Slot(message.slot),
        form=Form(message.form),
        orders=Orders(message.orders),
        instruction=message.instruction,
        legs=tuple(message.legs),
        leg=message.leg,
        alternatives=tuple(
            Alternative(each.key, each.text, show(each.picture), each.caption)
            for each in message.alternatives
        ),
        shuffle_seed=int(message.shuffle_seed),
        template=message.template,
        sketch=message.sketch,
        context=tuple((each.words, _shown(show, each.picture)) for each in message.context),
    )


def _shown(show: Show, digest: str) -> Picture:
    picture = show(digest)
    if picture is None:
        message = "expected a picture where a question shows one, the trace names none"
        raise TraceError(message)
    return picture


# ---------------------------------------------------------------- queries


def ranked_message(ranked: Ranked, keep: Keep) -> decision_pb2.Ranked:
    """A ranker's record as a message; its prompts' question is the decision's own."""
    return decision_pb2.Ranked(
        ranker=ranked.ranker,
        privileged=ranked.privileged,
        outcome=outcome_message(ranked.outcome),
        queries=[_query_message(query, keep) for query in ranked.queries],
    )


def ranked_of(message: decision_pb2.Ranked, question: Question, show: Show) -> Ranked:
    """The record of a message, for the decision's question."""
    return Ranked(
        outcome=outcome_of(message.outcome),
        queries=tuple(_query_of(query, question, show) for query in message.queries),
        ranker=message.ranker,
        privileged=message.privileged,
    )


def _query_message(query: Query, keep: Keep) -> decision_pb2.Query:
    prompt, reply = query.prompt, query.reply
    return decision_pb2.Query(
        parts=[
            decision_pb2.Part(text=part)
            if isinstance(part, str)
            else decision_pb2.Part(picture=keep(part))
            for part in prompt.parts
        ],
        labels=[decision_pb2.Label(label=label, key=key) for label, key in prompt.labels],
        form=prompt.form,
        repair=prompt.repair,
        order=prompt.order,
        template_sha256=prompt.template_sha256,
        request_sha256=prompt.request_sha256,
        text=reply.text,
        known=None if reply.outcome is None else outcome_message(reply.outcome),
        model=reply.model,
        outcome=outcome_message(query.outcome),
        wall=decision_pb2.QueryWall(
            latency_s=reply.latency_s,
            tokens_in=reply.tokens_in,
            tokens_out=reply.tokens_out,
            cost_usd=reply.cost_usd,
            cached=reply.cached,
            retry_after_s=reply.retry_after_s,
        ),
    )


def _query_of(message: decision_pb2.Query, question: Question, show: Show) -> Query:
    prompt = Prompt(
        question=question,
        parts=tuple(
            part.text if part.HasField("text") else _shown(show, part.picture)
            for part in message.parts
        ),
        labels=tuple((each.label, each.key) for each in message.labels),
        form=Form(message.form),
        repair=message.repair,
        order=message.order,
        template_sha256=message.template_sha256,
        request_sha256=message.request_sha256,
    )
    wall = message.wall
    reply = Reply(
        outcome=outcome_of(message.known) if message.HasField("known") else None,
        text=message.text,
        latency_s=wall.latency_s,
        tokens_in=wall.tokens_in if wall.HasField("tokens_in") else None,
        tokens_out=wall.tokens_out if wall.HasField("tokens_out") else None,
        cost_usd=wall.cost_usd if wall.HasField("cost_usd") else None,
        model=message.model,
        cached=wall.cached,
        retry_after_s=wall.retry_after_s if wall.HasField("retry_after_s") else None,
    )
    return Query(prompt, reply, outcome_of(message.outcome))
