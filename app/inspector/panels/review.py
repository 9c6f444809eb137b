"""A person's verdict on the decision in view."""

from __future__ import annotations

from typing import Literal

import viser
from markupsafe import Markup

from app.inspector import markup as m
from app.inspector.panels.controls import Picker
from app.inspector.panels.protocol import Dispatch, Html, Update
from app.session import commands as c
from app.session.differing import KINDS
from app.session.snapshot import Judgement, Snapshot

Value = Literal["agree", "acceptable", "wrong", "cannot tell"]

VERDICTS: tuple[Value, ...] = ("agree", "acceptable", "wrong", "cannot tell")

TAGS = (
    "early transition",
    "late transition",
    "wrong object",
    "not visible",
    "controller",
    "ambiguous instruction",
)


def build(gui: viser.GuiApi, dispatch: Dispatch) -> Update:
    """Build the panel."""
    seek = Picker(gui, "[ ] go to", lambda kind: dispatch(c.Seek.model_validate({"kind": kind})))
    block = Html(gui)
    remark = gui.add_text("note", "", multiline=True)
    save = gui.add_button("Keep the note", color="gray")
    who = gui.add_text("your name", "person 1")

    @save.on_click
    def _(_: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        dispatch(c.Remark(text=remark.value))

    @who.on_update
    def _(event: viser.GuiEvent[viser.GuiTextHandle]) -> None:
        if event.client is not None:
            dispatch(c.Name(who=event.target.value))

    seen: list[int] = []

    def update(snapshot: Snapshot) -> None:
        block.show(_block(snapshot))
        seek.show({str(kind): words for kind, words in KINDS.items()}, snapshot.view.kind)
        number = snapshot.here.decision
        if seen != [number]:
            seen[:] = [number]
            remark.value = snapshot.judgements.get(number, Judgement()).note
        if who.value != snapshot.who:
            who.value = snapshot.who

    return update


def _block(snapshot: Snapshot) -> str:
    number = snapshot.here.decision
    if number < 0:
        return m.padded(m.note("Nothing to judge yet"))
    judged = snapshot.judgements.get(number, Judgement())
    verdicts = m.join(
        m.action(value.capitalize(), c.Verdict(value=value), pressed=judged.verdict == value)
        for value in VERDICTS
    )
    tags = m.join(
        m.action(value, c.Tag(value=value), pressed=value in judged.tags)
        for value in (*TAGS, *(tag for tag in judged.tags if tag not in TAGS))
    )
    return m.padded(
        m.heading(f"Your verdict on decision {number}"),
        Markup('<div class="c2-buttons">{}</div>').format(verdicts),
        m.heading("Tags"),
        Markup('<div class="c2-buttons c2-small">{}</div>').format(tags),
        Markup('<div class="c2-buttons">{}{}{}</div>').format(
            m.action("Flag", c.Flag(), pressed=judged.flagged),
            m.action("Undo", c.Undo()),
            m.action("Redo", c.Redo()),
        ),
        m.note(f"{len(snapshot.judgements)} of {len(snapshot.story.decisions)} decisions judged"),
    )
