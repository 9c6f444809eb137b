"""Turning points: what each answer of a failed branch cost, and which one would have saved it."""

from __future__ import annotations

import viser
from markupsafe import Markup

from app.inspector import markup as m
from app.inspector.panels.protocol import Dispatch, Html, Update
from app.session import commands as c
from app.session.branches import succeeded
from app.session.snapshot import Snapshot
from app.session.turning_state import Turning
from app.session.wording import SIGNS, key_words, plural, seconds, slot_words
from c2nav_engine.experiments.turning.flips import NO_SUCCESS, TURNING, UNSTABLE, Flip
from c2nav_engine.experiments.turning.regrets import WRONG, Regret

LISTED = 10
"""Decisions of (a) that are listed."""


def build(gui: viser.GuiApi, _dispatch: Dispatch) -> Update:
    """Build the panel."""
    block = Html(gui)
    return lambda snapshot: block.show(content(snapshot))


def content(snapshot: Snapshot) -> str:
    """Everything that the panel shows."""
    return m.padded(*_block(snapshot))


def _block(snapshot: Snapshot) -> list[Markup]:
    state = snapshot.turning_here
    if state is None:
        return _before(snapshot)
    if state.stage == "measuring":
        return [m.note("Driving the robot through its scene again …")]
    return [*_recoverable(state), *_one_away(snapshot, state), *_regrets(snapshot, state)]


def _before(snapshot: Snapshot) -> list[Markup]:
    if snapshot.view.blind:
        return [m.note("Hidden while answers are covered")]
    if succeeded(snapshot.branch) is not False:
        return [m.note("Turning points are of a finished branch that failed"), *_back(snapshot)]
    words = (
        "This branch failed. Which single answer would have led to success? First, without a "
        "query: what each answer cost, and the last decision from which the truth still succeeds"
    )
    return [m.note(words), _buttons(m.action("Measure", c.MeasureTurning(), primary=True))]


def _back(snapshot: Snapshot) -> list[Markup]:
    """From the branch of a changed answer to the failure that it left."""
    branch = snapshot.branch
    if branch.parent not in snapshot.turning:
        return []
    back = c.Go(branch=branch.parent, decision=branch.fork_decision)
    return [_buttons(m.action(f"Back to the failure, decision {branch.fork_decision}", back))]


def _buttons(*actions: Markup) -> Markup:
    return Markup('<div class="c2-buttons">{}</div>').format(m.join(actions))


# ---------------------------------------------------------------- (b)


def _recoverable(state: Turning) -> list[Markup]:
    found = state.recoverable
    if found is None:
        return []
    tried = plural(len(found.tried), "decision")
    if found.decision is None:
        words = f"None of {tried} tried: even a noiseless observer fails with these views and gates"
        return [m.heading("Last recoverable decision · privileged"), m.note(words)]
    return [
        m.heading("Last recoverable decision · privileged"),
        Markup("<div>{} {}</div>").format(
            m.action(f"decision {found.decision}", c.Go(decision=found.decision)),
            "the latest from which a noiseless observer still succeeds",
        ),
        m.note(f"Same fan, gates and vetoes; {tried} tried"),
    ]


# ---------------------------------------------------------------- (c)


def _one_away(snapshot: Snapshot, state: Turning) -> list[Markup]:
    parts = [m.heading(f"One answer away · {state.ranker} goes on"), _verdict(state)]
    if state.left:
        parts.append(_cost(state))
    parts.append(_controls(state))
    if state.flips:
        parts.append(
            m.table(
                ["decision", "instead", "with it", "unchanged", ""],
                [_flip(snapshot, flip) for flip in state.flips],
            )
        )
    return parts


def _verdict(state: Turning) -> Markup:
    """What is known so far; nothing is ruled out while answers are left to try."""
    words = {
        TURNING: "★ one answer away",
        UNSTABLE: "☆ unstable under the control",
        NO_SUCCESS: "not one answer away, among the decisions tried",
    }
    if not state.flips or (state.left and state.verdict != TURNING):
        return m.NOTHING
    return Markup("<b>{}</b>").format(words[state.verdict])


def _cost(state: Turning) -> Markup:
    decisions = len({decision for decision, _ in state.left})
    cost = state.cost
    spent = [f"about {plural(cost.queries, 'query')}", seconds(cost.seconds)]
    if cost.tokens:
        spent.append(plural(cost.tokens, "token"))
    if cost.dollars:
        spent.append(f"${cost.dollars:.2f}")
    return m.note(
        f"{plural(len(state.left), 'answer')} left to try at {plural(decisions, 'decision')}, "
        f"{plural(state.repeats, 'run')} each and as many unchanged: {', '.join(spent)} of the "
        "ranker, and driving the robot again"
    )


def _controls(state: Turning) -> Markup:
    done = f"{len(state.flips)} of {len(state.to_try)} tried"
    if state.stage == "trying":
        return m.join([m.note(f"{done} …"), _buttons(m.action("Cancel", c.CancelTrying()))])
    if state.stage == "stopping":
        return m.note(f"{done}, stopping …")
    if not state.left:
        return m.note(done) if state.to_try else m.note("No answer to change")
    label = "Go on" if state.flips else "Try other answers"
    return _buttons(m.action(label, c.TryAnswers(), primary=True))


def _flip(snapshot: Snapshot, flip: Flip) -> list[str | Markup]:
    mark = {TURNING: "★", UNSTABLE: "☆"}.get(flip.verdict, "")
    opening = c.OpenFlip(decision=flip.decision, answer=flip.answer)
    return [
        _decision(snapshot, flip.decision),
        m.action(key_words(flip.answer), opening, title="open this as a branch"),
        f"{flip.changed} of {flip.repeats}",
        f"{flip.control} of {flip.repeats}",
        f"{mark} {flip.verdict}".strip(),
    ]


# ---------------------------------------------------------------- (a)


def _regrets(snapshot: Snapshot, state: Turning) -> list[Markup]:
    worth = [regret for regret in state.regrets if regret.words or (regret.regret_m or 0.0) > 0.0]
    rest = len(worth) - LISTED
    return [
        m.heading("Regret, worst first · privileged"),
        m.table(
            ["decision", "slot", "answer", "better", "cost"],
            [_regret(snapshot, regret) for regret in worth[:LISTED]],
        ),
        m.note(f"and {rest} more") if rest > 0 else m.NOTHING,
    ]


def _regret(snapshot: Snapshot, regret: Regret) -> list[str | Markup]:
    # Metres say that an answer was wrong; what the controller did is said beside them.
    words = "" if regret.regret_m is not None and regret.words == WRONG else regret.words
    metres = "" if regret.regret_m is None else f"+{regret.regret_m:.2f} m"
    return [
        _decision(snapshot, regret.decision),
        slot_words(regret.slot),
        key_words(regret.committed) or "none",
        key_words(regret.target) if regret.target != regret.committed else "",
        Markup("{}<small>{}</small>").format(metres, words),
    ]


def _decision(snapshot: Snapshot, number: int) -> Markup:
    sign = SIGNS[snapshot.story.decisions[number].lane]
    return m.action(f"{sign} {number}", c.Go(decision=number), title=f"go to decision {number}")
