"""A person's verdict on the decision in view, and what others said about it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import viser
from markupsafe import Markup

from app.inspector import markup as m
from app.inspector.panels.controls import Picker
from app.inspector.panels.protocol import Dispatch, Html, Update
from app.session import commands as c
from app.session.cards import winner_of
from app.session.differing import KINDS
from app.session.snapshot import WHOLE, Judgement, Snapshot
from app.session.wording import outcome_words, plural

Value = Literal["agree", "acceptable", "wrong", "cannot tell"]

VERDICTS: tuple[Value, ...] = ("agree", "acceptable", "wrong", "cannot tell")


Keeps = Callable[[str], None]
"""Takes a text that a person wants kept."""


def build(gui: viser.GuiApi, dispatch: Dispatch) -> Update:
    """Build the panel."""
    seek = Picker(gui, "[ ] go to", lambda kind: dispatch(c.Seek.model_validate({"kind": kind})))
    block = Html(gui)
    note = _Text(gui, "note", "Keep the note", lambda text: dispatch(c.Remark(text=text)))
    legs = Html(gui)
    leg_ends = _LegEnds(gui, dispatch)
    tags = _Text(
        gui,
        "tags, one a line",
        "Keep the list",
        lambda text: dispatch(c.Tags(names=tuple(text.splitlines()))),
    )
    who = gui.add_text("your name", "person 1")

    @who.on_update
    def _(event: viser.GuiEvent[viser.GuiTextHandle]) -> None:
        if event.client is not None:
            dispatch(c.Name(who=event.target.value))

    def update(snapshot: Snapshot) -> None:
        block.show(_block(snapshot))
        seek.show({str(kind): words for kind, words in KINDS.items()}, snapshot.view.kind)
        judged = snapshot.judgements.get(snapshot.here.decision, Judgement())
        note.show(judged.note, of=snapshot.token)
        legs.show(_legs(snapshot))
        leg_ends.show(snapshot)
        tags.show("\n".join(snapshot.tags), of="tags")
        if who.value != snapshot.who:
            who.value = snapshot.who

    return update


class _Text:
    """A text with a button that keeps it; what is being typed is not overwritten."""

    def __init__(self, gui: viser.GuiApi, label: str, keep: str, kept: Keeps) -> None:
        self._text = gui.add_text(label, "", multiline=True)
        self._shown = ("", "")
        button = gui.add_button(keep, color="gray")

        @button.on_click
        def _(_: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
            kept(self._text.value)

    def show(self, text: str, *, of: str) -> None:
        """Show what is kept `of` something."""
        if self._shown != (of, text):
            self._shown = (of, text)
            self._text.value = text


class _LegEnds:
    """The native twin of the flags on the timeline: a leg, and the step at which it ends."""

    def __init__(self, gui: viser.GuiApi, dispatch: Dispatch) -> None:
        self._leg = gui.add_number("leg", 1, min=1, step=1)
        self._step = gui.add_number("ends at step", 0, min=0, step=1)
        self._here = -1
        button = gui.add_button("Keep the leg's end", color="gray")

        @button.on_click
        def _(_: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
            dispatch(c.LegEnd(leg=int(self._leg.value) - 1, step=int(self._step.value)))

    def show(self, snapshot: Snapshot) -> None:
        """Follow where one stands."""
        step = snapshot.here.step
        if step != self._here:
            self._here = self._step.value = step
        if self._leg.max != (legs := len(snapshot.story.header.legs)):
            self._leg.max = max(1, legs)


def _block(snapshot: Snapshot) -> str:
    number = snapshot.here.decision
    if number < 0:
        return m.padded(m.note("Nothing to judge yet"))
    judged = snapshot.judgements.get(number, Judgement())
    return m.padded(
        _blind(snapshot),
        m.heading(f"Your verdict on decision {number}"),
        _verdicts(judged, VERDICTS[-1:] if snapshot.covered else VERDICTS),
        _better(snapshot, judged),
        m.heading("Tags"),
        _tags(snapshot, judged),
        Markup('<div class="c2-buttons">{}{}{}</div>').format(
            m.action("Flag", c.Flag(), pressed=judged.flagged),
            m.action("Undo", c.Undo()),
            m.action("Redo", c.Redo()),
        ),
        m.note(_count(snapshot)),
        _others(snapshot),
    )


def _blind(snapshot: Snapshot) -> Markup:
    """What is covered, and how it is shown."""
    if not snapshot.view.blind:
        cover = m.action("Cover answers", c.Cover(on=True), title="judge before you see")
        return Markup('<div class="c2-buttons">{}</div>').format(cover)
    buttons = [m.action("Show all answers", c.Cover(on=False))]
    words = "Answers after this one stay covered"
    if snapshot.covered:
        buttons.insert(0, m.action("Show this answer (V)", c.Reveal()))
        words = "Covered: rank with the digits, Enter keeps your ranking and shows the answer"
    return Markup('{}<div class="c2-buttons">{}</div>').format(m.note(words), m.join(buttons))


def _verdicts(judged: Judgement, offered: tuple[Value, ...]) -> Markup:
    buttons = m.join(
        m.action(value.capitalize(), c.Verdict(value=value), pressed=judged.verdict == value)
        for value in offered
    )
    return Markup('<div class="c2-buttons">{}</div>').format(buttons)


def _better(snapshot: Snapshot, judged: Judgement) -> Markup:
    """The other alternatives by letter; pressed is what would have been better."""
    decision = snapshot.decision
    if decision is None or decision.question is None or snapshot.covered:
        return m.NOTHING
    letters = sorted(decision.letters.items(), key=lambda pair: pair[1])
    buttons = m.join(
        m.action(letter, c.Better(key=key), pressed=judged.better == key, title="Shift and digit")
        for key, letter in letters
        if key != winner_of(snapshot, decision)
    )
    own = outcome_words(judged.ranking, decision.letters)
    return m.join(
        [
            m.heading("Better would have been"),
            Markup('<div class="c2-buttons">{}</div>').format(buttons),
            m.note(f"Your own ranking: {own}") if own else m.NOTHING,
        ]
    )


def _tags(snapshot: Snapshot, judged: Judgement) -> Markup:
    names = dict.fromkeys((*snapshot.tags, *judged.tags))
    buttons = m.join(
        m.action(name, c.Tag(value=name), pressed=name in judged.tags) for name in names
    )
    return Markup('<div class="c2-buttons c2-small">{}</div>').format(buttons)


def _count(snapshot: Snapshot) -> str:
    judged = [number for number in snapshot.judgements if number != WHOLE]
    return f"{len(judged)} of {plural(len(snapshot.story.decisions), 'decision')} judged"


def _others(snapshot: Snapshot) -> Markup:
    """What everybody else said of this decision; seen and blind are told apart."""
    decision = snapshot.decision
    others = snapshot.others
    if decision is None or not others:
        return m.NOTHING
    letters = decision.letters
    rows = [
        (
            who,
            Markup("{}<small>{}</small>").format(
                "; ".join(_said(judged, letters)), "blind" if judged.blind else "answer seen"
            ),
        )
        for who, judged in sorted(others.items())
    ]
    return m.join([m.heading("Others"), m.table(["", ""], rows)])


def _said(judged: Judgement, letters: dict[str, str]) -> list[str]:
    own = outcome_words(judged.ranking, letters)
    words = [
        judged.verdict,
        f"own ranking {own}" if own else "",
        f"better {letters.get(judged.better, judged.better)}" if judged.better else "",
        ", ".join(judged.tags),
        "flagged" if judged.flagged else "",
        f"“{judged.note}”" if judged.note else "",
    ]
    return [word for word in words if word]


def _legs(snapshot: Snapshot) -> str:
    """Where legs end; flags on the timeline can be dragged."""
    legs = snapshot.story.header.legs
    ends = snapshot.judgements.get(WHOLE, Judgement()).leg_ends
    step = snapshot.here.step
    rows = [
        (
            f"{leg + 1}",
            f"step {ends[leg]}" if leg in ends else "–",
            m.action("ends here", c.LegEnd(leg=leg, step=step), title=f"at step {step}"),
        )
        for leg in range(len(legs))
    ]
    return m.padded(m.heading("Leg ends: drag ⚑ on the timeline, or"), m.table(["", "", ""], rows))
