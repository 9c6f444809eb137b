"""The decision in view: cards, question as sent, answers, what was done, what was known."""

from __future__ import annotations

import viser
from markupsafe import Markup

from app.inspector import markup as m
from app.inspector.panels.answers import answers_table
from app.inspector.panels.controls import buttons
from app.inspector.panels.protocol import Dispatch, Html, Update
from app.session import commands as c
from app.session.branches import cost_of
from app.session.decisions import Decision
from app.session.snapshot import Assessment, Snapshot
from app.session.wording import (
    degrees,
    key_words,
    motion_words,
    outcome_words,
    plural,
    seconds,
)
from c2nav_engine.contract.question import Picture
from c2nav_engine.contract.render import render
from c2nav_engine.errors import C2NavError
from c2nav_engine.navigator.requests import Move, Moved

STRIP = "<rank-strip></rank-strip>"
"""Constant, so that the element mounts once and keeps its state."""


def build(gui: viser.GuiApi, dispatch: Dispatch) -> Update:
    """Build the panel."""
    gui.add_html(STRIP)
    why = gui.add_text("why", "", hint="kept with your answer", visible=False)

    @why.on_update
    def _(event: viser.GuiEvent[viser.GuiTextHandle]) -> None:
        if event.client is not None:
            dispatch(c.Why(text=event.target.value))

    below = Html(gui)
    with gui.add_folder("Rank without a mouse", expand_by_default=False):
        presses = {letter: c.Press(position=index) for index, letter in enumerate("ABCDEF")}
        buttons(gui, dispatch, label="rank next", commands=presses)
        buttons(
            gui,
            dispatch,
            label="or",
            commands={
                "tie": c.Tie(),
                "none": c.NoneOfThese(),
                "take back": c.TakeBack(),
                "commit": c.Commit(),
            },
        )

    def update(snapshot: Snapshot) -> None:
        answering = not snapshot.draft.empty and not snapshot.covered
        if why.visible != answering:
            why.visible = answering
            why.value = snapshot.why
        below.show(_below(snapshot))

    return update


def _below(snapshot: Snapshot) -> str:
    decision = snapshot.decision
    if decision is None:
        return m.padded(m.note("No decision yet: the robot has not looked around"))
    return m.padded(
        _asked(decision), answers_table(snapshot), _committed(snapshot, decision), _known(decision)
    )


def _asked(decision: Decision) -> Markup:
    if decision.question is None:
        only = decision.elected
        words = (
            f"Not asked: {key_words(only)} was the only view left"
            if only
            else "Not asked: no view was left"
        )
        return m.join([m.heading("Asked"), m.note(words)])
    try:
        parts = render(decision.question).parts
    except C2NavError as error:
        return m.join([m.heading("Asked"), m.note(str(error))])
    text = m.join(
        Markup('<span class="c2-pic" title="{}">▣</span>').format(part.sha256[:12])
        if isinstance(part, Picture)
        else part
        for part in parts
    )
    return m.join([m.heading("Asked"), m.quote(text)])


def _committed(snapshot: Snapshot, decision: Decision) -> Markup:
    if decision.pending:
        return m.NOTHING
    override = decision.override
    assessment = snapshot.assessments.get(decision.number)
    return m.join(
        [
            m.heading("Committed"),
            m.facts(
                [
                    ("outcome", outcome_words(decision.outcome, decision.letters)),
                    ("motion", _motion(snapshot, decision)),
                    ("regret", _regret(assessment)),
                    ("off the path", _off_path(assessment)),
                    ("cost", _cost(decision)),
                    ("override", f"◆ {override.who} {override.why}".strip() if override else ""),
                ]
            ),
        ]
    )


def _regret(assessment: Assessment | None) -> str:
    if assessment is None:
        return ""
    if assessment.regret_m is None:
        return assessment.words
    words = f"{assessment.regret_m:.1f} m against the best offered view"
    return f"{words} · {assessment.words}" if assessment.words else words


def _off_path(assessment: Assessment | None) -> str:
    if assessment is None or assessment.off_path_m is None:
        return ""
    return f"{assessment.off_path_m:.1f} m from the reference"


def _motion(snapshot: Snapshot, decision: Decision) -> str:
    end = snapshot.story.end_of(decision.number)
    turn_rad = snapshot.story.header.profile.turn_rad
    for exchange in snapshot.branch.exchanges[decision.exchange : end]:
        if isinstance(exchange.request, Move) and isinstance(exchange.response, Moved):
            return motion_words(exchange.response.steps, turn_rad)
    return ""


def _cost(decision: Decision) -> str:
    cost = cost_of((decision,))
    if not cost.queries:
        return ""
    words = [plural(cost.queries, "query"), plural(cost.tokens, "token") if cost.tokens else ""]
    words.append(seconds(cost.seconds))
    return " · ".join(word for word in words if word)


def _known(decision: Decision) -> Markup:
    facts = decision.facts
    rows: list[tuple[str, str]] = [
        ("cycle", f"{facts.cycle}, leg {facts.leg + 1}"),
        (
            "travelled",
            f"{facts.travelled_m:.1f} m, {facts.leg_travelled_m:.1f} m in this leg",
        ),
        (
            "views",
            ", ".join(
                f"{key_words(candidate.key)} {degrees(candidate.offset_rad)}"
                for candidate in facts.candidates
                if candidate.offset_rad
            ),
        ),
        *facts.notes.items(),
    ]
    return m.join([m.heading("Controller"), m.facts(rows)])
