"""The route sketch: what Remembering holds, and how far the leg has come."""

from __future__ import annotations

import viser
from markupsafe import Markup

from app.inspector import markup as m
from app.inspector.panels.protocol import Dispatch, Html, Update
from app.session.snapshot import Snapshot
from c2nav_engine.navigator.requests import SketchState

_SHOWN = 8
"""Newest entries on show."""


def build(gui: viser.GuiApi, _dispatch: Dispatch) -> Update:
    """Build the panel."""
    block = Html(gui)
    return lambda snapshot: block.show(_block(snapshot))


def sketches_in_view(snapshot: Snapshot) -> list[SketchState]:
    """Every sketch state up to the decision in view, oldest first."""
    decision = snapshot.decision
    until = snapshot.story.length if decision is None else decision.exchange
    return [sketch for index, sketch in snapshot.story.sketches if index <= until]


def _block(snapshot: Snapshot) -> str:
    sketches = sketches_in_view(snapshot)
    header = snapshot.story.header
    leg = snapshot.decision.facts.leg if snapshot.decision else 0
    legs = m.join(
        Markup('<li class="{}"><b>{}</b> {}</li>').format(
            "c2-now" if index == leg else ("c2-done" if index < leg else "c2-ahead"),
            index + 1,
            text,
        )
        for index, text in enumerate(header.legs)
    )
    top = m.join([m.heading("Legs"), Markup('<ol class="c2-legs">{}</ol>').format(legs)])
    if not sketches:
        return m.padded(top, m.note("The sketch is empty: no cycle is finished yet"))
    last = sketches[-1]
    return m.padded(
        top,
        m.heading("Transition"),
        m.facts(
            [
                ("gate", "open" if last.gate_open else "closed: not enough progress in this leg"),
                ("support", _support(last)),
                ("cue", last.entry.cue),
            ]
        ),
        m.heading("As the prompt says it"),
        m.quote(last.rendering),
        m.heading("Entries, newest first"),
        m.table(
            ["cycle", "leg", "entry", "turning", "cue", ""],
            [_row(sketch) for sketch in reversed(sketches[-_SHOWN:])],
        ),
    )


def _support(sketch: SketchState) -> str:
    if sketch.advanced:
        return "the leg advanced in this cycle"
    return f"{sketch.support} in a row for the next leg"


def _moved(forward_m: float, right_m: float) -> str:
    """Displacement in the leg's start frame."""
    ahead, aside = ("ahead", "back")[forward_m < 0.0], ("right", "left")[right_m < 0.0]
    return f"{abs(forward_m):.1f} m {ahead}, {abs(right_m):.1f} m {aside}"


def _row(sketch: SketchState) -> list[str | Markup]:
    entry = sketch.entry
    right_m, forward_m = entry.displacement_m
    thumbnail = entry.thumbnail
    return [
        str(entry.cycle),
        str(entry.leg + 1),
        Markup("{}<small>{}</small>").format(entry.words, _moved(forward_m, right_m)),
        entry.turning,
        entry.cue,
        m.picture(thumbnail.sha256, alt="", size_px=48) if thumbnail else "",
    ]
