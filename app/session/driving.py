"""Driving the engine: go on to the next question, put it to the ranker, commit, fork."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import PurePath

from app.session.branches import Branch, Origin, fork_estimate, usual_answer_s
from app.session.desk import Desk, Errand, Message
from app.session.draft import Draft, outcome_of
from app.session.opened import ForkAt, Run
from app.session.snapshot import Asking, ForkOffer
from c2nav_engine.contract.prompt import Ranked
from c2nav_engine.contract.question import Orders, Question
from c2nav_engine.errors import C2NavError, UsageError
from c2nav_engine.navigator.requests import Ask
from c2nav_engine.runner.exchange import Override

Then = Callable[[Desk, str], None]
"""What follows once a new branch, named by its id, stands."""

HUMAN = "human"
"""A run whose ranker is the person at the page: nothing is ever proposed."""


def settle(desk: Desk, branch_id: str) -> None:
    """Let the core look, move and note until it asks or ends, then ask the ranker."""
    run = desk.runs.get(branch_id)
    if run is None:
        return
    try:
        while run.pending is not None and not isinstance(run.pending, Ask):
            run.advance()
    except C2NavError as error:
        desk.say(str(error), fault=True)
    refresh(desk, branch_id)
    ask(desk, branch_id)


def refresh(desk: Desk, branch_id: str) -> None:
    """Read what a run has done since."""
    run = desk.runs[branch_id]
    old = desk.branches[branch_id]
    desk.put(
        replace(
            old,
            exchanges=tuple(run.exchanges),
            pending=run.pending,
            footer=run.footer,
            trace_sha256=run.trace_sha256,
            source=PurePath(run.trace).name if run.trace_sha256 else "",
        )
    )
    if run.trace_sha256:
        desk.shelf.bind(branch_id, run.trace_sha256)


def ask(desk: Desk, branch_id: str) -> None:
    """Put the pending question to the ranker, on a thread of its own."""
    run, waiting = desk.runs.get(branch_id), desk.waiting(branch_id)
    if run is None or waiting is None or desk.snapshot.asking or branch_id in desk.asked:
        return
    if branch_id in desk.snapshot.proposals:
        return
    if run.header.ranker == HUMAN:
        return
    desk.taken_up(branch_id)
    if not desk.allowed:
        desk.change(consent_to=desk.opened.sends_to)
        return
    if desk.consent is not None:
        desk.consent.keep(run)
    number = desk.stories[branch_id].decisions[-1].number
    desk.asked.add(branch_id)
    errand = Errand(desk.generation, branch_id, number)
    if errand in desk.out:
        # Cancelled, but still with the model: its answer counts if it comes in time.
        desk.change(asking=desk.out[errand])
        return
    asking = Asking(
        branch_id,
        decision=number,
        since_s=desk.hands.clock(),
        queries=_expected(waiting.question),
        usual_s=usual_answer_s(desk.branches[branch_id].exchanges),
    )
    desk.out[errand] = asking
    desk.change(asking=asking)

    def told(answered: int, queries: int) -> None:
        desk.hands.post(lambda desk: progressed(desk, errand, answered, queries))

    def task() -> Message:
        try:
            ranked = run.propose(told)
        except C2NavError as error:
            problem = str(error)
            return lambda desk: failed(desk, errand, problem)
        return lambda desk: answered(desk, errand, ranked)

    desk.hands.background(task)


def _expected(question: Question) -> int:
    return {Orders.ONCE: 1, Orders.BOTH: 2, Orders.CYCLIC: len(question.alternatives)}[
        question.orders
    ]


def progressed(desk: Desk, errand: Errand, answered: int, queries: int) -> None:
    """Some queries of a question are answered, or it takes more than was thought."""
    before = desk.out.get(errand)
    if before is None:
        return
    desk.out[errand] = replace(before, answered=answered, queries=queries)
    if desk.snapshot.asking == before:
        desk.change(asking=desk.out[errand])


def failed(desk: Desk, errand: Errand, problem: str) -> None:
    """The ranker cannot go on: a person may answer, or ask again."""
    desk.out.pop(errand, None)
    if errand.generation != desk.generation:
        return
    if _awaits(desk, errand):
        desk.let_go("No answer came")
        desk.change(playing="")
        desk.commit_when_answered = False
    desk.asked.discard(errand.branch_id)
    desk.say(problem, fault=True)
    run = desk.runs.get(errand.branch_id)
    if run is not None and run.pending is None:
        refresh(desk, errand.branch_id)  # the episode ended with it: there is nothing to rank
    ask_here(desk)


def answered(desk: Desk, errand: Errand, ranked: Ranked) -> None:
    """The ranker's answer came; it is too late once a person has answered."""
    desk.out.pop(errand, None)
    if errand.generation != desk.generation:
        return
    branch_id = errand.branch_id
    if _awaits(desk, errand):
        desk.change(asking=None)
        desk.asked.discard(branch_id)
    pending = desk.stories[branch_id].pending
    if pending is not None and pending.number == errand.decision:
        desk.taken_up(branch_id)
        desk.change(proposals={**desk.snapshot.proposals, branch_id: ranked})
        if desk.commit_when_answered:
            desk.commit_when_answered = False
            commit_proposal(desk, branch_id)
    ask_here(desk)


def ask_here(desk: Desk) -> None:
    """Ask what the branch in view waits for, where another question stood before it."""
    branch_id = desk.snapshot.branch.branch_id
    if branch_id not in desk.snapshot.let_go and not desk.snapshot.consent_to:
        ask(desk, branch_id)


def _awaits(desk: Desk, errand: Errand) -> bool:
    """Whether it is this errand that the page waits for."""
    asking = desk.snapshot.asking
    at = (errand.branch_id, errand.decision)
    return asking is not None and (asking.branch_id, asking.decision) == at


