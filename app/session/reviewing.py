"""Reviews on the page: judge, take back, cover and reveal."""

from __future__ import annotations

from dataclasses import replace

from app.session import commands as c
from app.session import judging, moving
from app.session.cards import winner_of
from app.session.desk import Desk
from app.session.draft import Draft, outcome_of
from app.session.snapshot import WHOLE
from app.session.veil import covered
from c2nav_engine.errors import UsageError

_COVERED = "The answer is covered: rank with the digits and Enter, or V shows it"


def judge(desk: Desk, change: judging.Change, *, decision: int | None = None) -> None:
    """Say something about the decision in view, or about another one."""
    in_view = desk.snapshot.decision
    number = (in_view.number if in_view else None) if decision is None else decision
    if number is None:
        return
    branch = desk.snapshot.branch
    seat = desk.shelf.seat(
        branch.branch_id, desk.snapshot.story, decision=number, who=desk.snapshot.who
    )
    if seat is None:
        message = "expected a book of reviews, came a source without one; open a trace or a run"
        raise UsageError(message)
    change(seat)
    desk.reread(branch.branch_id)


def verdict(desk: Desk, command: c.Verdict) -> None:
    """Judge what the model said."""
    if covered(desk.snapshot) and command.value != "cannot tell":
        desk.say(_COVERED)
        return
    judge(desk, judging.verdict(command.value))


def better(desk: Desk, command: c.Better) -> None:
    """Name the better alternative."""
    if covered(desk.snapshot):
        desk.say(_COVERED)
        return
    decision = desk.snapshot.decision
    letters = decision.letters if decision else {}
    by_position = sorted(letters, key=lambda key: letters[key])
    key = command.key
    if not key and 0 <= command.position < len(by_position):
        key = by_position[command.position]
    if decision is None or key not in letters:
        return
    if key == winner_of(desk.snapshot, decision):
        desk.say(f"{letters[key]} is what was answered: another one can be better")
        return
    judge(desk, judging.better(key))


def leg_end(desk: Desk, command: c.LegEnd) -> None:
    """Say where a leg ends."""
    legs = len(desk.snapshot.story.header.legs)
    if command.leg >= legs:
        message = f"expected a leg from 1 to {legs}, came {command.leg + 1}"
        raise UsageError(message)
    judge(desk, judging.leg_end(command.leg, command.step), decision=WHOLE)


def undo(desk: Desk) -> None:
    """Take the last word back."""
    book = desk.shelf.book(desk.snapshot.branch.branch_id)
    _gone_to(desk, book.undo(desk.snapshot.who) if book else None, "Nothing to undo")


def redo(desk: Desk) -> None:
    """Say again what was taken back."""
    book = desk.shelf.book(desk.snapshot.branch.branch_id)
    _gone_to(desk, book.redo(desk.snapshot.who) if book else None, "Nothing to redo")


def _gone_to(desk: Desk, decision: int | None, otherwise: str) -> None:
    if decision is None:
        desk.say(otherwise)
        return
    desk.reread(desk.snapshot.branch.branch_id)
    if decision != WHOLE:
        desk.stand(desk.snapshot.story.stop_of_decision(decision))


def keep_tags(desk: Desk, command: c.Tags) -> None:
    """Replace the list of tags."""
    branch_id = desk.snapshot.branch.branch_id
    desk.shelf.keep_tags(branch_id, command.names)
    desk.reread(branch_id)


def cover(desk: Desk, command: c.Cover) -> None:
    """Cover answers, or show them all."""
    desk.change(view=replace(desk.snapshot.view, blind=command.on), playing="", place=None)


def reveal(desk: Desk) -> None:
    """Show the covered answer; that it was seen is kept."""
    if not covered(desk.snapshot):
        desk.say("Nothing is covered here")
        return
    if desk.shelf.book(desk.snapshot.branch.branch_id) is not None:
        judge(desk, judging.reveal)
    shown = (desk.snapshot.branch.branch_id, desk.snapshot.here.decision)
    desk.change(revealed=desk.snapshot.revealed | {shown})


def answer_blind(desk: Desk) -> None:
    """Keep the person's own answer to a covered past decision, then show the recorded one."""
    decision = desk.snapshot.decision
    offered = tuple(candidate.key for candidate in decision.offered) if decision else ()
    judge(desk, judging.ranking(outcome_of(desk.snapshot.draft, offered)))
    desk.change(draft=Draft(), why="")
    reveal(desk)


def jump(desk: Desk, command: c.Jump) -> None:
    """Go where it is worth a look; covered, that would tell."""
    if desk.snapshot.view.blind:
        desk.say("Answers are covered, and so is what is suspect about them")
        return
    moving.jump(desk, command.to)
