"""Moving about: steps, decisions, branches, playing, and jumps to what is worth a look."""

from __future__ import annotations

from collections.abc import Callable

from app.session import driving
from app.session.decisions import LANES, Decision
from app.session.desk import Desk
from app.session.differing import KINDS, disagrees
from app.session.snapshot import BAD_M, Snapshot

STEP_S = 0.14
"""Playing: time at a low-level step."""

DECISION_S = 0.55
"""Playing: time at a decision."""


def step(desk: Desk) -> None:
    """Commit at the newest decision, or go to the next recorded one."""
    if desk.at_frontier:
        if desk.run is not None:
            driving.commit_proposal(desk, desk.snapshot.branch.branch_id)
        return
    if not _over(desk):
        by_decision(desk, 1)


def _over(desk: Desk) -> bool:
    """Whether the last place of a branch that cannot go on is in view; says so."""
    over = not desk.at_frontier and desk.snapshot.stop + 1 == len(desk.snapshot.story.stops)
    if over:
        desk.say("This is the end: go back, or answer an earlier decision otherwise to fork")
    return over


def by_decision(desk: Desk, count: int) -> None:
    """Go forward or back by decisions; past the last one to the end of the way."""
    story, here = desk.snapshot.story, desk.snapshot.here
    if count < 0 and not here.at_decision:
        count += 1  # back from between decisions first reaches the one that led here
    wanted = here.decision + count
    if wanted >= len(story.decisions):
        desk.stand(len(story.stops) - 1)
    else:
        desk.stand(story.stop_of_decision(max(0, wanted)))


def by_step(desk: Desk, count: int) -> None:
    """Go forward or back by low-level steps."""
    story, here = desk.snapshot.story, desk.snapshot.here
    wanted = max(0, min(here.step + count, story.track.last_step))
    desk.stand(story.stop_of_step(wanted))


def go(desk: Desk, branch_id: str, decision: int, number: int) -> None:
    """Go to a decision or step of a branch."""
    branch_id = branch_id if branch_id in desk.branches else desk.snapshot.branch.branch_id
    story = desk.stories[branch_id]
    if decision >= 0:
        stop = story.stop_of_decision(decision)
    elif number >= 0:
        stop = story.stop_of_step(number)
    else:
        stop = len(story.stops) - 1
    desk.stand(stop, branch_id)


def play(desk: Desk, until: str) -> None:
    """Go on by itself."""
    if _over(desk):
        return
    desk.change(playing=until)
    desk.due_s = desk.hands.clock()


def tick(desk: Desk) -> None:
    """One beat of playing."""
    until = desk.snapshot.playing
    start = desk.snapshot.here
    if desk.at_frontier:
        waits = not _commit_next(desk)
        if waits:
            return
    elif desk.snapshot.stop + 1 < len(desk.snapshot.story.stops):
        desk.stand(desk.snapshot.stop + 1)
    else:
        desk.change(playing="")
        return
    here = desk.snapshot.here
    if here.decision != start.decision and _reached(desk.snapshot, until):
        desk.change(playing="")
    pause_s = DECISION_S if here.at_decision else STEP_S
    desk.due_s = desk.hands.clock() + (pause_s if until == "play" else 0.0)


def _commit_next(desk: Desk) -> bool:
    """Commit the newest decision if it has an answer; False while that is still out."""
    branch_id = desk.snapshot.branch.branch_id
    if branch_id in desk.snapshot.proposals:
        driving.commit_proposal(desk, branch_id)
        return True
    if branch_id not in desk.asked:
        desk.change(playing="")
    desk.due_s = desk.hands.clock() + 0.02
    return False


def _reached(snapshot: Snapshot, until: str) -> bool:
    decision = snapshot.decision
    if decision is None or not snapshot.here.at_decision or until not in ("", *_LANES):
        return False
    return LANES[decision.lane].lower() == until


_LANES = tuple(lane.lower() for lane in LANES)


def jump(desk: Desk, to: str) -> None:
    """Go to a decision that is worth a look."""
    if to in ("first_suspect", "worst_suspect"):
        _suspect(desk, worst=to == "worst_suspect")
        return
    forward = to == "next_disagreement"
    here = desk.snapshot.here.decision
    decisions = desk.snapshot.story.decisions
    order = decisions[here + 1 :] if forward else decisions[:here][::-1]
    kind = desk.snapshot.view.kind

    def wanted(decision: Decision) -> bool:
        return disagrees(desk.snapshot, decision, kind)

    _first(desk, order, wanted, f"None that way: {KINDS[kind]}")


def _suspect(desk: Desk, *, worst: bool) -> None:
    suspects = desk.snapshot.suspects
    if not suspects:
        desk.say(desk.snapshot.no_suspects)
        return
    chosen = suspects[0]
    if not worst:
        over = [s for s in suspects if (s.regret_m or 0.0) >= BAD_M]
        if not over:
            desk.say(f"No decision cost more than {BAD_M:.0f} m; Shift+B goes to the worst")
            return
        chosen = min(over, key=lambda suspect: suspect.decision)
    desk.stand(desk.snapshot.story.stop_of_decision(chosen.decision))


def _first(
    desk: Desk,
    decisions: tuple[Decision, ...],
    wanted: Callable[[Decision], bool],
    otherwise: str,
) -> None:
    for decision in decisions:
        if wanted(decision):
            desk.stand(desk.snapshot.story.stop_of_decision(decision.number))
            return
    desk.say(otherwise)
