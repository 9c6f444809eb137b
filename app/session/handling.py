"""One small function for each command."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from app.session import asking, driving, judging, moving, overlaying, placing, reviewing, turning
from app.session import commands as c
from app.session.branches import Origin
from app.session.consent import Consent
from app.session.desk import Desk
from app.session.draft import Draft, arranged, none_of_these, press, take_back, tie
from app.session.opened import Choice
from app.session.veil import covered

_ON_THE_WAY_M = 0.2
"""A click this near to the trajectory means its step, not the floor below."""

Handler = Callable[[Desk, Any], None]


def handle(desk: Desk, command: c.Command) -> None:
    """Do what a command says."""
    _HANDLERS[type(command)](desk, command)
    if command.tab and command.tab != desk.snapshot.driver:
        desk.change(driver=command.tab)


def _move(desk: Desk, command: c.Move) -> None:
    desk.change(playing="")
    moving.by_decision(desk, command.count) if command.by == "decision" else moving.by_step(
        desk, command.count
    )


def _go(desk: Desk, command: c.Go) -> None:
    desk.change(playing="")
    moving.go(desk, command.branch, command.decision, command.step)


def _open(desk: Desk, command: c.Open) -> None:
    now = desk.snapshot.chooser.choice
    recorded = not desk.runs or desk.snapshot.branches[0].origin is Origin.RECORDED
    if recorded and command.ranker and not (command.entry or command.variant):
        # What is recorded stays as it is: the ranker answers in the forks to come.
        chosen = Choice(now.entry_id, now.variant, command.ranker)
        desk.change(chooser=replace(desk.snapshot.chooser, choice=chosen))
        return
    desk.reopen(
        Choice(
            command.entry or now.entry_id,
            command.variant or now.variant,
            command.ranker or now.ranker,
        )
    )
    driving.settle(desk, desk.snapshot.branch.branch_id)
    desk.assess(desk.snapshot.branch.branch_id)
    overlaying.lay(desk, desk.snapshot.view.layers)


def _press(desk: Desk, command: c.Press) -> None:
    driving.check_can_answer(desk)
    decision = desk.snapshot.decision
    letters = decision.letters if decision else {}
    by_position = sorted(letters, key=lambda key: letters[key])
    key = command.key
    if not key and 0 <= command.position < len(by_position):
        key = by_position[command.position]
    if decision is not None and key in {candidate.key for candidate in decision.offered}:
        desk.change(draft=press(desk.snapshot.draft, key), playing="")


def _arrange(desk: Desk, command: c.Arrange) -> None:
    driving.check_can_answer(desk)
    decision = desk.snapshot.decision
    offered = {candidate.key for candidate in decision.offered} if decision else set[str]()
    tiers = tuple(tuple(key for key in tier if key in offered) for tier in command.tiers)
    desk.change(draft=arranged(tiers), playing="")


def _drafted(change: Callable[[Draft], Draft]) -> Handler:
    def handler(desk: Desk, _: c.Command) -> None:
        driving.check_can_answer(desk)
        desk.change(draft=change(desk.snapshot.draft), playing="")

    return handler


def _clear(desk: Desk, _: c.Clear) -> None:
    desk.change(draft=Draft(), why="", offer=None)


def _commit(desk: Desk, command: c.Commit) -> None:
    branch_id = desk.snapshot.branch.branch_id
    if desk.at_frontier and desk.run is not None:
        if desk.snapshot.draft.empty:
            driving.commit_proposal(desk, branch_id)
        else:
            driving.take_over(desk, branch_id)
            driving.commit(desk, branch_id, driving.override_of(desk, command.why))
    elif desk.snapshot.draft.empty:
        moving.by_decision(desk, 1)
    elif covered(desk.snapshot):
        reviewing.answer_blind(desk)
    elif desk.snapshot.offer is None:
        driving.offer_fork(desk)
    else:
        driving.fork(desk, command.why)


def _consent(desk: Desk, command: c.Consent) -> None:
    yes = Consent(desk.opened.sends_to, desk.snapshot.who, desk.hands.clock())
    desk.consent = yes if command.allow else None
    desk.change(consent_to="")
    if command.allow:
        driving.ask(desk, desk.snapshot.branch.branch_id)
    else:
        desk.leave(desk.snapshot.branch.branch_id, "Pictures stay on this machine")


def _place(desk: Desk, command: c.Place) -> None:
    story = desk.snapshot.story
    ray_from_m, ray_along = command.ray_from_m, command.ray_along
    if ray_from_m is not None and ray_along is not None:
        step = placing.nearest_step(story, ray_from_m, ray_along, within_m=_ON_THE_WAY_M)
        if step is not None:
            moving.go(desk, "", -1, step)
            return
    asking.ask_place(desk, command)


def _layer(desk: Desk, command: c.Layer) -> None:
    layers = desk.snapshot.view.layers
    layers = layers | {command.name} if command.on else layers - {command.name}
    desk.change(view=replace(desk.snapshot.view, layers=layers))
    if command.on:
        overlaying.lay(desk, (command.name,))


def _judged(change: Callable[[Any], judging.Change]) -> Handler:
    return lambda desk, command: reviewing.judge(desk, change(command))


def _view(**of: Callable[[Any], Any]) -> Handler:
    def handler(desk: Desk, command: c.Command) -> None:
        fields = {name: read(command) for name, read in of.items()}
        desk.change(view=replace(desk.snapshot.view, **fields))

    return handler


_HANDLERS: dict[type[c.Command], Handler] = {
    c.Step: lambda desk, _: moving.step(desk),
    c.Move: _move,
    c.Go: _go,
    c.Play: lambda desk, _: moving.play(desk, "play"),
    c.Pause: lambda desk, _: desk.change(playing=""),
    c.RunTo: lambda desk, command: moving.play(desk, command.until),
    c.Open: _open,
    c.Jump: reviewing.jump,
    c.Press: _press,
    c.Arrange: _arrange,
    c.Tie: _drafted(tie),
    c.NoneOfThese: _drafted(lambda _: none_of_these()),
    c.TakeBack: _drafted(take_back),
    c.Clear: _clear,
    c.Commit: _commit,
    c.Why: lambda desk, command: desk.change(why=command.text),
    c.Cancel: lambda desk, _: driving.cancel(desk),
    c.AskAgain: lambda desk, _: driving.ask(desk, desk.snapshot.branch.branch_id),
    c.Consent: _consent,
    c.Hover: _view(hovered=lambda command: command.key),
    c.Camera: _view(camera=lambda command: command.mode),
    c.Seek: _view(kind=lambda command: command.kind),
    c.Layer: _layer,
    c.Place: _place,
    c.ForgetPlace: lambda desk, _: desk.change(place=None),
    c.Verdict: reviewing.verdict,
    c.Better: reviewing.better,
    c.LegEnd: reviewing.leg_end,
    c.Cover: reviewing.cover,
    c.Reveal: lambda desk, _: reviewing.reveal(desk),
    c.Tags: reviewing.keep_tags,
    c.Tag: _judged(lambda command: judging.tag(command.value)),
    c.Flag: _judged(lambda _: judging.flag()),
    c.Remark: _judged(lambda command: judging.remark(command.text)),
    c.Undo: lambda desk, _: reviewing.undo(desk),
    c.Redo: lambda desk, _: reviewing.redo(desk),
    c.MeasureTurning: lambda desk, _: turning.measure(desk),
    c.TryAnswers: lambda desk, _: turning.try_answers(desk),
    c.CancelTrying: lambda desk, _: turning.cancel(desk),
    c.OpenFlip: lambda desk, command: turning.open_flip(desk, command.decision, command.answer),
    c.Name: lambda desk, command: desk.change(who=command.who or "person 1"),
}
