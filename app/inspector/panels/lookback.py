"""The look-back pair of the newest look-back question: both frames, both orders, both answers."""

from __future__ import annotations

import viser

from app.inspector import markup as m
from app.inspector.panels.answers import answers_table
from app.inspector.panels.protocol import Dispatch, Html, Update
from app.session.decisions import Decision
from app.session.snapshot import Snapshot
from c2nav_engine.contract.question import Slot


def build(gui: viser.GuiApi, dispatch: Dispatch) -> Update:  # noqa: ARG001 # nothing to press
    """Build the panel."""
    gui.add_html("<image-pair></image-pair>")
    words = Html(gui)
    return lambda snapshot: words.show(_words(snapshot))


def lookback_in_view(snapshot: Snapshot) -> Decision | None:
    """The newest look-back question at or before the decision in view."""
    number = snapshot.here.decision
    for decision in reversed(snapshot.story.decisions[: number + 1]):
        if decision.slot is Slot.LOOKBACK:
            return decision
    return None


def _words(snapshot: Snapshot) -> str:
    decision = lookback_in_view(snapshot)
    if decision is None:
        return m.padded(
            m.note(
                "No look-back yet: it is asked in the last leg, when ground and journey leave "
                "the evidence open"
            )
        )
    now = snapshot.decision
    if now is not None and now.number == decision.number:
        return m.padded(answers_table(snapshot))
    return m.padded(m.note(f"Asked at decision {decision.number}"))