def commit_proposal(desk: Desk, branch_id: str) -> None:
    """Commit what the ranker proposes, or do so as soon as it answers."""
    if branch_id not in desk.snapshot.proposals:
        desk.commit_when_answered = branch_id in desk.asked
        if not desk.commit_when_answered:
            desk.say("This decision waits for your ranking")
        return
    commit(desk, branch_id, None)


def commit(desk: Desk, branch_id: str, override: Override | None) -> None:
    """Commit at the newest decision and go on to the next one."""
    run = desk.runs[branch_id]
    try:
        run.commit(override)
    except C2NavError as error:
        desk.change(playing="")
        desk.say(str(error), fault=True)
        return
    desk.taken_up(branch_id)
    proposals = dict(desk.snapshot.proposals)
    proposals.pop(branch_id, None)
    desk.change(proposals=proposals, draft=Draft(), why="", offer=None)
    settle(desk, branch_id)
    if desk.snapshot.branch.branch_id == branch_id:
        desk.stand(len(desk.snapshot.story.stops) - 1)


def override_of(desk: Desk, why: str) -> Override:
    """The person's ranking of the decision in view."""
    decision = desk.snapshot.decision
    offered = tuple(candidate.key for candidate in decision.offered) if decision else ()
    outcome = outcome_of(desk.snapshot.draft, offered)
    return Override(outcome, desk.snapshot.who, why or desk.snapshot.why, desk.hands.clock())


def offer_fork(desk: Desk) -> None:
    """Say what a fork at the decision in view would take, and wait for a yes."""
    decision = desk.snapshot.decision
    if decision is None:
        return
    if desk.opened.fork is None or desk.snapshot.no_scene:
        desk.say(
            "Forking drives the robot again, so it needs the scene: open with --scenes DIR",
            fault=True,
        )
        return
    cost = fork_estimate(desk.snapshot.story.decisions, decision.number)
    desk.change(
        offer=ForkOffer(decision.number, cost.decisions, cost.queries, cost.seconds, cost.dollars)
    )


def fork(desk: Desk, why: str) -> None:
    """Start a branch with the person's answer at the decision in view."""
    decision = desk.snapshot.decision
    if decision is not None:
        ranker = desk.snapshot.chooser.choice.ranker
        branch_off(desk, Leaving(decision.number, override_of(desk, why), ranker))


@dataclass(frozen=True, slots=True)
class Leaving:
    """How the branch in view is left.

    Attributes:
        decision: Where.
        override: The other answer.
        ranker: Who answers from then on.
        options: Of that ranker; None for those that were given at the start.
    """

    decision: int
    override: Override
    ranker: str
    options: Mapping[str, str] | None = None


def branch_off(
    desk: Desk, leaving: Leaving, *, then: Then = lambda _desk, _branch_id: None
) -> None:
    """Start a branch with another answer in the branch in view, and stand in it.

    Args:
        desk: The session's truth.
        leaving: Where and how.
        then: Called with the new branch's id once it stands.
    """
    parent, start = desk.snapshot.branch, desk.opened.fork
    if start is None:
        return
    wanted = ForkAt(
        parent.header,
        parent.exchanges,
        leaving.decision,
        leaving.override,
        leaving.ranker,
        leaving.options,
    )
    generation = desk.generation
    desk.change(
        offer=None, draft=Draft(), why="", working=f"forking at decision {leaving.decision}"
    )
    origin = (parent.branch_id, leaving.decision)

    def task() -> Message:
        try:
            run = start(wanted)
        except C2NavError as error:
            problem = str(error)
            return lambda desk: not_forked(desk, problem)

        def message(desk: Desk) -> None:
            branch_id = forked(desk, generation, origin, run)
            if branch_id:
                then(desk, branch_id)

        return message

    desk.hands.background(task)


def not_forked(desk: Desk, problem: str) -> None:
    """The fork could not be made."""
    desk.change(working="")
    desk.say(problem, fault=True)


def forked(desk: Desk, generation: int, origin: tuple[str, int], run: Run) -> str:
    """A fork stands at its first new request; returns its branch, "" where it comes too late."""
    if generation != desk.generation:
        run.close()
        return ""
    desk.change(working="")
    branch_id = desk.new_branch_id()
    desk.runs[branch_id] = run
    parent, decision = origin
    desk.put(
        Branch(
            branch_id,
            Origin.FORK,
            run.header,
            tuple(run.exchanges),
            pending=run.pending,
            footer=run.footer,
            parent=parent,
            fork_decision=decision,
            trace=run.trace,
        )
    )
    settle(desk, branch_id)
    desk.stand(desk.stories[branch_id].stop_of_decision(decision + 1), branch_id)
    return branch_id


def cancel(desk: Desk) -> None:
    """Stop waiting: a person may answer at once; a late answer counts while none was committed."""
    desk.let_go("Cancelled")
    desk.change(playing="")
    desk.commit_when_answered = False


def take_over(desk: Desk, branch_id: str) -> None:
    """A person answers the pending question of a branch: nothing is waited for there."""
    asking = desk.snapshot.asking
    if asking is not None and asking.branch_id == branch_id:
        desk.change(asking=None)
    desk.asked.discard(branch_id)
    desk.change(playing="")
    desk.commit_when_answered = False


def check_can_answer(desk: Desk) -> None:
    """Raise `UsageError` where the decision in view has nothing to rank."""
    decision = desk.snapshot.decision
    if decision is None or not decision.offered or decision.question is None:
        message = "expected a decision that was put as a question; this one needed none"
        raise UsageError(message)
