"""Choosing among recordings: by outcome, variant and picture."""

from __future__ import annotations

from collections.abc import Iterable

import viser
from markupsafe import Markup

from app.inspector import markup as m
from app.inspector.panels.controls import Picker
from app.inspector.panels.protocol import Dispatch, Html, Update
from app.session import commands as c
from app.session.opened import Entry
from app.session.snapshot import Snapshot

ALL = "all"
_FEW = 2
"""Fewer entries than this need no list."""


class Filter:
    """What the list shows; shared by all pages like everything else."""

    def __init__(self) -> None:
        """Show everything."""
        self.outcome = ALL
        self.variant = ALL

    def passes(self, entry: Entry) -> bool:
        """Whether an entry is listed."""
        return self.outcome in (ALL, outcome_of(entry)) and self.variant in (ALL, entry.variant)


def outcome_of(entry: Entry) -> str:
    """How an entry ended, with success told apart."""
    if entry.outcome == "stopped" and entry.success is not None:
        return "stopped ✓" if entry.success else "stopped ✕"
    return entry.outcome


def build(gui: viser.GuiApi, _dispatch: Dispatch) -> Update:
    """Build the list; it is empty for a source of live episodes."""
    chosen = Filter()
    latest: list[Snapshot] = []

    def pick(name: str, value: str) -> None:
        setattr(chosen, name, value)
        if latest:
            update(latest[0])

    outcome = Picker(gui, "outcome", lambda value: pick("outcome", value))
    variant = Picker(gui, "variants", lambda value: pick("variant", value))
    block = Html(gui)

    def update(snapshot: Snapshot) -> None:
        latest[:] = [snapshot]
        entries = [e for e in snapshot.chooser.entries if e.outcome]
        outcome.show(_choices(outcome_of(e) for e in entries), chosen.outcome, least=3)
        variant.show(_choices(e.variant for e in entries), chosen.variant, least=3)
        block.show(_block(snapshot, chosen) if len(entries) >= _FEW else "")

    return update


def _choices(values: Iterable[str]) -> dict[str, str]:
    names = sorted(set(values))
    return {ALL: ALL, **{name: name for name in names}}


def _block(snapshot: Snapshot, chosen: Filter) -> str:
    entries = snapshot.chooser.entries
    rows = [
        _row(index, entry, entry.entry_id == snapshot.chooser.choice.entry_id)
        for index, entry in enumerate(entries)
        if entry.outcome and chosen.passes(entry)
    ]
    return m.padded(
        m.heading(f"Recordings, {len(rows)} of {len(entries)}"),
        Markup('<ul class="c2-entries">{}</ul>').format(m.join(rows)),
    )


def _row(index: int, entry: Entry, here: bool) -> Markup:
    picture = (
        Markup('<img src="api/entry/{}.jpg" alt="" loading="lazy">').format(index)
        if entry.thumbnail is not None
        else m.NOTHING
    )
    words = Markup("{}<span>{}<small>{}</small></span>").format(
        picture, entry.label, outcome_of(entry)
    )
    return Markup('<li class="{}">{}</li>').format(
        "c2-now" if here else "", m.action(words, c.Open(entry=entry.entry_id))
    )
