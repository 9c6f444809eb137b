"""Turning points of the branch in view: measured and tried in the background, one flip a task.

A flip may take minutes with a model behind a server. Each is a task of its own, so that the page
shows it as soon as it is there, and a cancelled search keeps all it has and can be taken up again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from app.session import driving, moving
from app.session.branches import Branch, Cost, cost_of, succeeded
from app.session.desk import Desk, Message
from app.session.searching import Search, Tried, search_of
from app.session.turning_state import Turning
from c2nav_engine.errors import C2NavError, UsageError
from c2nav_engine.experiments.turning.flips import WHO, Flip
from c2nav_engine.experiments.turning.same_ranker import Continuing, continuing
from c2nav_engine.runner.exchange import Override
from c2nav_engine.runner.record import Footer
from c2nav_engine.runner.worlds import World


def measure(desk: Desk) -> None:
    """Measure (a) and (b) of the branch in view, and say what (c) would take."""
    branch = desk.snapshot.branch
    if branch.branch_id in desk.snapshot.turning:
        return
    footer, world = _failure(branch), _world(desk)
    # A person cannot be asked again by a program: the ranker named on the page goes on instead.
    person = branch.header.ranker == driving.HUMAN
    on = continuing(branch.header, desk.snapshot.chooser.choice.ranker if person else "")
    _show(desk, branch.branch_id, Turning("measuring"))
    generation = desk.generation

    def task() -> Message:
        try:
            search = search_of(branch, footer, world(), on)
        except C2NavError as error:
            problem = str(error)
            return lambda desk: _not_measured(desk, generation, branch.branch_id, problem)
        return lambda desk: _measured(desk, generation, branch.branch_id, search)

    desk.hands.background(task)


def _failure(branch: Branch) -> Footer:
    if branch.footer is None or succeeded(branch) is not False:
        message = (
            "expected a finished branch that failed: turning points say which answer would have "
            "led to success; go on to the end, or choose another branch"
        )
        raise UsageError(message)
    return branch.footer


def _world(desk: Desk) -> Callable[[], World]:
    if desk.world is None:
        message = (
            "expected a scene to drive the robot through again, came none; open with --scenes DIR"
        )
        raise UsageError(message)
    return desk.world


def _not_measured(desk: Desk, generation: int, branch_id: str, problem: str) -> None:
    if generation == desk.generation:
        kept = {name: each for name, each in desk.snapshot.turning.items() if name != branch_id}
        desk.change(turning=kept)
    desk.say(problem, fault=True)


def _measured(desk: Desk, generation: int, branch_id: str, search: Search) -> None:
    if generation != desk.generation:
        return
    desk.searches[branch_id] = search
    state = Turning(
        "ready",
        ranker=search.on.name,
        regrets=tuple(search.regrets),
        recoverable=search.recoverable,
        repeats=search.budget.repeats,
        to_try=tuple((trial.decision, trial.answer) for trial in search.trials),
    )
    _show(desk, branch_id, _priced(desk, branch_id, state))


# ---------------------------------------------------------------- trying answers


def try_answers(desk: Desk) -> None:
    """Start (c) on the branch in view, or take it up where it was left."""
    branch_id, state, search = _in_view(desk)
    if state is None or search is None or state.stage != "ready" or not state.left:
        return
    _check_sends(desk, search.on)
    search.start(state.left)
    _show(desk, branch_id, replace(state, stage="trying"))
    _next(desk, branch_id, search)


def _check_sends(desk: Desk, on: Continuing) -> None:
    host = desk.opened.host_of(on.name, on.options)
    if host and not (desk.allowed and host == desk.opened.sends_to):
        message = (
            f"expected leave to send pictures to {host}, where {on.name} answers; open the "
            "inspector with that ranker and allow it there, or run c2nav turning"
        )
        raise UsageError(message)


def _next(desk: Desk, branch_id: str, search: Search) -> None:
    generation, flips = desk.generation, search.flips
    if flips is None:
        return

    def task() -> Message:
        try:
            flip, problem = next(flips, None), ""
        except C2NavError as error:
            flip, problem = None, str(error)
        return lambda desk: _tried(desk, generation, branch_id, (flip, problem))

    desk.hands.background(task)


def _tried(desk: Desk, generation: int, branch_id: str, brought: tuple[Flip | None, str]) -> None:
    if generation != desk.generation:
        return
    flip, problem = brought
    state = desk.snapshot.turning[branch_id]
    if problem:
        desk.say(problem, fault=True)
    if flip is not None:
        state = _priced(desk, branch_id, replace(state, flips=(*state.flips, flip)))
    if flip is None or not state.left:
        _show(desk, branch_id, replace(state, stage="ready"))
        return
    _show(desk, branch_id, state)
    _next(desk, branch_id, desk.searches[branch_id])


def cancel(desk: Desk) -> None:
    """Leave the search of the branch in view; what was tried is kept."""
    branch_id, state, search = _in_view(desk)
    if state is not None and search is not None and state.stage == "trying":
        search.cancelled.set()
        _show(desk, branch_id, replace(state, stage="stopping"))


# ---------------------------------------------------------------- a flip as a branch


def open_flip(desk: Desk, decision: int, answer: str) -> None:
    """Go to the branch of a changed answer: an ordinary fork, driven to its end."""
    branch_id, state, search = _in_view(desk)
    if state is None or search is None:
        return
    place = (decision, answer)
    known = state.branches.get(place)
    if known is not None:
        moving.go(desk, known, decision, -1)
        return
    trial = search.trial(place)
    if trial is None:
        message = f"expected an answer to try at decision {decision}, came {answer!r}"
        raise UsageError(message)
    _check_sends(desk, search.on)
    override = Override(trial.outcome, WHO, _why(state, place), desk.hands.clock())
    leaving = driving.Leaving(decision, override, search.on.name, search.on.options)
    driving.branch_off(desk, leaving, then=partial(_opened, parent=branch_id, place=place))


def _why(state: Turning, place: Tried) -> str:
    flip = next((f for f in state.flips if (f.decision, f.answer) == place), None)
    return "" if flip is None else f"{flip.changed} of {flip.repeats} such runs succeeded"


def _opened(desk: Desk, branch_id: str, *, parent: str, place: Tried) -> None:
    state = desk.snapshot.turning[parent]
    _show(desk, parent, replace(state, branches={**state.branches, place: branch_id}))
    moving.play(desk, "end")


# ---------------------------------------------------------------- the state


def _in_view(desk: Desk) -> tuple[str, Turning | None, Search | None]:
    branch_id = desk.snapshot.branch.branch_id
    return branch_id, desk.snapshot.turning.get(branch_id), desk.searches.get(branch_id)


def _show(desk: Desk, branch_id: str, state: Turning) -> None:
    desk.change(turning={**desk.snapshot.turning, branch_id: state})


def _priced(desk: Desk, branch_id: str, state: Turning) -> Turning:
    """The state with what is left of (c) priced by what the branch itself took."""
    queries = desk.searches[branch_id].queries(state.left)
    spent = cost_of(desk.stories[branch_id].decisions)
    share = queries / spent.queries if spent.queries else 0.0
    cost = Cost(
        queries=queries,
        tokens=round(spent.tokens * share),
        seconds=spent.seconds * share,
        dollars=spent.dollars * share,
    )
    return replace(state, cost=cost)
