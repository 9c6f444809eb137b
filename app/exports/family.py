"""A recording and what was forked from it: branches of one page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from app.session.branches import Branch, Origin
from app.session.story import Story, story_of
from c2nav_engine.errors import UsageError
from c2nav_engine.runner.recorded import Trace


@dataclass(frozen=True, slots=True)
class Member:
    """A branch with its story."""

    branch: Branch
    story: Story


def family_of(traces: Sequence[Trace]) -> tuple[Member, ...]:
    """The root first, forks after the traces they left.

    Raises:
        UsageError: The traces are not of one episode, or two of them have no parent among them
            and none in common.
    """
    by_sha = {trace.sha256: trace for trace in traces}
    roots = [trace for trace in traces if trace.header.parent_sha256 not in by_sha]
    strangers = {trace.header.parent_sha256 or trace.sha256 for trace in roots}
    episodes = {trace.header.episode.episode_id for trace in traces}
    if len(episodes) > 1 or len(strangers) > 1:
        names = ", ".join(trace.path.name for trace in roots)
        message = (
            f"expected traces of one family, a recording and its forks; came {names}, which do "
            "not descend from each other: export each to a page of its own"
        )
        raise UsageError(message)
    ids = {sha256: f"b{number}" for number, sha256 in enumerate(_in_order(traces, roots))}
    return tuple(_member(by_sha[sha256], ids) for sha256 in ids)


def _in_order(traces: Sequence[Trace], roots: Sequence[Trace]) -> list[str]:
    waiting = [trace.sha256 for trace in roots]
    found: list[str] = []
    while waiting:
        sha256 = waiting.pop(0)
        found.append(sha256)
        children = [t for t in traces if t.header.parent_sha256 == sha256]
        waiting += [t.sha256 for t in sorted(children, key=lambda t: t.header.fork_decision)]
    return list(dict.fromkeys(found))


def _member(trace: Trace, ids: dict[str, str]) -> Member:
    header = trace.header
    forked = header.fork_decision >= 0
    branch = Branch(
        branch_id=ids[trace.sha256],
        origin=Origin.FORK if forked else Origin.RECORDED,
        header=header,
        exchanges=trace.exchanges,
        footer=trace.footer,
        parent=ids.get(header.parent_sha256, ""),
        fork_decision=header.fork_decision,
        trace_sha256=trace.sha256,
        source=trace.path.name,
    )
    story = story_of(header, trace.exchanges, pending=None, footer=trace.footer)
    return Member(branch, story)
